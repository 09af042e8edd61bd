#pragma once
/// Computes the corners of a convex solid given by planes.
///
/// Source: Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17, 1974: each face is a
/// large square of its plane, clipped by all other planes.
/// Differs: every edge stores the plane that cut it, so each corner is recomputed as the common
/// point of its three planes, independently of the size of the square.
/// Conventions: normals are unit and point outward.
/// Complexity: O(planes^2) for faces of few corners.

#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The half space on the inner side of a plane.
struct OrientedPlane {
    Vec3 point{};
    Vec3 normal{0, 0, 1};  ///< outward
};

struct ConvexCorners {
    bool bounded = false;                ///< false also for solids beyond `kReach` (see the .cpp)
    std::vector<Vec3> corners;           ///< of all faces, one after another; shared corners repeat
    std::vector<std::size_t> face_ends;  ///< [plane] one past its last corner
};

/// The faces of the intersection of half spaces; if it is empty, no face has corners.
[[nodiscard]] ConvexCorners convex_corners(const std::vector<OrientedPlane>& planes);

/// Volume within the faces. Precondition: bounded.
[[nodiscard]] double convex_volume(const ConvexCorners& solid);

}  // namespace alhazen
