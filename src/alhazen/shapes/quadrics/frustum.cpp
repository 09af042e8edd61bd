#include "alhazen/shapes/quadrics/frustum.h"

#include <algorithm>

#include "alhazen/base/instruction_sets.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

namespace {

/// A line in the frame of a frustum (z along the axis, 0 at the centre), with its quadratic.
struct FrustumLine {
    double shift;  ///< t of the local origin
    double ox, oy, oz, dx, dy, dz;
    double radius, growth;  ///< radius at the local origin's height; its derivative along the line
    // a t^2 + 2 b t + c <= 0 inside the infinite quadric (both nappes).
    double a, b, c, discriminant;
};

FrustumLine localise(const Frustum& f, const Ray& ray) {
    FrustumLine l;
    l.shift = 0.0;
    const Vec3& d = ray.direction;
    Vec3 origin = ray.origin - f.center;
    // For a near origin the shift would only lose digits of a small t.
    if (length_squared(origin) > 16.0 * f.bounding_radius_squared) {
        l.shift = -dot(origin, d) / length_squared(d);
        origin += l.shift * d;
    }
    l.ox = dot(f.x_axis, origin);
    l.oy = dot(f.y_axis, origin);
    l.oz = dot(f.axis, origin);
    l.dx = dot(f.x_axis, d);
    l.dy = dot(f.y_axis, d);
    l.dz = dot(f.axis, d);
    l.radius = f.middle_radius + f.slope * l.oz;
    l.growth = f.slope * l.dz;
    l.a = l.dx * l.dx + l.dy * l.dy - l.growth * l.growth;
    l.b = l.ox * l.dx + l.oy * l.dy - l.radius * l.growth;
    // b^2 - a c = |radius d - growth o|^2 - |o x d|^2, in the plane across the axis.
    const double wx = difference_of_products(l.radius, l.dx, l.growth, l.ox);
    const double wy = difference_of_products(l.radius, l.dy, l.growth, l.oy);
    const double w = std::sqrt(wx * wx + wy * wy);
    const double moment = std::abs(difference_of_products(l.ox, l.dy, l.oy, l.dx));
    l.discriminant = (w - moment) * (w + moment);
    // The line misses the side: c is not needed.
    l.c = 0.0;
    if (l.a > 0.0 && !(l.discriminant >= 0.0)) return l;
    const double across = std::sqrt(l.ox * l.ox + l.oy * l.oy);
    l.c = (across - l.radius) * (across + l.radius);
    return l;
}

/// Both roots for a != 0 in ascending order. Precondition: discriminant >= 0.
Interval roots(const FrustumLine& l) {
    const double s = std::sqrt(l.discriminant);
    double t0, t1;
    if (4.0 * std::abs(l.b) < s || s == 0.0) {
        // No cancellation, and no division of c, which may be pure rounding, by a small number.
        t0 = (-l.b - s) / l.a;
        t1 = (-l.b + s) / l.a;
    } else {
        const double q = -(l.b + std::copysign(s, l.b));
        t0 = q / l.a;
        t1 = l.c / q;
    }
    return {std::min(t0, t1), std::max(t0, t1)};
}

constexpr Interval kWholeLine{-kInfinity, kInfinity};

/// The part of the line inside the nappe of positive radius.
Interval inside_side(const FrustumLine& l) {
    if (l.a > 0.0) {
        if (!(l.discriminant >= 0.0)) return {};
        // The line is flatter than the cone: it stays in the nappe that contains the middle of the
        // roots.
        if (l.radius + (-l.b / l.a) * l.growth < 0.0) return {};
        return roots(l);
    }
    if (l.a < 0.0) {
        // Steeper: it enters or leaves the positive nappe once. The true discriminant is never
        // negative.
        FrustumLine steep = l;
        steep.discriminant = std::max(0.0, l.discriminant);
        const Interval both = roots(steep);
        return l.growth > 0.0 ? Interval{both.hi, kInfinity} : Interval{-kInfinity, both.lo};
    }
    if (l.growth == 0.0) return l.c < 0.0 ? kWholeLine : Interval{};
    // Parallel to a generator: one crossing; inside towards growing radius, or never inside this
    // nappe.
    if (l.b < 0.0 && l.growth > 0.0) return {-0.5 * l.c / l.b, kInfinity};
    if (l.b > 0.0 && l.growth < 0.0) return {-kInfinity, -0.5 * l.c / l.b};
    return {};
}

/// The part of the line inside the cylinder around the frustum.
Interval inside_cylinder(const Frustum& f, const FrustumLine& l) {
    const double radius = std::max(f.base_radius, f.top_radius);
    const double a = l.dx * l.dx + l.dy * l.dy, b = l.ox * l.dx + l.oy * l.dy;
    if (a == 0.0) return std::hypot(l.ox, l.oy) <= radius ? kWholeLine : Interval{};
    const double reach = radius * std::sqrt(a);
    const double moment = std::abs(difference_of_products(l.ox, l.dy, l.oy, l.dx));
    const double discriminant = (reach - moment) * (reach + moment);
    if (!(discriminant >= 0.0)) return {};
    const double s = std::sqrt(discriminant);
    return {(-b - s) / a, (-b + s) / a};
}

/// True if a line parallel to the ends runs between them; in an end: `keeps_face`.
bool between_ends(const Frustum& f, const FrustumLine& l, const Ray& ray) {
    for (int k = 0; k < 3; ++k) {
        // The height along an axis of coordinates is compared without rounding.
        if (f.axis[(k + 1) % 3] != 0.0 || f.axis[(k + 2) % 3] != 0.0) continue;
        const double o = ray.origin[k];
        return std::min(f.base[k], f.top[k]) < o && o <= std::max(f.base[k], f.top[k]);
    }
    if (std::abs(l.oz) != f.half_height) return std::abs(l.oz) < f.half_height;
    return keeps_face(l.oz > 0.0 ? f.axis : -f.axis);
}

int intersect_solid(const Frustum& f, const FrustumLine& l, const Ray& ray, ShapeHit* hits) {
    const double half_height = f.half_height;
    Interval side = inside_side(l);
    if (f.is_flat()) side = intersection(side, inside_cylinder(f, l));
    if (side.empty()) return 0;
    double entry = side.lo, exit = side.hi;
    std::uint32_t entry_part = 0, exit_part = 0;
    if (l.dz == 0.0) {
        if (!between_ends(f, l, ray)) return 0;
    } else {
        // The sign of the direction selects the entry cap; the order then survives rounding.
        const double slab_entry = (std::copysign(half_height, -l.dz) - l.oz) / l.dz;
        const double slab_exit = (std::copysign(half_height, l.dz) - l.oz) / l.dz;
        if (slab_entry > entry) {
            entry = slab_entry;
            entry_part = l.dz > 0.0 ? 1 : 2;
        }
        if (slab_exit < exit) {
            exit = slab_exit;
            exit_part = l.dz > 0.0 ? 2 : 1;
        }
    }
    if (!(entry <= exit)) return 0;
    return report_span(ray, l.shift + entry, entry_part, l.shift + exit, exit_part, hits);
}

int intersect_side(const Frustum& f, const FrustumLine& l, const Ray& ray, ShapeHit* hits) {
    const double half_height = f.half_height;
    Interval t;
    if (l.a == 0.0) {
        if (l.b == 0.0) return 0;
        t.lo = t.hi = -0.5 * l.c / l.b;
    } else {
        if (!(l.discriminant >= 0.0)) return 0;
        t = roots(l);
    }
    const Interval around = f.is_flat() ? inside_cylinder(f, l) : kWholeLine;
    if (around.empty()) return 0;
    const auto between_the_ends = [&](double root) {
        const double z = l.oz + root * l.dz;
        return -half_height <= z && z < half_height;
    };
    int count = 0;
    const auto report = [&](double root) {
        // A crossing of the other nappe is not between the ends, wherever it is kept.
        const double inside = std::clamp(root, around.lo, around.hi);
        if (!between_the_ends(root) || !between_the_ends(inside)) return;
        count += report_crossing(ray, {l.shift + inside, 0, 0, 0}, hits + count);
    };
    report(t.lo);
    if (l.a != 0.0) report(t.hi);
    return count;
}

int all_hits_body(const Frustum& f, const Ray& ray, bool capped, ShapeHit* hits) {
    const FrustumLine l = localise(f, ray);
    return capped ? intersect_solid(f, l, ray, hits) : intersect_side(f, l, ray, hits);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET(int all_hits(const Frustum& f, const Ray& ray, bool capped,
                                              ShapeHit* hits),
                                 all_hits_body(f, ray, capped, hits))

}  // namespace

Frustum::Frustum(const Vec3& base_point, const Vec3& top_point, double radius_at_base,
                 double radius_at_top)
    : base(base_point),
      top(top_point),
      base_radius(radius_at_base),
      top_radius(radius_at_top),
      center(0.5 * base_point + 0.5 * top_point),
      axis(unit_or(top_point - base_point, {0, 0, 1})),
      x_axis(perpendicular(axis)),
      y_axis(cross(axis, x_axis)),
      half_height(0.5 * length(top_point - base_point)),
      middle_radius(0.5 * (radius_at_base + radius_at_top)),
      slope((radius_at_top - radius_at_base) / (2.0 * half_height)) {
    const double wider = std::max(base_radius, top_radius);
    bounding_radius_squared = half_height * half_height + wider * wider;
}

Box3 Frustum::box() const {
    Box3 box = outward_box(base, circle_half_box(axis, base_radius));
    box.include(outward_box(top, circle_half_box(axis, top_radius)));
    return box;
}

Interval Frustum::extent(const Vec3& direction) const {
    const double across = length(accurate_cross(direction, axis));
    return hull(outward_extent(direction, base, base_radius * across),
                outward_extent(direction, top, top_radius * across));
}

int Frustum::intersect(const Ray& ray, bool capped, ShapeHit* hits) const {
    return all_hits(*this, ray, capped, hits);
}

double Frustum::turn(const Vec3& across) const {
    return turn_fraction(dot(x_axis, across), dot(y_axis, across));
}

ShapeSurface Frustum::side_surface(const Vec3& from_center) const {
    const double along = dot(axis, from_center);
    const Vec3 across = from_center - along * axis;
    // On the axis (an apex) any perpendicular direction is valid.
    const Vec3 outward = unit_or(across, x_axis);
    // The nearest point of the generator; the one of equal height would magnify the error of a flat
    // cone.
    const double distance = length(across) - (middle_radius + slope * along);
    const double foot = along + slope * distance / (1.0 + slope * slope);
    const double height = std::clamp(foot, -half_height, half_height);
    const double radius = middle_radius + slope * height;

    ShapeSurface surface;
    surface.point = center + height * axis + radius * outward;
    surface.normal = unit_or(outward - slope * axis, outward);
    surface.shading_normal = surface.normal;
    surface.uv = {turn(outward), (height + half_height) / (2.0 * half_height)};
    surface.dpdu = (2.0 * kPi * radius) * cross(axis, outward);
    surface.dpdv = (2.0 * half_height) * (axis + slope * outward);
    const double wider = std::max(base_radius, top_radius);
    surface.error = gamma_bound(4) * abs(center) +
                    gamma_bound(16) * ((half_height + wider) * abs(axis) + wider * abs(outward));
    return surface;
}

ShapeSurface Frustum::cap_surface(const Vec3& p, bool at_top) const {
    const Vec3& middle = at_top ? top : base;
    const double radius = at_top ? top_radius : base_radius;
    Vec3 offset = p - middle;
    offset -= dot(axis, offset) * axis;
    const double distance = length(offset);
    if (distance > radius) offset = (radius / distance) * offset;

    ShapeSurface surface;
    surface.point = middle + offset;
    surface.normal = surface.shading_normal = at_top ? axis : -axis;
    surface.uv = {turn(offset), std::min(1.0, distance / radius)};
    surface.dpdu = (2.0 * kPi) * cross(axis, offset);
    surface.dpdv = radius * unit_or(offset, x_axis);
    const double off_plane = gamma_bound(12) * dot(abs(axis), abs(p - middle) + abs(offset));
    surface.error = gamma_bound(4) * (abs(middle) + abs(offset)) + off_plane * abs(axis);
    return surface;
}

ShapeSurface Frustum::surface(const Ray& ray, const ShapeHit& hit) const {
    const Vec3 p = ray.at(hit.t);
    // A cap of zero area is the apex, part of the side.
    if (hit.part == 1 && base_radius > 0.0) return cap_surface(p, false);
    if (hit.part == 2 && top_radius > 0.0) return cap_surface(p, true);
    return side_surface(p - center);
}

}  // namespace alhazen
