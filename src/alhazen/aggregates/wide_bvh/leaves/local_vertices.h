#pragma once
/// The vertices of the meshes of a table, rounded to float in the frame of a tree: each is rounded
/// once, not once for each of its triangles, and takes one register.

#include <cstdint>
#include <vector>

#include "alhazen/accel/wide_bvh/build/box4.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/base/huge_array.h"
#include "alhazen/simd/registers.h"

namespace alhazen {

class PrimitiveTable;

class LocalVertices {
  public:
    /// True if the vertices of the meshes, one mesh used several times counted as often, have
    /// 32-bit numbers.
    [[nodiscard]] static bool can_number(const PrimitiveTable& table);

    /// The vertices must have numbers.
    LocalVertices(const PrimitiveTable& table, const LocalFrame& frame);

    /// The vertices of the i-th mesh begin with this number.
    [[nodiscard]] std::uint32_t first(std::size_t mesh) const { return firsts_[mesh]; }
    /// The fourth lane is 1 if the coordinates are exact, else 0.
    [[nodiscard]] const Float4& operator[](std::uint32_t vertex) const { return all_[vertex]; }

    /// The box of triangles with these vertices, a few steps larger than the rounded box of the
    /// padded ones.
    [[nodiscard]] Box4 padded(Float4 lo, Float4 hi) const {
        // The rounding of a coordinate, of its margin and of their difference take less than the
        // margin's four halves of an ulp.
        Box4 box;
        box.lo = lo - (magnitude(lo) * 0x1p-22f + pad_);
        box.hi = hi + (magnitude(hi) * 0x1p-22f + pad_);
        return box;
    }

  private:
    static Float4 magnitude(Float4 v) { return greater(v, -v); }

    std::vector<std::uint32_t> firsts_;  ///< [mesh]
    HugeArray<Float4> all_;
    float pad_;
};

}  // namespace alhazen
