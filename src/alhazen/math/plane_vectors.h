#pragma once
/// Products of vectors in a plane.

#include "alhazen/math/vec.h"

namespace alhazen {

/// Twice the signed area of the triangle of the origin, a and b.
[[nodiscard]] constexpr double cross_of(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}
[[nodiscard]] constexpr double dot_of(const Vec2& a, const Vec2& b) {
    return a.x * b.x + a.y * b.y;
}

}  // namespace alhazen
