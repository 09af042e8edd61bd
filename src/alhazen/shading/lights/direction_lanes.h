#pragma once
/// Directions and their places in a DirectionPicture, for up to sixteen in lanes.
///
/// Conventions: those of DirectionPicture; the bits are those of math/angles.h.

#include <cstddef>

namespace alhazen {

struct DirectionLanes {
    static constexpr std::size_t kMost = 16;
    using Numbers = double[kMost];  ///< [lane]

    /// Sets `column` and `row` of the first `count` directions.
    void find_places(std::size_t count);
    /// Sets x and y of the first `count` directions by `column` and z.
    void find_directions(std::size_t count);

    alignas(64) Numbers x = {}, y = {}, z = {};  ///< unit directions
    alignas(64) Numbers column = {}, row = {};   ///< in fractions of the picture
};

}  // namespace alhazen
