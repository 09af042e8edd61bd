#include "alhazen/geometry/polygon/merged_positions.h"

#include <array>
#include <bit>
#include <cstddef>

#include "alhazen/base/interruptible_sort.h"

namespace alhazen {

namespace {

/// A position as bits, with -0 equal to 0: a total order that includes NaN.
struct PositionKey {
    std::array<std::uint64_t, 3> bits;
    std::uint32_t vertex;
};

}  // namespace

std::vector<std::uint32_t> merged_positions(std::span<const Vec3> positions) {
    std::vector<PositionKey> keys(positions.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const Vec3 p = positions[i] + Vec3{};
        keys[i] = {{std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
                    std::bit_cast<std::uint64_t>(p.z)},
                   static_cast<std::uint32_t>(i)};
    }
    interruptible_sort(keys.begin(), keys.end(), [](const PositionKey& a, const PositionKey& b) {
        return a.bits != b.bits ? a.bits < b.bits : a.vertex < b.vertex;
    });
    std::vector<std::uint32_t> merged(positions.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const bool same = i > 0 && keys[i].bits == keys[i - 1].bits;
        merged[keys[i].vertex] = same ? merged[keys[i - 1].vertex] : keys[i].vertex;
    }
    return merged;
}

}  // namespace alhazen
