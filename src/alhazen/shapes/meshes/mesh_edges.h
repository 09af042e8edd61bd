#pragma once
/// Edge topology of a mesh: whether it bounds a volume, and if not, why.
///
/// Derivation: edges are counted by sorting. Conventions: vertices of equal position are merged, 0
/// and -0 alike; triangles with two equal corners are ignored. A mesh is closed if each edge
/// belongs to an even number of triangles: every line then crosses it an even number of times,
/// whatever the winding. It is oriented if equally many triangles traverse each edge in both
/// directions.
/// Complexity: O(n log n).

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

struct MeshEdges {
    static constexpr std::size_t kMostShown = 4;

    std::size_t count = 0;
    std::size_t open = 0;  ///< edges of an odd number of triangles
    std::size_t crowded =
        0;                   ///< edges of an even number of triangles >= 4: parts of the mesh touch
    std::size_t turned = 0;  ///< edges of an even number, not equally many in both directions
    /// Ends of the first open edges, sorted by vertex.
    std::vector<std::array<Vec3, 2>> first_open;
    Box3 open_box;  ///< bounds of all open edges

    [[nodiscard]] bool closed() const { return count > 0 && open == 0; }
    /// True if closed and all triangles face outward or all inward.
    [[nodiscard]] bool oriented() const { return closed() && turned == 0; }
    /// The fault: "3 of 120 edges are open: (0, 0, 1) to (0, 1, 1), ..., all between (0, 0, 1) and
    /// (1, 1, 1)"; or "closed".
    [[nodiscard]] std::string description() const;
};

[[nodiscard]] MeshEdges mesh_edges(const TriangleMesh& mesh);

}  // namespace alhazen
