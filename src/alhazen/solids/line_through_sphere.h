#pragma once
/// Lines through a sphere, uniform among all that meet it.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "alhazen/geometry/ray.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/sampling/sobol.h"

namespace alhazen {

/// Line `number` of the sequence of `key`: its direction has length 1, its origin is the point
/// nearest to the centre.
[[nodiscard]] inline Ray line_through_sphere(std::uint64_t key, std::uint32_t number,
                                             const Vec3& center, double radius) {
    const double z = 1 - 2 * scrambled_sobol(key, number, 0);
    const double turn = 2 * kPi * scrambled_sobol(key, number, 1);
    const double across = std::sqrt(std::max(0.0, 1 - z * z));
    const Vec3 d{across * std::cos(turn), across * std::sin(turn), z};
    const Vec3 right = perpendicular(d);
    const double r = radius * std::sqrt(scrambled_sobol(key, number, 2));
    const double angle = 2 * kPi * scrambled_sobol(key, number, 3);
    const Vec3 offset = r * std::cos(angle) * right + r * std::sin(angle) * cross(d, right);
    return {center + offset, d, -kInfinity, kInfinity};
}

}  // namespace alhazen
