#pragma once
/// The segments that separate the inside of loops, by the odd-even rule, from the outside: a part
/// that an even number of segments share has the same on both sides.
///
/// Conventions: parts of segments coincide where they lie on one line, exactly (orientation.h);
/// they end where one of the segments ends.
/// Complexity: O(n log n) plus the pairs of segments whose intervals in x overlap.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

using PlaneSegment = std::array<Vec2, 2>;

/// A part of a segment. Its ends are those of given segments: end e is end e % 2 of segment e / 2.
struct SegmentPart {
    std::uint32_t segment = 0;
    std::uint32_t from = 0, to = 1;
    friend bool operator==(const SegmentPart&, const SegmentPart&) = default;
};

/// The parts that an odd number of segments share, each as a part of the first of them; in the
/// order of the segments, and along them. Segments without length are kept.
[[nodiscard]] std::vector<SegmentPart> odd_segments(std::span<const PlaneSegment> segments);

}  // namespace alhazen
