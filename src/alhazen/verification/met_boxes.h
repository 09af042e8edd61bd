#pragma once
/// Which boxes of a list a line meets, in lanes of float; never fewer than it does.
///
/// Derivation: along its largest axis, a line is a function with slopes of at most 1 in each of the
/// two others. It meets a box only if, at the middle of the box, it is off the middle by no more
/// than half of the box and what it moves within the box. (Two of three separating axes: boxes
/// beside an edge are met too.) Coordinates are relative to the middle of the list and in units of
/// its size; lines that come near have a start of at most 4. All numbers are then at most 5, and
/// the rounding of positions, slopes and sums together is below 2^-19: boxes are wider by `kRoom`,
/// four times that. The rounding of the exact tests of what is in the boxes, in double from origins
/// of at most 2^28, is far smaller.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

/// Boxes by coordinate, as many as fill whole groups of kGroup; those at the end are never met.
struct BoxList {
    static constexpr std::size_t kGroup = 64;
    static constexpr float kRoom = 0x1p-17f;

    std::array<std::vector<float>, 3> center, half;

    /// Reserves for `count` boxes.
    void reserve(std::size_t count);
    /// `box` in the units above.
    void add(const Box3& box);
    void fill();
};

/// A line in the same units, as a function of the coordinate of `axis`: those of the next two axes
/// (cyclic) are start + slope * coordinate. Slopes are at most 1.
struct BoxLine {
    std::size_t axis = 0;
    std::array<float, 2> start{}, slope{};
};

/// Writes the numbers of the boxes from `begin` to `end`, whole groups, that the line meets;
/// returns how many. `met` has room for all.
[[nodiscard]] std::size_t met_boxes(const BoxList& boxes, const BoxLine& line, std::size_t begin,
                                    std::size_t end, std::uint32_t* met);

}  // namespace alhazen
