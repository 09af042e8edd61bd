#pragma once
/// The point of a triangle that is nearest to a given point.
///
/// Source: Eberly, "Distance Between Point and Triangle in 3D", Geometric Tools, 1999 (the foot of
/// the perpendicular where it lies inside, else a point of the edges).
/// Differs: no classification into regions, whose signs are unreliable for slivers. The nearest of
/// the points of the three edges and of the foot is chosen; the foot is corrected once by its
/// residual offset.
/// Conventions: triangles without area are segments or points. The distance is that of a point
/// which lies on the triangle within the rounding of its coordinates; the error relative to the
/// exact distance is below 4e-15 of the largest coordinate. Differences of coordinates must be 0 or
/// in 1e-75 to 1e75, so that their fourth powers do not over- or underflow.

#include <array>

#include "alhazen/math/vec.h"

namespace alhazen {

struct PointOnTriangle {
    Vec3 point;
    double u = 0, v = 0;  ///< weights of the second and the third corner
    double squared = 0;   ///< squared distance
};

[[nodiscard]] PointOnTriangle nearest_on_triangle(const Vec3& from,
                                                  const std::array<Vec3, 3>& corners);

}  // namespace alhazen
