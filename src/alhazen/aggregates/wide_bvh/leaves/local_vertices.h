#pragma once
/// The vertices of the meshes of a table, rounded to float in the frame of a tree: each is rounded
/// once, not once for each of its triangles, and takes one register.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/accel/wide_bvh/build/box4.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/base/huge_array.h"
#include "alhazen/simd/registers.h"

namespace alhazen {

/// The triangles of a block: its lanes, the unused ones included.
struct LaneTriangles {
    std::uint32_t corner[3][kBlockWidth];  ///< numbers of vertices
    BlockId ids[kBlockWidth];
    std::uint32_t count = 0;  ///< used lanes
};

class LocalVertices {
  public:
    /// True if the vertices of the meshes, one mesh used several times counted as often, and three
    /// corners more have 32-bit numbers.
    [[nodiscard]] static bool can_number(const PrimitiveTable& table);

    /// The vertices must have numbers.
    LocalVertices(const PrimitiveTable& table, const LocalFrame& frame);

    /// The vertices of the i-th mesh begin with this number.
    [[nodiscard]] std::uint32_t first(std::size_t mesh) const { return firsts_[mesh]; }
    /// The first of the three corners of an unused lane.
    [[nodiscard]] std::uint32_t unused() const { return firsts_.back(); }
    /// The fourth lane is 1 if the coordinates are exact, else 0.
    [[nodiscard]] const Float4& operator[](std::uint32_t vertex) const { return all_[vertex]; }

    /// Writes a block with the vertices and flags that fill_block writes. Returns the area of its
    /// triangles; those that are not opaque count half.
    float fill(TriangleBlock& block, const LaneTriangles& triangles) const;
    /// The box of the triangles, a few steps larger than the rounded box of the padded ones.
    [[nodiscard]] Box4 box(const LaneTriangles& triangles) const;
    /// The area as `fill` returns it.
    [[nodiscard]] float area(const LaneTriangles& triangles) const;

  private:
    std::vector<std::uint32_t> firsts_;  ///< [mesh], and of the corners of unused lanes
    HugeArray<Float4> all_;
    float pad_;
};

}  // namespace alhazen
