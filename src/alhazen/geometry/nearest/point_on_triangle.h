#pragma once
/// The point of a triangle that is nearest to a given one.
///
/// Source: Eberly, "Distance Between Point and Triangle in 3D", Geometric Tools, 1999 (the foot of
/// the perpendicular where it lies inside, else a point of the edges).
/// Differs: no classification into regions, whose signs are lost in slivers. The least of the three
/// edges' points and of the foot counts, which is corrected once from what is left of the offset.
/// Conventions: triangles without area are segments or points. The distance is that of a point
/// which lies on the triangle within the rounding of its coordinates; what is left of the exact one
/// is below 4e-15 of the largest coordinate. Differences of coordinates are 1e-75 to 1e75, or 0:
/// their fourth powers are not lost.

#include <array>

#include "alhazen/math/vec.h"

namespace alhazen {

struct PointOnTriangle {
    Vec3 point;
    double u = 0, v = 0;  ///< weights of the second and the third corner
    double squared = 0;   ///< distance
};

[[nodiscard]] PointOnTriangle nearest_on_triangle(const Vec3& from,
                                                  const std::array<Vec3, 3>& corners);

}  // namespace alhazen
