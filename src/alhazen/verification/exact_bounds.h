#pragma once
/// The box of a scene as it was given: without the margins that the boxes of accelerators have.
///
/// Conventions: endless shapes are left out, others are given to 13 digits. Corners of meshes are
/// as they were placed; what an instance holds is looked at corner by corner while that takes
/// little time, then by its box.

#include "alhazen/geometry/box.h"
#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// O(vertices), and at most as many of instances as kMaxPlacedCorners.
[[nodiscard]] Box3 exact_bounds(const Aggregate& aggregate);

inline constexpr std::size_t kMaxPlacedCorners = 20'000'000;

}  // namespace alhazen
