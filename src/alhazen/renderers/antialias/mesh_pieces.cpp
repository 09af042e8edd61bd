#include "alhazen/renderers/antialias/mesh_pieces.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "alhazen/base/disjoint_sets.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNoPiece = 0xFFFFFFFFu;

std::uint64_t position_hash(const Vec3& p) {
    std::uint64_t hash = 0;
    for (const double c : {p.x, p.y, p.z}) {
        // Adding 0 makes -0 and 0 equal.
        hash = (hash ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 29;
    }
    return hash;
}

}  // namespace

std::vector<std::uint32_t> first_of_position(const std::vector<Vec3>& positions) {
    const std::size_t slots = std::bit_ceil(2 * positions.size() + 1);
    std::vector<std::uint32_t> table(slots, kNoPiece), first(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        std::size_t slot = position_hash(positions[i]) & (slots - 1);
        while (table[slot] != kNoPiece && positions[table[slot]] != positions[i]) {
            slot = (slot + 1) & (slots - 1);
        }
        if (table[slot] == kNoPiece) table[slot] = i;
        first[i] = table[slot];
    }
    return first;
}

MeshPieces::MeshPieces(const TriangleMesh& mesh) : of_vertex(mesh.positions.size(), kNoPiece) {
    DisjointSets sets(first_of_position(mesh.positions));
    for (const auto& corners : mesh.triangles) {
        sets.unite(corners[0], corners[1]);
        sets.unite(corners[0], corners[2]);
    }
    for (const auto& corners : mesh.triangles) {
        const std::uint32_t root = sets.find(corners[0]);
        if (of_vertex[root] == kNoPiece) {
            of_vertex[root] = static_cast<std::uint32_t>(pieces.size());
            pieces.emplace_back();
        }
        for (const std::uint32_t v : corners) {
            of_vertex[v] = of_vertex[root];
            pieces[of_vertex[root]].box.include(mesh.positions[v]);
        }
    }
    for (Piece& piece : pieces) piece.sphere.center = piece.box.center();
    for (std::size_t v = 0; v < of_vertex.size(); ++v) {
        if (of_vertex[v] == kNoPiece) continue;
        BoundingSphere& sphere = pieces[of_vertex[v]].sphere;
        const double away = (1.0 + 1e-15) * length(mesh.positions[v] - sphere.center);
        sphere.radius = std::max(sphere.radius, away);
    }
}

}  // namespace alhazen
