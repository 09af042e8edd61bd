#pragma once
/// The solids of a cone scene that contain a point, and where lines leave them.
///
/// Source: Haines, "Point in Polygon Strategies", Graphics Gems IV, 1994 (the odd-even rule, here
/// of a line and a closed mesh; Haines's convention for edges).
/// Conventions: points on a boundary count as inside, those of meshes as either.
/// Complexity: O(log n) for n solids whose boxes do not overlap; in a mesh O(triangles near the
/// line).

#include "alhazen/base/inline_vector.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/renderers/cone_tracing/cone_scene.h"

namespace alhazen {

/// Indices of sources. Of more than eight the smallest boxes, which a view meets first.
using SolidsAround = InlineVector<std::uint32_t, 8>;

[[nodiscard]] SolidsAround solids_around(const ConeScene& scene, const Vec3& point);

/// True if the closed source contains the point.
[[nodiscard]] bool contains_point(const ConeScene& scene, std::uint32_t source, const Vec3& point);

/// True if the corners of a triangle of a closed mesh are clockwise from outside; `tree`: over its
/// triangles. Precondition: the triangle is not parallel to the x axis.
[[nodiscard]] bool faces_inward(const ConeTree& tree, const TriangleMesh& mesh,
                                std::uint32_t triangle);

/// The boundary of a closed source that a ray meets.
struct ConeWall {
    double t = 0;  ///< in lengths of the ray's direction
    std::uint32_t part = 0;
    double u = 0, v = 0;  ///< as of ConePiece
};
/// Where a ray that starts on the boundary of a closed source, or inside, next meets the boundary,
/// at most at `ray.t_max`. `part`: the face or triangle on which it starts.
[[nodiscard]] ConeWall wall_ahead(const ConeScene& scene, std::uint32_t source, std::uint32_t part,
                                  const Ray& ray);

}  // namespace alhazen
