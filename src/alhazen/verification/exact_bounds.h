#pragma once
/// The box of a scene without the margins of accelerators' boxes.
///
/// Conventions: unbounded shapes are left out; boxes of other shapes are exact to 13 digits.
/// Corners of placed meshes are exact. The contents of an instance are transformed corner by corner
/// up to a limit, beyond it by their box.

#include "alhazen/geometry/box.h"
#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// The exact box. O(vertices); for instances at most kMaxPlacedCorners.
[[nodiscard]] Box3 exact_bounds(const Aggregate& aggregate);

inline constexpr std::size_t kMaxPlacedCorners = 20'000'000;

}  // namespace alhazen
