#include "alhazen/shapes/quadrics/sphere.h"

#include "alhazen/geometry/sphere_roots.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/core/first_hits.h"
#include "alhazen/shapes/core/plain_surface.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/quadrics/sphere_lanes.h"

namespace alhazen {

void Sphere::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
}

Box3 Sphere::box() const {
    return outward_box(center, {radius, radius, radius});
}

Interval Sphere::extent(const Vec3& axis) const {
    return outward_extent(axis, center, radius * length(axis));
}

namespace {

/// Uses the library's fmin and fmax, for values that fast min/max does not cover.
int intersect_with_care(const Sphere& sphere, const Ray& ray, ShapeHit* hits) {
    const Vec3& d = ray.direction;
    const Vec3 f = ray.origin - sphere.center;
    const auto roots =
        sphere_roots<double>(d.x, d.y, d.z, length_squared(d), f.x, f.y, f.z, sphere.radius);
    if (!(roots.discriminant >= 0.0)) return 0;
    return report_span(ray, roots.t_near, 0, roots.t_far, 0, hits);
}

}  // namespace

int Sphere::intersect(const Ray& ray, ShapeHit* hits) const {
    const Vec3& d = ray.direction;
    const Vec3 f = ray.origin - center;
    const FastMinMaxDouble dx{d.x}, dy{d.y}, dz{d.z}, fx{f.x}, fy{f.y}, fz{f.z};
    const FastMinMaxDouble a{length_squared(d)}, r{radius};
    const auto line = sphere_line(dx, dy, dz, a, fx, fy, fz, r);
    if (!(line.discriminant.x >= 0.0)) return 0;
    const auto roots = sphere_roots(line, a, fx, fy, fz, r);
    const double entry = roots.t_near.x, exit = roots.t_far.x;
    if (!are_plain_roots(entry, exit)) return intersect_with_care(*this, ray, hits);
    int count = 0;
    if (ray.covers(entry)) hits[count++] = {entry, 0, 0, 0};
    if (ray.covers(exit)) hits[count++] = {exit, 0, 0, 0};
    return count;
}

std::uint32_t first_hits(const Sphere& shape, std::span<const Ray* const> rays, ShapeHit* hits) {
    RayLanes in;
    for (std::size_t i = 0; i < kRayLanes; ++i) in.set(i, *rays[i < rays.size() ? i : 0]);
    return first_hits(shape, in, kAllRayLanes >> (kRayLanes - rays.size()), hits);
}

std::uint32_t first_hits(const Sphere& shape, const RayLanes& rays, std::uint32_t wanted,
                         ShapeHit* hits) {
    SphereHitLanes lanes;
    sphere_hits_kernel()(rays, shape, lanes);
    std::uint32_t hit = wanted & lanes.hit;
    for_each_lane(hit, [&](std::size_t i) { hits[i] = {lanes.t[i], 0, 0, 0}; });
    for_each_lane(wanted & lanes.unsure, [&](std::size_t i) {
        if (find_first_hit(shape, rays.ray(i), hits[i])) hit |= 1u << i;
    });
    return hit;
}

ShapeSurface plain_surface(const Sphere& shape, const Ray& ray, const ShapeHit& hit) {
    const Vec3 n = unit_or(ray.at(hit.t) - shape.center, {0, 0, 1});
    const Vec3 from_center = shape.radius * n;
    ShapeSurface surface;
    surface.point = shape.center + from_center;
    surface.normal = surface.shading_normal = n;
    // n| is 1 within four roundings, its product with the radius adds one, the sum one.
    surface.error = gamma_bound(6) * abs(from_center) + gamma_bound(2) * abs(surface.point);
    return surface;
}

ShapeSurface Sphere::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = plain_surface(*this, ray, hit);
    const Vec3& n = surface.normal;
    const double across = std::hypot(n.x, n.y);
    surface.uv = {turn_fraction(n.x, n.y), 0.5 + std::atan2(n.z, across) / kPi};
    surface.dpdu = (2.0 * kPi * radius) * Vec3{-n.y, n.x, 0.0};
    // At a pole every u is the same point: uses the direction of u = 0.
    const Vec3 outward = across > 0.0 ? Vec3{n.x / across, n.y / across, 0.0} : Vec3{1, 0, 0};
    surface.dpdv = (kPi * radius) * Vec3{-n.z * outward.x, -n.z * outward.y, across};
    return surface;
}

}  // namespace alhazen
