#pragma once
/// The shells of a mesh: sets of triangles that are connected by edges.
///
/// Conventions: vertices of equal position are merged, where the mesh has more than one shell
/// without that. An inward shell whose vertex lies on another shell counts as a cavity.
/// Complexity: O(n log n); of n inward shells a sweep with those triangles of others that are as
/// high as a point of theirs.

#include <cstdint>
#include <vector>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

struct MeshShells {
    std::vector<std::uint32_t> of_triangle;  ///< [triangle] its shell
    std::uint32_t count = 0;
};
[[nodiscard]] MeshShells mesh_shells(const TriangleMesh& mesh);

/// True if the mesh is closed and oriented (mesh_edges.h), and some shell of it faces inward that
/// is no cavity of others: what it encloses has a negative winding number. Precondition: the mesh
/// is valid.
[[nodiscard]] bool has_inward_shell(const TriangleMesh& mesh);

}  // namespace alhazen
