#pragma once
/// Rays are sorted into classes of neighbouring places and directions; each class has a list of
/// what its rays may meet.
///
/// Source: Arvo and Kirk, "Fast Ray Tracing by Ray Classification", SIGGRAPH 1987; Arvo and Kirk,
/// "A Survey of Ray Tracing Acceleration Techniques", in Glassner (ed.), "An Introduction to Ray
/// Tracing", 1989. Differs: what a class may meet is found by five planes around its beam and the
/// extents of flat polygons, or of the box and sphere around all else, along their normals, and by
/// the sides on which its rays pass the edges of polygons, where Arvo and Kirk take cones or linear
/// programs. Lists are not cut off behind blockers: what is behind a hit is not tested anyway. Nor
/// are faces that are turned away left out: others could tell the difference. When the memory is
/// used up, all classes are thrown away and made anew as rays come (they throw away what was not
/// used lately). A thread
/// remembers its last 16 classes for each of the six directions, for the nearest and for any hit.
/// Rays from so far away that rounding could lead beside their class are tested against everything.
/// Complexity and threads: classes are divided as rays come to them, by all threads at once; a ray
/// costs the depth of its class, or nothing where it is that of a ray before.

#include <cstddef>
#include <memory>

#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/traversal_trace.h"
#include "alhazen/accel/directions/ray_hypercubes.h"

namespace alhazen {

class RayClassification {
  public:
    static constexpr const char* kName = "ray_classification";
    static constexpr const char* kDescription =
        "lists for classes of rays of neighbouring places and directions";
    using Config = RayHypercubes::Limits;
    [[nodiscard]] static Config configure(SettingsReader& reader);

    [[nodiscard]] static RayClassification build(const BoundsSource& source, const Config& config) {
        RayClassification made;
        if (source.size() > 0) made.classes_ = std::make_unique<RayHypercubes>(source, config);
        return made;
    }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        if (classes_ == nullptr) return;
        const PaddedBox& space = classes_->space();
        if (!space.covers(ray)) return visit_all(classes_->bodies().size(), visitor);
        const RaySpan span(space.box, ray, visitor.t_max());
        if (span.empty()) return;
        const ClassifiedRay classified(ray, span.begin);
        constexpr AsksFor kAsked = asks_for<Visitor>();
        const RayHypercubes::Found found =
            classes_->find(classified, kAsked == AsksFor::AnyHit || kAsked == AsksFor::AnyBlocker);
        stats.cache_lookup(found.cached);
        stats.nodes(static_cast<std::uint64_t>(found.nodes));
        note_cell(stats, static_cast<std::size_t>(found.nodes));
        if (found.list->empty()) stats.empty_cells(1);
        const int direction = classified.direction;
        const double sign = direction % 2 == 0 ? 1.0 : -1.0;
        for (const std::uint32_t i : *found.list) {
            // Whatever comes later in the list begins behind what was found.
            const double reached = sign * ray.at(visitor.t_max())[direction / 2];
            if (classes_->begin_along(i, direction) > reached + space.pad) return;
            if (visitor.visit(i)) return;
        }
    }

    /// Grows while rays are traced.
    [[nodiscard]] std::size_t memory_bytes() const {
        return classes_ == nullptr ? 0 : classes_->memory_bytes();
    }
    /// Null over nothing.
    [[nodiscard]] const RayHypercubes* classes() const { return classes_.get(); }

  private:
    std::unique_ptr<RayHypercubes> classes_;
};
static_assert(Accelerator<RayClassification>);

}  // namespace alhazen
