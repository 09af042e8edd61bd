#pragma once
/// Algebraic surfaces for tests.

#include "alhazen/shapes/algebraic/algebraic.h"

namespace alhazen::testing {

/// The surface inside the cube of half the side `side`, prepared.
inline Algebraic surface_in_cube(const char* expression, double side, bool capped) {
    Algebraic shape;
    shape.expression = expression;
    shape.clip_box = {{-side, -side, -side}, {side, side, side}};
    shape.capped = capped;
    shape.prepare();
    return shape;
}

}  // namespace alhazen::testing
