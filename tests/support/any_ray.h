#pragma once
/// Hard rays for tests of shapes, and tolerances for comparing crossings.

#include <bit>
#include <ios>
#include <limits>
#include <sstream>
#include <string>

#include "alhazen/geometry/box.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "support/random.h"

namespace alhazen::testing {

inline bool same_bits(const ShapeHit& a, const ShapeHit& b) {
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    return bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v) &&
           a.part == b.part;
}

/// The exact values of the ray as text.
inline std::string to_text(const Ray& ray) {
    std::ostringstream out;
    out << std::hexfloat << "origin " << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z
        << " direction " << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z
        << " t " << ray.t_min << " " << ray.t_max;
    return out.str();
}

/// A random ray of one of many kinds: from outside, inside or far away, grazing, along an axis with
/// zeros of either sign, with any range and length.
inline Ray any_ray(const Box3& box, Random& random) {
    Vec3 target;
    for (int k = 0; k < 3; ++k) target[k] = random.uniform(box.lo[k], box.hi[k]);
    const double size = length(box.size());
    Vec3 direction = random.log_uniform(1e-3, 1e3) * random.unit_vector();
    const int kind = random.below(6);
    if (kind == 0) {  // along an axis or in a plane of two, the rest zeros of either sign
        const int axis = random.below(3);
        for (int k = 0; k < 3; ++k) {
            if (k != axis && random.below(3) != 0) direction[k] = random.coin() ? 0.0 : -0.0;
        }
    }
    if (kind == 1) {  // along a face of the box or through its middle
        const int axis = random.below(3);
        target[axis] = random.coin() ? box.lo[axis] : 0.5 * (box.lo[axis] + box.hi[axis]);
        if (random.coin()) direction[axis] = 0.0;
        if (!(length(direction) > 0.0)) direction[(axis + 1) % 3] = 1.0;
    }
    const double distance[] = {0.0, 0.5, 3.0, 100.0, 1e5, 1e9};
    const double away = distance[random.below(6)] * size / length(direction);
    Ray ray{target - away * direction, direction};
    if (random.below(4) == 0) ray.t_min = -std::numeric_limits<double>::infinity();
    if (random.below(5) == 0) ray.t_min = random.uniform(-0.1, 1.1) * away;
    if (random.below(5) == 0) ray.t_max = ray.t_min + random.uniform(0, 2) * (away + 0.1);
    return ray;
}

}  // namespace alhazen::testing
