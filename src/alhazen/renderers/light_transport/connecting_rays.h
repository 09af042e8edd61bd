#pragma once
/// Rays between two points, which end before the surface at the second one.
///
/// Conventions: a ray leaves its surface beside the point (LeavingRays), so it passes beside the
/// second point, too, and may meet the surface there earlier by as much over the cosine. It ends
/// before that, and by the rounding of the test. Where the points' margins are far less than the
/// length, the ray keeps the direction between the points. Otherwise, far from the origin or over
/// short distances, it goes from its start to a point outside of the error bound of the second
/// surface.

#include <cmath>

#include "alhazen/geometry/ray.h"
#include "alhazen/illumination/illumination.h"

namespace alhazen {

/// The earliest end of a ray between two points, as a part of their distance; the end where there
/// is no surface at the second one.
inline constexpr double kBeforeEnd = 1.0 - 1e-7;
/// Largest distance of a ray from its points, relative to its length, at which it keeps its
/// direction.
inline constexpr double kMostBeside = 0x1p-32;

/// A bound of the distance between two points, without the calls that a root or fmax would be.
[[nodiscard]] inline double most_apart(const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
}

/// The rounding of tests of a ray relative to its coordinates and length: that of patches, which
/// is largest (docs/design/secondary_rays.md), four times.
[[nodiscard]] inline double rounding_of_tests(const Vec3& origin, double distance) {
    return 0x1p-42 * (most_apart(origin, {}) + distance);
}

/// Where a ray ends whose surface at `distance` is met with the |cosine| `facing`, and is up to
/// `off` nearer along its normal. `facing` 0: there is none.
[[nodiscard]] inline double end_before(double distance, double off, double facing) {
    const double end = distance - off / facing, earliest = kBeforeEnd * distance;
    return end > earliest ? end : earliest;  // NaN for infinite distances
}

/// The ray of the same start that ends before `end`, outside of the error bound of a surface that
/// it meets with the |cosine| `facing`. It is empty if it would go backwards: the points are the
/// same within their errors.
[[nodiscard]] Ray ray_ending_at(const Ray& ray, const Vec3& end, double facing);

/// The ray from a lit point to a point of a light. `leaving`: the ray that leaves the lit point
/// along the unit direction to the light; `facing`: LightDraw::facing.
[[nodiscard]] inline Ray ray_to_light(const Illumination& lights, const Vec3& lit,
                                      const Ray& leaving, double distance,
                                      const PlaceInLight& place, double facing) {
    const double beside = most_apart(leaving.origin, lit) + lights.rounding();
    if (beside > kMostBeside * distance) {
        const Vec3 point = lit + distance * leaving.direction;
        return ray_ending_at(leaving, lights.before_surface(place, point, lit), facing);
    }
    double end = kBeforeEnd * distance;
    if (facing > 0.0) {
        const double off = beside + rounding_of_tests(leaving.origin, distance);
        end = end_before(distance, off, facing);
    }
    return {leaving.origin, leaving.direction, leaving.t_min, end};
}

/// The ray between two points of surfaces or volumes, which `leaving` and `back` leave towards each
/// other. `facing`: |cosine| at the surface of the second.
[[nodiscard]] inline Ray ray_between(const Vec3& from, const Ray& leaving, const Vec3& to,
                                     const Ray& back, double distance, double facing) {
    const double beside = most_apart(leaving.origin, from) + most_apart(back.origin, to);
    if (beside > kMostBeside * distance) return ray_ending_at(leaving, back.origin, facing);
    const double off = beside + rounding_of_tests(leaving.origin, distance);
    return {leaving.origin, leaving.direction, leaving.t_min, end_before(distance, off, facing)};
}

}  // namespace alhazen
