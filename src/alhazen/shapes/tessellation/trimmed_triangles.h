#pragma once
/// Triangles of the part of a NURBS surface inside its trimming loops.
///
/// Source: after Rockwood, Heaton and Davis, "Real-time rendering of trimmed surfaces", SIGGRAPH
/// 1989 (loops as polylines; the triangles of the surface cut along them).
/// Differs: the triangles of a patch (patch_tessellation.h) and the polylines (trim_division.h)
/// become one triangulation, constrained_triangulation.h; parity, not orientation, decides what is
/// kept.
/// Conventions: each triangle is within the tolerance of the surface, and each point of a loop
/// within the tolerance of the border of the mesh. Vertices are points of the surface and
/// neighbours share them, also those in different patches (by their positions): an edge of one
/// triangle is on a loop or on the border of the domain. A loop that nowhere leaves its chords by
/// more than the tolerance may vanish. Complexity: triangles as the untrimmed patches, and O(1 /
/// sqrt(tolerance)) along loops.

#include <cstdint>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"

namespace alhazen {

/// Appends the triangles; uvs are parameters of the domain. Returns false if the mesh would have
/// more than `max_triangles`. Precondition: the surface is prepared and has loops.
[[nodiscard]] bool append_trimmed_triangles(const NurbsSurface& shape, double tolerance,
                                            std::uint64_t max_triangles, TriangleMesh& mesh);

}  // namespace alhazen
