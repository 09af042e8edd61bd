#pragma once
/// Sorts references along a space-filling curve through their centers.
///
/// Source: Morton, "A Computer Oriented Geodetic Data Base", IBM 1966 (the curve); Lauterbach et
/// al., "Fast BVH Construction on GPUs", CGF 28(2), 2009 (its use).
/// Complexity and threads: O(n), parallel; the result is the same for every number of threads.

#include <vector>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// Sorts `references`; returns their codes on the curve, 21 bits per axis.
[[nodiscard]] std::vector<std::uint64_t> sort_along_curve(std::vector<BuildReference>& references);

}  // namespace alhazen
