#pragma once
/// Boxes as meshes of twelve triangles.

#include <cstdint>
#include <utility>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::testing {

/// Appends a box as a shell of its own; `inward`: its triangles face its inside.
inline void add_box(TriangleMesh& mesh, const Box3& box, bool inward = false) {
    constexpr std::uint32_t kTriangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                 {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                 {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i) mesh.positions.push_back(box.corner(i));
    for (const auto& t : kTriangles) {
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        if (inward) std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
    }
}

[[nodiscard]] inline TriangleMesh box_mesh(const Box3& box) {
    TriangleMesh mesh;
    add_box(mesh, box);
    return mesh;
}

}  // namespace alhazen::testing
