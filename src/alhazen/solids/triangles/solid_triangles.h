#pragma once
/// Tessellates a solid within a tolerance by its crossings with lines.
///
/// Source: Ju, Losasso, Schaefer and Warren, "Dual Contouring of Hermite Data", SIGGRAPH 2002.
/// Differs: surface_cells.h. Cells are halved where half the tolerance does not hold; triangles are
/// then merged within the other half (collapsed_edges.h).
/// Conventions: the frame of the solid's scene; counterclockwise from outside; closed, with the
/// normals of the exact surface. All points of a face are within a cell's diagonal of the surface,
/// so cells whose diagonal is half the tolerance need no test. Faces of larger cells, where a
/// vertex may be half a cell beside its own to be on an edge of the surface, are accepted if lines
/// through 15 points of each triangle meet the surface within half the tolerance, no triangle faces
/// away from all of the surface there, and no part or gap thicker than the tolerance lies within an
/// edge of a cell. The largest cells are 1/24 of the size of the solid, or half the least side of
/// the box of a leaf, where these are not too many. The middles of parts and gaps are not missed of
/// lines through each leaf, in the directions in which it is thin or long and as far apart as it is
/// thin (at most 1024 along each; fewer from 64 leaves on, at least one), and of lines a quarter of
/// the largest cells apart.
/// Parts thinner than the tolerance may be missing. Texture coordinates are those of the shape
/// whose surface is at the triangle, also of the operands of a CSG object: vertices at which they
/// change by a jump (between shapes, faces and at seams) are several. A triangle across a seam goes
/// on beyond 1; around a pole they are wrong in single triangles.
/// Complexity: O(triangles before they are merged); of flat faces they do not depend on the
/// tolerance, along curved edges and in curved faces they do.

#include <cstdint>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

/// What a mesh of a solid lacks.
struct SolidTrianglesReport {
    /// If there are too many triangles, a tolerance that may leave no more than the limit; 0 if
    /// none is known.
    double larger_tolerance = 0;
    /// Leaves of the solid, or gaps that they leave, thinner than the tolerance and without a
    /// triangle beside them.
    std::uint64_t lost_parts = 0;
};

/// Creates a mesh with the materials of a CSG object at its vertices (the same for the three
/// vertices of a triangle). Returns false if there would be more than `max_triangles` before they
/// are merged. `with_uvs` false: texture coordinates are zero, and there are fewer vertices.
/// Preconditions: the box of the solid is bounded; tolerance > 0.
[[nodiscard]] bool make_solid_triangles(const IsolatedSolid& solid, double tolerance,
                                        std::uint64_t max_triangles, TriangleMesh& mesh,
                                        bool with_uvs = false,
                                        SolidTrianglesReport* report = nullptr);

}  // namespace alhazen
