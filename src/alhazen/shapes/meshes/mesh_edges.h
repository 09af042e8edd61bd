#pragma once
/// Edge connectivity of a mesh: whether it bounds a volume, and if not, why.
///
/// Derivation: edges counted by sorting.
/// Conventions: vertices of equal position are merged, 0 and -0 alike; triangles of two equal
/// corners are ignored. A mesh is closed when each edge belongs to two triangles: every line then
/// crosses it an even number of times, for any winding of the triangles.
/// Complexity: O(n log n) for any input.

#include <cstddef>
#include <string>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

struct MeshEdges {
    std::size_t count = 0;
    std::size_t open = 0;     ///< of one triangle
    std::size_t crowded = 0;  ///< of more than two
    std::size_t turned = 0;   ///< of two triangles that traverse it in the same direction

    [[nodiscard]] bool closed() const { return count > 0 && open == 0 && crowded == 0; }
    /// Closed, with all triangles facing outward or all inward.
    [[nodiscard]] bool oriented() const { return closed() && turned == 0; }
    /// Describes the defects: "3 of 120 edges belong to one triangle only, 1 to more than two"; or
    /// "closed".
    [[nodiscard]] std::string description() const;
};

[[nodiscard]] MeshEdges mesh_edges(const TriangleMesh& mesh);

}  // namespace alhazen
