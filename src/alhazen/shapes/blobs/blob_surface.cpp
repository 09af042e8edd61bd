#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/shapes/blobs/blob.h"
#include "alhazen/shapes/core/plain_surface.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

namespace {

struct Density {
    double value = 0;
    Vec3 gradient{};
    double rounding = 0;
};

/// Density of the components in `near`, which are all that are active at p.
Density density_at(const Blob& blob, const std::vector<std::uint32_t>& near, const Vec3& p) {
    Density sum;
    for (const std::uint32_t i : near) {
        const BlobComponent& c = blob.components[i];
        Vec3 nearest = c.base;
        if (c.rod) {
            const Vec3 e = c.top - c.base;
            nearest += std::clamp(dot(p - c.base, e) / length_squared(e), 0.0, 1.0) * e;
        }
        const Vec3 r = p - nearest;
        const double q = 1.0 - length_squared(r) / (c.radius * c.radius);
        if (q <= 0.0) continue;
        sum.value += c.strength * q * q;
        sum.gradient -= (4.0 * c.strength * q / (c.radius * c.radius)) * r;
        sum.rounding += std::abs(c.strength) * (8.0 + 4.0 * max_component(abs(p)) / c.radius);
    }
    return sum;
}

}  // namespace

ShapeSurface plain_surface(const Blob& shape, const Ray& ray, const ShapeHit& hit) {
    // Kept between rays to avoid allocation.
    static thread_local std::vector<std::uint32_t> near;
    ShapeSurface surface;
    surface.point = ray.at(hit.t);
    near.clear();
    shape.tree->for_point(surface.point, [&](std::uint32_t i) { near.push_back(i); });
    Density there = density_at(shape, near, surface.point);
    double steepness = length(there.gradient);
    if (steepness > 0.0) {
        // One step to the surface, at most the rounding of the ray.
        const double off = (shape.threshold - there.value) / steepness;
        const double margin = 0x1p-48 * (max_component(abs(ray.origin)) + shape.reach);
        surface.point += (std::clamp(off, -margin, margin) / steepness) * there.gradient;
        // A component that becomes active within so short a step adds nothing yet.
        there = density_at(shape, near, surface.point);
        steepness = length(there.gradient);
    }
    surface.normal = unit_or(-there.gradient, -unit_or(ray.direction, {0, 0, 1}));
    // Only the full list of crossings tells whether the ray enters here (v = -1) or leaves.
    if (dot(surface.normal, ray.direction) * hit.v < 0.0) surface.normal = -surface.normal;
    surface.shading_normal = surface.normal;
    // The rounding of the density over its slope; where the slope is unreliable, the rounding of
    // all coordinates.
    const double most = gamma_bound(48) * shape.reach;
    const double off = 0x1p-53 * there.rounding / steepness + gamma_bound(4) * shape.reach;
    const double error = off < most ? off : most;
    surface.error = {error, error, error};
    return surface;
}

ShapeSurface Blob::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = plain_surface(*this, ray, hit);
    const Vec3 from_center = unit_or(surface.point - bounds.center(), {1, 0, 0});
    surface.uv = {turn_fraction(from_center.x, from_center.y),
                  0.5 + std::atan2(from_center.z, std::hypot(from_center.x, from_center.y)) / kPi};
    return surface;
}

}  // namespace alhazen
