#pragma once
/// How the triangles of a mesh hold together: whether it bounds a volume, and if not, why.
///
/// Derivation: edges counted by sorting. Conventions: vertices of equal position are one, 0 and -0
/// alike; triangles of two equal corners are none. A mesh is closed when each edge belongs to an
/// even number of triangles: every line then crosses it evenly often, whichever way the triangles
/// are wound. It is oriented when as many of them run along each edge one way as the other.
/// Complexity: O(n log n), whatever the input.

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
    std::size_t open = 0;     ///< of an odd number of triangles
    std::size_t crowded = 0;  ///< of four triangles or more, evenly: where parts of the mesh touch
    std::size_t turned = 0;   ///< of an even number that do not run along it equally both ways
    /// Ends of the first open edges, in the order of the vertices.
    std::vector<std::array<Vec3, 2>> first_open;
    Box3 open_box;  ///< around all open edges

    [[nodiscard]] bool closed() const { return count > 0 && open == 0; }
    /// Closed, and all triangles face outward or all inward.
    [[nodiscard]] bool oriented() const { return closed() && turned == 0; }
    /// What is amiss: "3 of 120 edges are open: (0, 0, 1) to (0, 1, 1), ..., all between (0, 0, 1)
    /// and (1, 1, 1)"; or "closed".
    [[nodiscard]] std::string description() const;
};

[[nodiscard]] MeshEdges mesh_edges(const TriangleMesh& mesh);

}  // namespace alhazen
