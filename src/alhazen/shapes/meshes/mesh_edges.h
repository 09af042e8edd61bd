#pragma once
/// How the triangles of a mesh hold together: whether it bounds a volume, and if not, why.
///
/// Derivation: edges counted by sorting. Conventions: vertices of equal position are one, 0 and -0
/// alike; triangles of two equal corners are none. A mesh is closed when each edge belongs to two
/// triangles: every line then crosses it evenly often, whichever way the triangles are wound.
/// Complexity: O(n log n), whatever the input.

#include <cstddef>
#include <string>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

struct MeshEdges {
    std::size_t count = 0;
    std::size_t open = 0;     ///< of one triangle
    std::size_t crowded = 0;  ///< of more than two
    std::size_t turned = 0;   ///< of two triangles that do not run along it in opposite directions

    [[nodiscard]] bool closed() const { return count > 0 && open == 0 && crowded == 0; }
    /// Closed, and all triangles face outward or all inward.
    [[nodiscard]] bool oriented() const { return closed() && turned == 0; }
    /// What is amiss: "3 of 120 edges belong to one triangle only, 1 to more than two"; or
    /// "closed".
    [[nodiscard]] std::string description() const;
};

[[nodiscard]] MeshEdges mesh_edges(const TriangleMesh& mesh);

}  // namespace alhazen
