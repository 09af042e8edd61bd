#pragma once
/// Gives corners of exactly equal position the same vertex: a hash table with linear probing over
/// the positions of the mesh itself.
///
/// Conventions: -0 equals 0 and is stored as 0; positions must not be NaN.
/// Complexity: O(1) expected a corner; two to four slots of 4 bytes a vertex.

#include <bit>
#include <cstdint>
#include <vector>

#include "alhazen/shapes/triangle_mesh.h"

namespace alhazen {

class VertexWelder {
  public:
    /// Vertices are added to `mesh`, which must be empty; about `expected` of them.
    VertexWelder(TriangleMesh& mesh, std::size_t expected)
        : mesh_(mesh), slots_(std::bit_ceil(2 * expected + 16), kNone) {
        mesh_.positions.reserve(expected);
    }

    std::uint32_t find_or_add(const Vec3& corner) {
        const Vec3 p{corner.x + 0.0, corner.y + 0.0, corner.z + 0.0};
        std::vector<Vec3>& positions = mesh_.positions;
        std::size_t slot = first_slot(p);
        for (; slots_[slot] != kNone; slot = (slot + 1) & (slots_.size() - 1)) {
            if (positions[slots_[slot]] == p) return slots_[slot];
        }
        const std::uint32_t index = std::uint32_t(positions.size());
        positions.push_back(p);
        slots_[slot] = index;
        if (2 * positions.size() > slots_.size()) grow();
        return index;
    }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    [[nodiscard]] std::size_t first_slot(const Vec3& p) const {
        std::uint64_t hash = 0;
        for (const double c : {p.x, p.y, p.z}) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 32;
        }
        return std::size_t(hash) & (slots_.size() - 1);
    }
    void grow() {
        slots_.assign(2 * slots_.size(), kNone);
        for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) {
            std::size_t slot = first_slot(mesh_.positions[i]);
            while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = i;
        }
    }

    TriangleMesh& mesh_;
    std::vector<std::uint32_t> slots_;  ///< a power of two
};

}  // namespace alhazen
