#include "alhazen/scene/scene_sphere.h"

#include <algorithm>
#include <unordered_map>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

namespace {

/// The boxes of the bounded parts of aggregates while the shutter is open. An aggregate may be
/// placed many times.
class BoundedBoxes {
  public:
    /// Empty if all parts are unbounded.
    Box3 of(const Aggregate& aggregate) {
        Box3 all = aggregate.box();
        if (all.empty() || all.bounded()) return all;
        if (const auto known = known_.find(&aggregate); known != known_.end()) return known->second;
        all = {};
        const PrimitiveTable& table = aggregate.primitives();
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            const Box3 box = of(table, PrimitiveId{i});
            if (!box.empty() && box.bounded()) all.include(box);
        }
        return known_[&aggregate] = all;
    }

  private:
    Box3 of(const PrimitiveTable& table, PrimitiveId id) {
        const std::uint32_t index = table.index(id);
        if (table.kind(id) == kInstanceKind) {
            const Instance& instance = table.instances[index];
            const Box3 inner = of(*instance.aggregate);
            if (inner.empty()) return inner;
            return instance.motion ? instance.motion->bounds(inner).swept()
                                   : transformed(instance.placement.outer_from_inner, inner);
        }
        if (table.kind(id) == kTriangleKind) {
            if (const auto& motion = table.mesh_of(index).motion) {
                return motion->box(*table.triangle_corners(index)).swept();
            }
        }
        return table.box(static_cast<std::size_t>(id));
    }

    std::unordered_map<const Aggregate*, Box3> known_;
};

}  // namespace

BoundingSphere sphere_around_bounded(const Scene& scene) {
    Box3 box;
    if (scene.aggregate) box = BoundedBoxes().of(*scene.aggregate);
    if (box.empty()) box = {{-1, -1, -1}, {1, 1, 1}};
    return {box.center(), std::max(0.5 * length(box.size()) * (1.0 + 1e-9), 1e-100)};
}

bool reaches_infinity(const Scene& scene) {
    if (!scene.aggregate) return false;
    const Box3 box = scene.aggregate->box();
    return !box.empty() && !box.bounded();
}

}  // namespace alhazen
