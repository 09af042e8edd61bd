#pragma once
/// The polygons of a table that share sides, as single objects: the faces of a solid, the tiles of
/// a surface.
///
/// Polygons of one material, seen by the same rays, are joined where the ends of two sides have the
/// same positions. Solids that touch in a corner stay two.
/// Complexity: almost linear in the corners.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

struct JoinedPolygons {
    /// [shape] number of its object, counted in the order of their first shapes; shapes that are no
    /// polygons are objects of their own. Empty: each shape is one.
    std::vector<std::uint32_t> of_shape;
    std::uint32_t objects = 0;
    /// [object] around all its polygons, in the frame of the table. Empty where `of_shape` is.
    std::vector<BoundingSphere> spheres;

    explicit JoinedPolygons(const PrimitiveTable& table);
};

}  // namespace alhazen
