#pragma once
/// Joins polygons of a table that share sides into single objects: the faces of a solid, the tiles
/// of a surface.
///
/// Polygons of one material, visible to the same rays, are joined if the ends of two sides have
/// equal positions. Solids that touch in a corner remain separate.
/// Complexity: almost linear in the corners.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

struct JoinedPolygons {
    /// [shape] index of its object, in the order of their first shapes; shapes that are no polygons
    /// are their own objects. Empty: each shape is one object.
    std::vector<std::uint32_t> of_shape;
    std::uint32_t objects = 0;
    /// [object] sphere around its polygons, in the frame of the table. Empty if `of_shape` is.
    std::vector<BoundingSphere> spheres;

    explicit JoinedPolygons(const PrimitiveTable& table);
};

}  // namespace alhazen
