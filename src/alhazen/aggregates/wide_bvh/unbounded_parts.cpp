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

}  // namespace alhazen
