#pragma once
/// Triangles within a tolerance of a solid, from its crossings with lines.
///
/// Source: Ju, Losasso, Schaefer and Warren, "Dual Contouring of Hermite Data", SIGGRAPH 2002: a
/// vertex for each cell of a lattice that the surface passes through, nearest to the tangent planes
/// where it crosses the cell's edges; a quadrangle around each edge that it crosses.
/// Differs: no function is sampled. Lattice points are in or out by the spans of lines along z;
/// crossings and normals are exact. One size of cells for the solid, halved until it serves.
/// Conventions: the frame of the solid's scene; counterclockwise from outside; closed, with the
/// normals of the exact surface. All points of a face are within a cell's diagonal of the surface,
/// so cells of that size need no test. Larger ones serve where lines through the corners, the edges
/// and the middle of each triangle meet the surface within half the tolerance, and no part or gap
/// thicker than the tolerance lies between lattice points. Parts thinner than it may be missing.
/// Complexity: O((size / cell)^3) lattice points, O((size / cell)^2) lines and triangles.

#include <cstdint>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

/// Makes a mesh with the materials of a CSG object at its vertices (one for the three of a
/// triangle). Returns false where there would be more than `max_triangles`.
/// Preconditions: the box of the solid is bounded; tolerance > 0.
[[nodiscard]] bool make_solid_triangles(const IsolatedSolid& solid, double tolerance,
                                        std::uint64_t max_triangles, TriangleMesh& mesh);

}  // namespace alhazen
