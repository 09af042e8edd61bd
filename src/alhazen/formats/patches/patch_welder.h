#pragma once
/// Merges Bezier patches of one pair of degrees into a patch mesh with shared control points.
///
/// Conventions: control points of exactly equal position and weight are merged; -0 equals 0 and is
/// stored as 0. Values must be finite. Weights are kept only if one of them differs from 1.
/// Complexity: O(1) per control point; memory as IndexTable, besides the mesh.

#include <bit>
#include <cstdint>
#include <span>

#include "alhazen/formats/mesh/index_table.h"
#include "alhazen/shapes/patches/patch_mesh.h"

namespace alhazen {

class PatchWelder {
  public:
    PatchWelder(std::uint32_t degree_u, std::uint32_t degree_v) : table_(16) {
        mesh_.degree_u = degree_u;
        mesh_.degree_v = degree_v;
    }
    [[nodiscard]] bool takes(std::uint32_t degree_u, std::uint32_t degree_v) const {
        return mesh_.degree_u == degree_u && mesh_.degree_v == degree_v;
    }
    [[nodiscard]] std::size_t patch_count() const { return mesh_.patch_count(); }

    /// Adds a patch. Precondition: (degree_u + 1) * (degree_v + 1) points, u-major; as many weights
    /// or none.
    void add(std::span<const Vec3> points, std::span<const double> weights = {}) {
        for (std::size_t k = 0; k < points.size(); ++k) {
            mesh_.patches.push_back(find_or_add(points[k], weights.empty() ? 1.0 : weights[k]));
        }
    }
    [[nodiscard]] PatchMesh take() { return std::move(mesh_); }

  private:
    std::uint32_t find_or_add(const Vec3& point, double weight) {
        const Vec3 p{point.x + 0.0, point.y + 0.0, point.z + 0.0};
        if (weight != 1.0 && mesh_.weights.empty()) mesh_.weights.assign(mesh_.points.size(), 1.0);
        const std::uint32_t index = table_.find_or_add(
            hash(p, weight), mesh_.points.size(),
            [&](std::uint32_t i) { return mesh_.points[i] == p && weight_of(i) == weight; },
            [&](std::uint32_t i) { return hash(mesh_.points[i], weight_of(i)); });
        if (index == mesh_.points.size()) {
            mesh_.points.push_back(p);
            if (weight != 1.0 || !mesh_.weights.empty()) mesh_.weights.push_back(weight);
        }
        return index;
    }
    [[nodiscard]] double weight_of(std::uint32_t i) const {
        return mesh_.weights.empty() ? 1.0 : mesh_.weights[i];
    }
    [[nodiscard]] std::uint64_t hash(const Vec3& p, double weight) const {
        return table_.hash({std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
                            std::bit_cast<std::uint64_t>(p.z),
                            std::bit_cast<std::uint64_t>(weight)});
    }

    PatchMesh mesh_;
    IndexTable table_;
};

}  // namespace alhazen
