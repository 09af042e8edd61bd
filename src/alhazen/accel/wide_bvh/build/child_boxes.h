#pragma once
/// The boxes of the children of a wide node while `collapse` makes it: their weights, their rows in
/// the node, and the orders of the children.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/simd/registers.h"

namespace alhazen {

/// Four vectors as their first, second and third components.
struct Components {
    Float4 x, y, z;

    Components(Float4 a, Float4 b, Float4 c, Float4 d) {
        const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
        const Float4 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
        x = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
        y = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
        z = __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 6, 3, 7),
                                    __builtin_shufflevector(c, d, 2, 6, 3, 7), 0, 1, 4, 5);
    }
};

inline constexpr float kEmptySide = std::numeric_limits<float>::infinity();

/// The boxes of some binary nodes. The fourth lanes of free slots are not defined.
template <std::size_t Width>
struct ChildBoxes {
    std::array<Float4, Width> lo, hi;

    /// No ray intersects the boxes of free slots.
    ChildBoxes() {
        lo.fill(Float4{kEmptySide, kEmptySide, kEmptySide, kEmptySide});
        hi.fill(Float4{-kEmptySide, -kEmptySide, -kEmptySide, -kEmptySide});
    }
    /// The fourth lanes are 0.
    void set(std::size_t slot, const BinaryNode& node) {
        static_assert(offsetof(BinaryNode, box) == 0 && offsetof(FloatBox, hi) == 12);
        const auto* const first = reinterpret_cast<const std::byte*>(&node);
        Int4 low, high;
        std::memcpy(&low, first, sizeof(low));
        std::memcpy(&high, first + offsetof(FloatBox, hi), sizeof(high));
        low &= Int4{-1, -1, -1, 0};
        high &= Int4{-1, -1, -1, 0};
        std::memcpy(&lo[slot], &low, sizeof(low));
        std::memcpy(&hi[slot], &high, sizeof(high));
    }
    /// [slot] As FloatBox::weight; those of free slots are those of points.
    [[nodiscard]] std::array<float, Width> weights(std::size_t used) const {
        std::array<float, Width> all;
        std::array<Float4, Width> size{};
        for (std::size_t i = 0; i < used; ++i) size[i] = hi[i] - lo[i];
        for (std::size_t i = 0; i < Width; i += 4) {
            const auto [x, y, z] = Components(size[i], size[i + 1], size[i + 2], size[i + 3]);
            const Float4 weight = x * y + y * z + z * x + 1e-6f * (x + y + z) + 1e-12f;
            std::memcpy(&all[i], &weight, sizeof(weight));
        }
        return all;
    }
    void store(WideNodeOf<Width>& node) const {
        for (std::size_t i = 0; i < Width; i += 4) {
            const Components low(lo[i], lo[i + 1], lo[i + 2], lo[i + 3]);
            const Components high(hi[i], hi[i + 1], hi[i + 2], hi[i + 3]);
            const Float4 rows[6] = {low.x, low.y, low.z, high.x, high.y, high.z};
            for (std::size_t k = 0; k < 6; ++k) std::memcpy(&node.planes[k][i], &rows[k], 16);
        }
    }
};

/// The children from the largest promise to the least, those of equal ones in their order: by
/// ranks, without branches.
template <std::size_t Width>
[[nodiscard]] std::array<std::uint32_t, Width> by_promise(const std::array<float, Width>& promise,
                                            std::uint32_t count) {
    std::array<std::uint32_t, Width> order{}, rank{};
    for (std::size_t first = 0; first < count; first += 4) {
        Float4 here;
        std::memcpy(&here, promise.data() + first, sizeof(here));
        const Int4 lane = Int4{0, 1, 2, 3} + static_cast<int>(first);
        Int4 ranks{};
        for (std::uint32_t i = 0; i < count; ++i) {
            const Float4 other = Float4{} + promise[i];
            const Int4 before = Int4{} + static_cast<int>(i) < lane;
            ranks -= (other > here) | ((other == here) & before);  // -1 where true
        }
        std::memcpy(rank.data() + first, &ranks, sizeof(ranks));
    }
    for (std::uint32_t i = 0; i < count; ++i) order[rank[i]] = i;
    return order;
}

/// As WideNodeOf::set_order. Ranks the children of all octants at once, one octant per lane,
/// without branches, as the order is unpredictable.
template <std::size_t Width>
void set_order(WideNodeOf<Width>& node, const ChildBoxes<Width>& boxes, std::uint32_t used) {
    Float4 along[Width];
    Int4 rank[Width];  // from the farthest
    for (std::uint32_t i = 0; i < used; ++i) {
        const Float4 center2 = boxes.lo[i] + boxes.hi[i];
        const Float4 x = __builtin_shufflevector(center2, center2, 0, 0, 0, 0);
        const Float4 y = __builtin_shufflevector(center2, center2, 1, 1, 1, 1);
        const Float4 z = __builtin_shufflevector(center2, center2, 2, 2, 2, 2);
        const Float4 here = x * Float4{1, -1, 1, -1} + y * Float4{1, 1, -1, -1} + z;
        along[i] = here;
        Int4 sooner = Int4{} + static_cast<int>(i);
        for (std::uint32_t k = 0; k < i; ++k) {
            const Int4 later = along[k] < here;  // -1 where true
            rank[k] -= later;
            sooner += later;
        }
        rank[i] = sooner;
    }
    using Order = typename WideNodeOf<Width>::Order;
    constexpr std::uint32_t kBits = WideNodeOf<Width>::kSlotBits;
    std::uint64_t all[4]{}, across[4]{};  // the opposite octant has the reverse order
    if constexpr (Width <= 8) {
        // Sums of i 2^(kBits place), exact in floats: integers of 24 bits at most.
        const auto power = [](Int4 exponent) {
            const Int4 bits = (exponent + 127) << 23;
            Float4 value;
            std::memcpy(&value, &bits, sizeof(value));
            return value;
        };
        Float4 sum{}, reverse{};
        const auto last = static_cast<std::int32_t>(kBits * (used - 1));
        for (std::uint32_t i = 1; i < used; ++i) {
            const Int4 place = rank[i] * static_cast<std::int32_t>(kBits);
            const auto slot = static_cast<float>(i);
            sum += slot * power(place);
            reverse += slot * power(last - place);
        }
        for (std::size_t octant = 0; octant < 4; ++octant) {
            all[octant] = static_cast<std::uint32_t>(sum[octant]);
            across[octant] = static_cast<std::uint32_t>(reverse[octant]);
        }
    } else {
        for (std::uint32_t i = 0; i < used; ++i) {
            for (int octant = 0; octant < 4; ++octant) {
                const auto place = static_cast<std::uint32_t>(rank[i][octant]);
                all[octant] |= std::uint64_t{i} << kBits * place;
                across[octant] |= std::uint64_t{i} << kBits * (used - 1 - place);
            }
        }
    }
    std::uint64_t free = 0;  // free slots keep their place
    for (std::uint32_t i = used; i < Width; ++i) free |= std::uint64_t{i} << kBits * i;
    for (std::size_t octant = 0; octant < 4; ++octant) {
        node.order[octant] = static_cast<Order>(all[octant] | free);
        node.order[7 - octant] = static_cast<Order>(across[octant] | free);
    }
}

}  // namespace alhazen
