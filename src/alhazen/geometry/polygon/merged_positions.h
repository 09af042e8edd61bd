#pragma once
/// Merges vertices of equal position.
///
/// Derivation: sorting. Conventions: 0 and -0 are equal; a NaN equals a NaN of the same bits.
/// Complexity: O(n log n) for any input. Interruptible (interruption.h).

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// [vertex] the lowest vertex of equal position.
[[nodiscard]] std::vector<std::uint32_t> merged_positions(std::span<const Vec3> positions);

}  // namespace alhazen
