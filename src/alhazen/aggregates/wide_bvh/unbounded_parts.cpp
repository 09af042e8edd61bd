#include "alhazen/aggregates/wide_bvh/unbounded_parts.h"

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"

namespace alhazen {

UnboundedParts::UnboundedParts(const PrimitiveTable& table, std::span<const PrimitiveId> ids) {
    const auto& planes = std::get<ShapeColumn<Plane>>(table.columns);
    for (const PrimitiveId id : ids) {
        Part& part = parts_.emplace_back();
        part.id = id;
        if (table.kind(id) != column_of<Plane>()) continue;
        const std::uint32_t i = table.index(id);
        part.is_plane = planes.placements[i] == kNoPlacement;
        part.point = planes.shapes[i].point;
        part.unit_normal = planes.shapes[i].unit_normal;
    }
}

void UnboundedParts::closest_of_some(const PrimitiveTable& table, const Ray& ray, Hit& best,
                                     RayQuery query) const {
    Ray shrinking = ray;
    meet(table, shrinking, query, [&](PrimitiveId id, const ShapeHit* hit, auto stats) {
        if (hit != nullptr) {
            offer_hit(*hit, id, shrinking, best);
        } else {
            table.closest(id, shrinking, shear_of(table, id, ray), best, stats, query.mask);
        }
        return false;
    });
}

bool UnboundedParts::occluded_by_some(const PrimitiveTable& table, const Ray& ray,
                                      RayQuery query) const {
    return meet(table, ray, query, [&](PrimitiveId id, const ShapeHit* hit, auto stats) {
        return hit != nullptr ||
               table.occluded(id, ray, shear_of(table, id, ray), stats, query.mask);
    });
}

}  // namespace alhazen
