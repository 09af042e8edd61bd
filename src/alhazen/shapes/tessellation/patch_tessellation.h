#pragma once
/// Tessellation of rational Bezier patches within a tolerance.
///
/// Source: Filip, Magedson and Markot, "Surface algorithms using bounds on derivatives", Computer
/// Aided Geometric Design 3(4), 1986 (a triangle of extents a by b in the parameter plane is within
/// (a^2 M_uu + 2 a b M_uv + b^2 M_vv) / 8 of the patch, M bounds of the second derivatives; it
/// holds for any triangle, as the variance of a value within a range of length a is at most a^2 /
/// 4).
/// Differs: rational patches, by bounds of the quotient's derivatives from the control net; lines
/// of u and v are placed adaptively by these bounds.
/// Conventions: boundary curves are divided independently (curve_division.h), so that patches that
/// share one meet without gaps. Each patch has its own vertices, with its normals. Triangles are
/// oriented by du x dv; triangles without area (at an edge that is one point) are omitted. Any
/// triangle of surface points within one of the parameter plane is within the tolerance as well.
/// Complexity: O(area of curvature / tolerance) triangles for a patch.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

/// Appends triangles within `tolerance` of a patch, in object space. Returns false, with nothing
/// appended, if the mesh would have more than `max_triangles`. Precondition: tolerance > 0.
[[nodiscard]] bool append_triangles(const BezierPiece& piece, double tolerance,
                                    std::uint64_t max_triangles, TriangleMesh& mesh);

/// A point of a patch, with its parameters in the unit square.
struct PatchVertex {
    double u, v;
    Vec3 point;
};
struct PatchTriangles {
    std::vector<PatchVertex> vertices;  ///< some repeat
    std::vector<std::array<std::uint32_t, 3>> triangles;
};
/// The same triangles in the parameter plane. They tile the unit square edge to edge, also at edges
/// that are one point. Nothing if there would be more than `max_triangles`.
[[nodiscard]] std::optional<PatchTriangles> parameter_triangles(const BezierPiece& piece,
                                                                double tolerance,
                                                                std::uint64_t max_triangles);

}  // namespace alhazen
