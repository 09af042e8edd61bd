#pragma once
/// The part of a NURBS surface's triangles inside the trimming loops.
///
/// Source: after Rockwood, Heaton and Davis, "Real-time rendering of trimmed surfaces", SIGGRAPH
/// 1989 (triangles in the parameter plane, cut along the loops). Differs: loops are not divided
/// into polygons; triangles around them are halved until an edge is at most the tolerance, then cut
/// where the region ends along their edges.
/// Conventions: halved triangles stay flat, thus within the tolerance of the surface; the border is
/// within the tolerance of the loops. The mesh is not closed.

#include <cstdint>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"

namespace alhazen {

/// Removes or cuts the triangles of `mesh`, whose uvs are parameters of the domain. Returns false
/// if there would be more than `max_triangles`.
[[nodiscard]] bool trim_triangles(const NurbsSurface& shape, double tolerance,
                                  std::uint64_t max_triangles, TriangleMesh& mesh);

}  // namespace alhazen
