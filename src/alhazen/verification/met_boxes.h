#pragma once
/// Finds the boxes of a list that a line meets, in lanes of float; conservative.
///
/// Derivation: as a function of the coordinate along its largest axis, a line has slopes of at most
/// 1 in the other two coordinates. It meets a box only if, at the middle of the box, its distance
/// from the middle is at most half the box plus its motion within the box. (These are two of three
/// separating axes: lines that pass beside an edge may be reported too.) Coordinates are relative
/// to the middle of the list and in units of its size; lines near the list start at most 4 away.
/// All numbers are then at most 5, and the rounding of positions, slopes and sums together is below
/// 2^-19: boxes are enlarged by `kMargin`, four times that. The rounding of the exact tests of the
/// contents of the boxes, in double from origins of at most 2^28, is far smaller.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

/// Boxes by coordinate, padded to whole groups of kGroup with boxes that no line meets.
struct BoxList {
    static constexpr std::size_t kGroup = 64;
    static constexpr float kMargin = 0x1p-17f;

    std::array<std::vector<float>, 3> center, half;

    /// Reserves for `count` boxes.
    void reserve(std::size_t count);
    /// Adds a box in the units above.
    void add(const Box3& box);
    void fill();
};

/// A line in the same units, as a function of the coordinate of `axis`: the coordinates of the next
/// two axes (cyclic) are start + slope * coordinate. |slope| <= 1.
struct BoxLine {
    std::size_t axis = 0;
    std::array<float, 2> start{}, slope{};
};

/// Writes the numbers of the boxes that the line meets, from `begin` to `end` (whole groups), and
/// returns their count. `met` has room for all.
[[nodiscard]] std::size_t met_boxes(const BoxList& boxes, const BoxLine& line, std::size_t begin,
                                    std::size_t end, std::uint32_t* met);

}  // namespace alhazen
