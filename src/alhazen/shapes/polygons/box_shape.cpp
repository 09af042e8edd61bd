#include "alhazen/shapes/polygons/box_shape.h"

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void BoxShape::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (!(lo.x < hi.x && lo.y < hi.y && lo.z < hi.z)) {
        checks.fail("lo must be less than hi along every axis");
    }
}

Box3 BoxShape::box() const {
    return {lo, hi};
}

Interval BoxShape::extent(const Vec3& axis) const {
    const Interval range = alhazen::extent(Box3{lo, hi}, axis);
    const Vec3 reach{std::fmax(std::abs(lo.x), std::abs(hi.x)),
                     std::fmax(std::abs(lo.y), std::abs(hi.y)),
                     std::fmax(std::abs(lo.z), std::abs(hi.z))};
    const double pad = gamma_bound(8) * dot(abs(axis), reach);
    return {range.lo - pad, range.hi + pad};
}

int BoxShape::intersect(const Ray& ray, ShapeHit* hits) const {
    double entry = -kInfinity, exit = kInfinity;
    std::uint32_t entry_part = 0, exit_part = 0;
    for (int k = 0; k < 3; ++k) {
        const double o = ray.origin[k];
        const double d = ray.direction[k];
        if (d == 0.0) {
            // A ray in the plane of a face: `keeps_face`.
            if (!(lo[k] < o && o <= hi[k])) return 0;
            continue;
        }
        const std::uint32_t low_face = static_cast<std::uint32_t>(2 * k);
        const double t_near = ((d > 0.0 ? lo[k] : hi[k]) - o) / d;
        const double t_far = ((d > 0.0 ? hi[k] : lo[k]) - o) / d;
        if (t_near > entry) {
            entry = t_near;
            entry_part = d > 0.0 ? low_face : low_face + 1;
        }
        if (t_far < exit) {
            exit = t_far;
            exit_part = d > 0.0 ? low_face + 1 : low_face;
        }
    }
    return report_span(ray, entry, entry_part, exit, exit_part, hits);
}

ShapeSurface BoxShape::surface(const Ray& ray, const ShapeHit& hit) const {
    const int axis = static_cast<int>(hit.part / 2);
    const bool high = (hit.part & 1u) != 0;
    ShapeSurface surface;
    const Vec3 p = ray.at(hit.t);
    for (int k = 0; k < 3; ++k) surface.point[k] = std::fmin(hi[k], std::fmax(lo[k], p[k]));
    surface.point[axis] = high ? hi[axis] : lo[axis];
    surface.normal[axis] = high ? 1.0 : -1.0;
    surface.shading_normal = surface.normal;
    const int u = axis == 0 ? 1 : 0;
    const int v = axis == 2 ? 1 : 2;
    const double along = high ? surface.point[u] - lo[u] : hi[u] - surface.point[u];
    surface.uv = {along / (hi[u] - lo[u]), (surface.point[v] - lo[v]) / (hi[v] - lo[v])};
    surface.dpdu[u] = high ? hi[u] - lo[u] : lo[u] - hi[u];
    surface.dpdv[v] = hi[v] - lo[v];
    // The point is exactly on the face; the bound covers the last digits of the box, so that a step
    // by it leaves the face.
    surface.error = gamma_bound(2) * Vec3{std::fmax(std::abs(lo.x), std::abs(hi.x)),
                                          std::fmax(std::abs(lo.y), std::abs(hi.y)),
                                          std::fmax(std::abs(lo.z), std::abs(hi.z))};
    return surface;
}

}  // namespace alhazen
