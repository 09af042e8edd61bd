#pragma once
/// A camera whose pixels are the unit of length.

#include "alhazen/cameras/camera.h"

namespace alhazen::testing {

/// Pixels are squares of side 1 in a picture of `size` x `size`: (x, y) in the middle is (0, 0).
inline OrthographicCamera unit_pixels(int size) {
    const double side = size;
    return {{0, 0, 100}, {0, 0, -1}, {side, 0, 0}, {0, side, 0}};
}

}  // namespace alhazen::testing
