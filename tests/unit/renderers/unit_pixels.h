#pragma once
/// A camera whose pixels are the unit of length, and rectangles before it.

#include "alhazen/cameras/camera.h"
#include "alhazen/shapes/polygons/rectangle.h"

namespace alhazen::testing {

/// Pixels are squares of side 1 in a picture of `size` x `size`: (x, y) in the middle is (0, 0).
inline OrthographicCamera unit_pixels(int size) {
    const double side = size;
    return {{0, 0, 100}, {0, 0, -1}, {side, 0, 0}, {0, side, 0}};
}

/// Fills the columns from left to right.
inline Rectangle upright(double left, double right, double z = 0) {
    return {.corner = {left, -9, z}, .edge_u = {right - left, 0, 0}, .edge_v = {0, 18, 0}};
}

}  // namespace alhazen::testing
