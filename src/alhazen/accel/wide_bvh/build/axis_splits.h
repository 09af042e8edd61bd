#pragma once
/// The cheapest split of each axis, with the axes in lanes; shared by bins and sweeps
/// (split_kernels.cpp).

#include <cstdint>
#include <cstring>
#include <limits>

#include "alhazen/accel/wide_bvh/build/sah_split.h"

namespace alhazen {

/// One side of a split, or a bin, of primitives of several kinds.
struct KindBox {
    Box4 box;
    KindCounts count{};
    std::uint32_t unused = 0;

    void include(const KindBox& other) {
        box.include(other.box);
        for (std::size_t k = 0; k < kLeafKinds; ++k) count[k] += other.count[k];
    }
};

/// The cost of a side with these numbers of each kind.
struct SideCost {
    const LeafKinds& kinds;

    [[nodiscard]] float operator()(const Box4& box, const KindCounts& count) const {
        return box.weight() * blocks_cost(count, kinds);
    }
};

/// `mask` ? a : b, lane by lane; a mask has all bits of a lane or none.
inline Float4 chosen(Int4 mask, Float4 a, Float4 b) {
    Int4 x, y;
    std::memcpy(&x, &a, sizeof(x));
    std::memcpy(&y, &b, sizeof(y));
    const Int4 bits = (mask & x) | (~mask & y);
    Float4 result;
    std::memcpy(&result, &bits, sizeof(result));
    return result;
}

/// The cheapest split of each axis.
struct AxisSplits {
    static constexpr float kInf = std::numeric_limits<float>::infinity();
    Float4 cost{kInf, kInf, kInf, kInf};
    Int4 last_left{};

    void offer(Float4 sum, Int4 valid, int last) {
        const Int4 better = valid & (sum < cost);
        cost = chosen(better, sum, cost);
        last_left = (better & last) | (~better & last_left);
    }
    /// The cheapest split of all axes, without its boxes.
    [[nodiscard]] ObjectSplit best() const {
        ObjectSplit split;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(cost[axis] < split.cost)) continue;
            split.cost = cost[axis];
            split.axis = axis;
            split.last_left = last_left[axis];
        }
        return split;
    }
};

}  // namespace alhazen
