#pragma once
/// The exact sign of the orientation of three points in the plane: the side of the line through two
/// of them on which the third lies.
///
/// Source: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", Discrete & Computational Geometry 18, 1997: the filter of section 4.1, two-sums and
/// two-products of section 2.
/// Differs: one stage follows the filter: the exact sum of all nonzero products.
/// Conventions: exact for all finite points whose differences multiply without over- and underflow;
/// callers scale other points. The result for NaN is 0.

#include <cmath>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The sign where the filter of orientation(), which calls this, fails. Slower.
[[nodiscard]] int exact_orientation(Vec2 a, Vec2 b, Vec2 c);

/// 1 if a, b, c turn left (counter-clockwise), -1 if they turn right, 0 if they are collinear.
[[nodiscard]] inline int orientation(Vec2 a, Vec2 b, Vec2 c) {
    constexpr double kFilter = 3.3306690738754716e-16;  // (3 + 16 e) e with e = 2^-53
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double sum = left - right;
    const double bound = kFilter * (std::abs(left) + std::abs(right));
    if (sum > bound) return 1;
    if (sum < -bound) return -1;
    return exact_orientation(a, b, c);
}

}  // namespace alhazen
