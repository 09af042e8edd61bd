#pragma once
/// Triangles of the polygons of area lights.

#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

/// Triangles that cover the polygon once, by the odd-even rule, and run around its normal. Those of
/// a loop that does not meet itself are on its vertices. Precondition: the vertices are finite.
[[nodiscard]] MeshExtent triangles_of(const PolygonExtent& polygon);

}  // namespace alhazen
