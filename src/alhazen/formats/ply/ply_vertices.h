#pragma once
/// The meaning of PLY vertex properties, and their conversion to mesh arrays.
///
/// Conventions: names as in docs/reference/formats/ply.md. Integer colours are display-encoded and
/// are converted to linear (IEC 61966-2-1); float colours are linear.

#include <array>
#include <string>
#include <vector>

#include "alhazen/formats/ply/ply_header.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// Linear value of an 8-bit display code.
[[nodiscard]] float linear_of_code(std::uint8_t code);

class PlyVertexLayout {
  public:
    explicit PlyVertexLayout(const PlyElement& element, bool exact);

    [[nodiscard]] bool has_positions() const { return has(kX, 3); }
    /// Properties that are ignored because others replace them or are missing; a sentence each.
    [[nodiscard]] const std::vector<std::string>& oddities() const { return oddities_; }
    /// Reserves memory in the arrays in use.
    void reserve(TriangleMesh& mesh, std::uint64_t count) const;
    /// Storage for the value of the k-th property.
    [[nodiscard]] double& value(std::size_t k) { return values_[slots_[k]]; }
    [[nodiscard]] Vec3 position() const { return {values_[kX], values_[kX + 1], values_[kX + 2]}; }
    /// Appends the vertex whose values are set.
    void append(TriangleMesh& mesh) const;

  private:
    /// Slots of the values; the last one collects unused properties.
    static constexpr std::size_t kX = 0, kNormal = 3, kUv = 6, kUv2 = 8, kColor = 10, kAlpha = 13,
                                 kTangent = 14, kMaterial = 18, kUnused = 19;

    [[nodiscard]] bool has(std::size_t first, std::size_t count) const;
    [[nodiscard]] static std::size_t slot_of(const PlyProperty& property, bool exact);
    [[nodiscard]] float color(std::size_t slot) const;

    void find_oddities(const PlyElement& element);

    std::vector<std::size_t> slots_;  ///< [property]
    std::vector<std::string> oddities_;
    std::array<double, kUnused + 1> values_{};
    std::array<bool, kUnused + 1> present_{};
    std::array<PlyType, kUnused + 1> types_{};
    bool normals_, uvs_, uvs2_, colors_, tangents_, materials_;
};

}  // namespace alhazen
