#pragma once
/// Sorts references along a space-filling curve through their centers.
///
/// Source: Morton, "A Computer Oriented Geodetic Data Base", IBM 1966 (the curve); Lauterbach et
/// al., "Fast BVH Construction on GPUs", CGF 28(2), 2009 (its use).
/// Differs: the first 32 bits of the codes are sorted by digits; the remaining bits only in long
/// runs of equal ones, so that few codes are compared.
/// Complexity and threads: O(n), parallel. The result is the same for every number of threads.

#include <span>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// Writes the references in the order of the curve, and their codes on it, 21 bits per axis; those
/// with the same code stay in their order. All have the same size.
void sort_along_curve(std::span<const BuildReference> references, std::span<BuildReference> sorted,
                      std::span<std::uint64_t> codes);

}  // namespace alhazen
