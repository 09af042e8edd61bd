#pragma once
/// Merges corners of exactly equal position into one vertex.
///
/// Conventions: -0 equals 0 and is stored as 0; positions must not be NaN.
/// Complexity: as IndexTable; the keys are the mesh positions.

#include <bit>
#include <cstdint>

#include "alhazen/formats/mesh/index_table.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

class VertexWelder {
  public:
    /// Appends vertices to `mesh`, which must be empty; reserves for about `expected`.
    VertexWelder(TriangleMesh& mesh, std::size_t expected) : mesh_(mesh), table_(expected) {
        mesh_.positions.reserve(expected);
    }

    std::uint32_t find_or_add(const Vec3& corner) {
        const Vec3 p{corner.x + 0.0, corner.y + 0.0, corner.z + 0.0};
        std::vector<Vec3>& positions = mesh_.positions;
        const std::uint32_t index = table_.find_or_add(
            hash(p), positions.size(), [&](std::uint32_t i) { return positions[i] == p; },
            [&](std::uint32_t i) { return hash(positions[i]); });
        if (index == positions.size()) positions.push_back(p);
        return index;
    }

  private:
    [[nodiscard]] std::uint64_t hash(const Vec3& p) const {
        return table_.hash({std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
                            std::bit_cast<std::uint64_t>(p.z)});
    }

    TriangleMesh& mesh_;
    IndexTable table_;
};

}  // namespace alhazen
