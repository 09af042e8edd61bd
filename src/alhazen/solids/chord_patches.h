#pragma once
/// The parts of a base plane of parallel lines that the shadows of a solid's parts cover.
///
/// Implementation of solid_measures.h: where no part casts a shadow, no line needs to be cast.

#include <span>
#include <vector>

#include "alhazen/math/interval.h"

namespace alhazen {

struct ChordPatch {
    Interval right, up;
};

/// Disjoint rectangles that contain the rectangles right[i] x up[i]: their bounding rectangle is
/// divided at gaps as long as at least half of it along an axis is empty, into at most 64.
/// Preconditions: as many intervals along both axes, at least one; all are bounded, none is empty.
/// Complexity: O(n log n) per rectangle of the result.
[[nodiscard]] std::vector<ChordPatch> chord_patches(std::span<const Interval> right,
                                                    std::span<const Interval> up);

}  // namespace alhazen
