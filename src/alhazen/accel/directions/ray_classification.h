#pragma once
/// Ray classification: rays are sorted into classes of neighbouring origins and directions; each
/// class has a list of the primitives that its rays may intersect.
///
/// Source: Arvo and Kirk, "Fast Ray Tracing by Ray Classification", SIGGRAPH 1987; Arvo and Kirk,
/// "A Survey of Ray Tracing Acceleration Techniques", in Glassner (ed.), "An Introduction to Ray
/// Tracing", 1989.
/// Differs: finds the candidates of a class by five planes around its beam and the extents along
/// their normals of flat polygons, or of the box and sphere of other primitives, and by the sides
/// on which its rays pass the edges of polygons; Arvo and Kirk use cones or linear programs. Lists
/// on which its rays pass the edges of polygons; Arvo and Kirk use cones or linear programs. Lists
/// are not truncated behind blockers, since primitives behind a hit are not tested anyway. Back
/// faces are not omitted, as other queries need them. When the memory is used up, all classes are
/// discarded and made again on demand (the source discards the least recently used). A thread
/// caches its last 16 classes for each of the six directions, separately for closest and any hits.
/// Rays from so far away that rounding could lead outside of their class are tested against all
/// primitives.
/// Complexity and threads: classes are divided on demand, by all threads concurrently; a ray costs
/// the depth of its class, or nothing if the class is cached.

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
        "lists for classes of rays of neighbouring origins and directions";
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
        const AsksFor asked = asks_for(visitor);
        const RayHypercubes::Found found =
            classes_->find(classified, asked == AsksFor::AnyHit || asked == AsksFor::AnyBlocker);
        stats.cache_lookup(found.cached);
        stats.nodes(static_cast<std::uint64_t>(found.nodes));
        note_cell(stats, static_cast<std::size_t>(found.nodes));
        if (found.list->empty()) stats.empty_cells(1);
        const int direction = classified.direction;
        const double sign = direction % 2 == 0 ? 1.0 : -1.0;
        for (const std::uint32_t i : *found.list) {
            // The remaining candidates begin behind the hit.
            const double reached = sign * ray.at(visitor.t_max())[direction / 2];
            if (classes_->begin_along(i, direction) > reached + space.pad) return;
            if (visitor.visit(i)) return;
        }
    }

    /// Increases while rays are traced.
    [[nodiscard]] std::size_t memory_bytes() const {
        return classes_ == nullptr ? 0 : classes_->memory_bytes();
    }
    /// Null for an empty scene.
    [[nodiscard]] const RayHypercubes* classes() const { return classes_.get(); }

  private:
    std::unique_ptr<RayHypercubes> classes_;
};
static_assert(Accelerator<RayClassification>);

}  // namespace alhazen
