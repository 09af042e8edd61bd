#pragma once
/// A ray: origin + t * direction for t in [t_min, t_max].
///
/// Conventions: a transform does not normalise the direction, so t denotes the same point in world
/// and in object space. A ray fills one cache line.

#include <limits>

#include "alhazen/math/affine.h"

namespace alhazen {

struct alignas(64) Ray {
    Vec3 origin;
    Vec3 direction;
    double t_min = 0.0;
    double t_max = std::numeric_limits<double>::infinity();

    [[nodiscard]] Vec3 at(double t) const { return origin + t * direction; }
    [[nodiscard]] bool covers(double t) const { return t_min <= t && t <= t_max; }
};
static_assert(sizeof(Ray) == 64);

/// True if a ray can be traced: finite origin and direction, nonzero direction, t_min a number.
[[nodiscard]] inline bool is_valid(const Ray& ray) {
    return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != Vec3{} &&
           ray.t_min <= ray.t_max;
}

/// The ray in the transformed space. Always inlined: a call would cost as much as the products.
[[gnu::always_inline]] inline Ray transformed(const Affine& to_from, const Ray& ray) {
    return {to_from.point(ray.origin), to_from.vector(ray.direction), ray.t_min, ray.t_max};
}

}  // namespace alhazen
