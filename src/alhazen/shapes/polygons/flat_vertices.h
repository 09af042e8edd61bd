#pragma once
/// The vertices of a polygon in its plane.

#include <vector>

#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/shapes/polygons/polygon.h"

namespace alhazen {

/// Where rays meet a polygon whose corners are not in a plane: its vertices, moved along the normal
/// unless they are flat as they are (is_flat).
[[nodiscard]] inline std::vector<Vec3> flat_vertices(const Polygon& polygon) {
    std::vector<Vec3> flat = polygon.vertices;
    if (is_flat(flat, polygon.normal)) return flat;
    for (Vec3& p : flat) p = p - dot(p - polygon.point, polygon.normal) * polygon.normal;
    return flat;
}

}  // namespace alhazen
