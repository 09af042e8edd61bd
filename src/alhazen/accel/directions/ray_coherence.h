#pragma once
/// Ray coherence: rays that start near one primitive in similar directions share a candidate list.
///
/// Source: Ohta and Maekawa, "Ray Coherence Theorem and Constant Time Ray Tracing Algorithm",
/// Computer Graphics International 1987.
/// Differs: makes the lists of a primitive on demand, not beforehand for all pairs; finds the start
/// of a ray by a grid over the spheres, not from the previous ray. Every primitive is represented
/// by its bounding sphere. Shadow rays to a light of the scene use the lists of the light, whose
/// sphere is a point. Rays that start in no sphere (eye rays), and all rays when the memory for
/// lists is used up or there are too many primitives, are traced by the fallback accelerator
/// (`others`).
/// Complexity and threads: a new list costs O(n); see accel/directions/coherence_lists.h.

#include <cstdint>
#include <memory>

#include "alhazen/accel/directions/coherence_lists.h"
#include "alhazen/accel/directions/fallback_accelerator.h"
#include "alhazen/accel/directions/ray_end_finder.h"

namespace alhazen {

class RayCoherence {
  public:
    static constexpr const char* kName = "ray_coherence";
    static constexpr const char* kDescription =
        "lists for the directions from every primitive and light";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        int resolution = 0;  ///< cells along an edge of the cube; 0: by the number of primitives
        int most = 20000;    ///< with more primitives the fallback accelerator traces all rays
        int memory_mib = 256;
        FallbackAccelerator::Kind others = FallbackAccelerator::Kind::Hierarchy;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);
    [[nodiscard]] static RayCoherence build(const BoundsSource& source, const Config& config);

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        if (lists_ != nullptr && space_.covers(ray)) {
            if (const auto to = ends_.find_for(ray, visitor)) {
                const auto* list = lists_->find(lists_->origin_of_light(to->end), -ray.direction);
                if (list != nullptr) {
                    return test(
                        *list, [&] { return to->start; }, visitor, stats);
                }
            }
            if (const auto* list = list_from(ray, stats)) {
                const double scale = max_component(abs(ray.direction));
                const double speed = scale * length(ray.direction / scale);
                const auto reached = [&] { return (visitor.t_max() - ray.t_min) * speed; };
                return test(*list, reached, visitor, stats);
            }
        }
        others_.traverse(ray, visitor, stats);
    }

    /// Increases while rays are traced.
    [[nodiscard]] std::size_t memory_bytes() const {
        return others_.memory_bytes() + (lists_ == nullptr ? 0 : lists_->memory_bytes());
    }
    /// Null if there are no lists.
    [[nodiscard]] const CoherenceLists* lists() const { return lists_.get(); }

  private:
    template <class Stats>
    [[nodiscard]] const CoherenceLists::List* list_from(const Ray& ray, Stats stats) const {
        const CoherenceLists::Origin origin = lists_->origin_at(ray.at(ray.t_min));
        stats.boxes(origin.tested);
        return origin.primitive ? lists_->find(*origin.primitive, ray.direction) : nullptr;
    }

    /// `reached()`: the distance from the list's origin up to which candidates matter.
    template <class Reached, class Visitor, class Stats>
    void test(const CoherenceLists::List& list, const Reached& reached, Visitor& visitor,
              Stats stats) const {
        stats.nodes(1);
        if (list.empty()) stats.empty_cells(1);
        for (const CoherenceLists::Candidate& c : list) {
            if (c.begin > reached()) return;
            if (visitor.visit(c.primitive)) return;
        }
    }

    PaddedBox space_;
    RayEndFinder ends_;
    std::unique_ptr<CoherenceLists> lists_;
    FallbackAccelerator others_;
};
static_assert(Accelerator<RayCoherence>);

}  // namespace alhazen
