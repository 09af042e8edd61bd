#pragma once
/// Rays between two points, which end before the surface at the second one.
///
/// Conventions: a ray leaves its surface beside the point (LeavingRays), so it passes beside the
/// second point, too, and may meet the surface there earlier by as much over the cosine. Where that
/// and the rounding of the second surface are far less than what kBeforeEnd leaves, the ray keeps
/// the direction between the points. Otherwise, far from the origin or over short distances, it
/// goes from its start to a point outside of the error bound of the second surface.

#include <cmath>

#include "alhazen/geometry/ray.h"
#include "alhazen/illumination/illumination.h"

namespace alhazen {

/// The end of a ray between two points, as a part of their distance, so that the surface of the
/// other point does not block it.
inline constexpr double kBeforeEnd = 1.0 - 1e-7;
/// Largest distance of a ray from its points, relative to its length, at which it keeps its
/// direction.
inline constexpr double kMostBeside = 0x1p-32;

/// The ray of the same start that ends just before `end`. It is empty if it would go backwards: the
/// points are the same within their errors.
[[nodiscard]] Ray ray_ending_at(const Ray& ray, const Vec3& end);

/// A bound of the distance between two points, without the calls that a root or fmax would be.
[[nodiscard]] inline double most_apart(const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
}

/// True if a ray from `origin` to a light, beside the line from the lit point, may meet the light's
/// surface before kBeforeEnd of the distance.
[[nodiscard]] inline bool passes_beside(const Illumination& lights, const Vec3& lit,
                                        const Vec3& origin, double distance) {
    return most_apart(origin, lit) + lights.rounding() > kMostBeside * distance;
}

/// The ray from a lit point to a point of a light. `leaving`: the ray that leaves the lit point
/// along the unit direction to the light.
[[nodiscard]] inline Ray ray_to_light(const Illumination& lights, const Vec3& lit,
                                      const Ray& leaving, double distance,
                                      const PlaceInLight& place) {
    if (passes_beside(lights, lit, leaving.origin, distance)) {
        const Vec3 point = lit + distance * leaving.direction;
        return ray_ending_at(leaving, lights.before_surface(place, point, lit));
    }
    return {leaving.origin, leaving.direction, leaving.t_min, kBeforeEnd * distance};
}

/// The ray between two points of surfaces or volumes, which `leaving` and `back` leave towards each
/// other.
[[nodiscard]] inline Ray ray_between(const Vec3& from, const Ray& leaving, const Vec3& to,
                                     const Ray& back, double distance) {
    const double beside = most_apart(leaving.origin, from) + most_apart(back.origin, to);
    if (beside > kMostBeside * distance) return ray_ending_at(leaving, back.origin);
    return {leaving.origin, leaving.direction, leaving.t_min, kBeforeEnd * distance};
}

}  // namespace alhazen
