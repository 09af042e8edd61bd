#include "alhazen/illumination/emitter.h"

#include <algorithm>
#include <cmath>

#include "alhazen/illumination/spherical_polygons.h"
#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/light_extent.h"
#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {

namespace {

/// Points whose squared distance from the centre of a unit sphere is at most 1 + kOnSphere count as
/// inside: the cone of a nearer point would contain the point itself.
constexpr double kOnSphere = 1e-9;
/// From inside a unit sphere, smallest distance of a sampled point.
double near_on_sphere(const Emitter& e) {
    return std::max(1e-7, e.in_plane);
}

Vec3 corner_of(const Emitter& e) {
    return e.world_from_own.translation;
}
const Vec3& axis_x(const Emitter& e) {
    return e.world_from_own.linear.x_axis;
}
const Vec3& axis_y(const Emitter& e) {
    return e.world_from_own.linear.y_axis;
}
const Vec3& axis_z(const Emitter& e) {
    return e.world_from_own.linear.z_axis;
}

/// Transforms an area with normal `n`: the direction of the result is the normal, its length the
/// change of area.
Vec3 transformed_area(const Mat3& m, const Vec3& n) {
    return n.x * cross(m.y_axis, m.z_axis) + n.y * cross(m.z_axis, m.x_axis) +
           n.z * cross(m.x_axis, m.y_axis);
}

/// The outer normal, in world space, at a point of the sphere or the tube with own normal `n`.
Vec3 outer_normal(const Emitter& e, const Vec3& n) {
    const Mat3& m = e.world_from_own.linear;
    return normalize(std::copysign(1.0, determinant(m)) * transformed_area(m, n));
}

// ---- flat forms

EmitterSample seen_by_area(bool two_sided, const Vec3& from, const EmitterPoint& p) {
    const Vec3 offset = p.point - from;
    const double squared = length_squared(offset), distance = std::sqrt(squared);
    if (!(distance > 0.0)) return {};
    const Vec3 to_light = offset / distance;
    double cosine = -dot(to_light, p.normal);
    if (two_sided) cosine = std::abs(cosine);
    if (!(cosine > 0.0)) return {};
    return {to_light, distance, p.density * squared / cosine, p.parameters, cosine};
}
EmitterSample seen_by_area(const Emitter& e, const Vec3& from, const EmitterPoint& p) {
    return seen_by_area(e.two_sided, from, p);
}

double by_solid_angle(double area_density, const EmitterHit& hit) {
    const double cosine = std::abs(dot(hit.direction, hit.normal));
    return cosine > 0.0 ? area_density * hit.distance * hit.distance / cosine : 0.0;
}

SphericalTriangle triangle_from(const Emitter& e, const Vec3& from) {
    const Vec3 a = corner_of(e) - from;
    return {a, a + axis_x(e), a + axis_y(e)};
}

/// The weights of the second and third corner of the triangle with edges `x` and `y` at a point of
/// its plane.
Vec2 weights_at(const Vec3& x, const Vec3& y, const Vec3& p) {
    const double xx = dot(x, x), xy = dot(x, y), yy = dot(y, y);
    const double px = dot(p, x), py = dot(p, y), below = xx * yy - xy * xy;
    const double u = std::clamp((yy * px - xy * py) / below, 0.0, 1.0);
    return {u, std::clamp((xx * py - xy * px) / below, 0.0, 1.0 - u)};
}

/// The weights of the second and third corner of a triangle at the sample by area.
Vec2 weights_by_area(const Vec2& u) {
    const double root = std::sqrt(u.x);
    return {root * (1.0 - u.y), root * u.y};
}

EmitterSample sample_triangle(const Emitter& e, const Vec3& from, const Vec2& u) {
    if (is_sampled_by_area(e, from)) return seen_by_area(e, from, point_of(e, u));
    const EmittingTriangle triangle{corner_of(e), axis_x(e),    axis_y(e),
                                    axis_z(e),    1.0 / e.area, e.two_sided};
    return sample_near(triangle, from, u);
}

EmitterSample sample_rectangle(const Emitter& e, const Vec3& from, const Vec2& u) {
    if (e.right_angled && !is_sampled_by_area(e, from)) {
        const SphericalRectangle seen(corner_of(e) - from, e.sides);
        if (seen.solid_angle() > kLeastSolidAngle) {
            if (!e.two_sided && !(dot(corner_of(e) - from, axis_z(e)) < 0.0)) return {};
            const Vec3 offset = seen.point(u);
            const double distance = length(offset);
            const Vec3 to_light = offset / distance;
            return {to_light,
                    distance,
                    1.0 / seen.solid_angle(),
                    {},
                    std::abs(dot(to_light, axis_z(e)))};
        }
    }
    return seen_by_area(e, from, point_of(e, u));
}

Vec2 on_own_disc(const Emitter& e, const Vec2& u) {
    if (!(e.inner > 0.0)) return on_unit_disc(u);
    const double r = std::sqrt(e.inner * e.inner + u.x * (1.0 - e.inner * e.inner));
    return {r * std::cos(2.0 * kPi * u.y), r * std::sin(2.0 * kPi * u.y)};
}

EmitterPoint point_of_parts(const Emitter& e, const Vec2& u) {
    const EmitterParts& parts = *e.parts;
    const double wanted = u.x * parts.areas.back();
    const auto found = std::upper_bound(parts.areas.begin(), parts.areas.end(), wanted);
    const std::size_t i =
        std::min<std::size_t>(std::size_t(found - parts.areas.begin()), parts.areas.size() - 1);
    const double before = i == 0 ? 0.0 : parts.areas[i - 1];
    const double x = std::clamp((wanted - before) / (parts.areas[i] - before), 0.0, 1.0);
    const double root = std::sqrt(x);
    const Vec3* c = parts.corners.data() + 3 * i;
    return {(1.0 - root) * c[0] + (root * (1.0 - u.y)) * c[1] + (root * u.y) * c[2],
            axis_z(e),
            1.0 / e.area,
            {}};
}

// ---- the sphere

Vec3 on_own_sphere(const Vec2& u) {
    const Vec2 p = on_unit_disc(u);
    const double share = p.x * p.x + p.y * p.y;
    const double scale = 2.0 * std::sqrt(std::max(0.0, 1.0 - share));
    return {scale * p.x, scale * p.y, 1.0 - 2.0 * share};
}

/// The sphere as seen from a point, in its own frame.
struct SeenSphere {
    Vec3 from;       ///< the point, in the own frame
    double squared;  ///< distance to the centre
    double cap = 0;  ///< from outside: 1 - cosine of the half angle of the cone
    bool inside;
    bool through;  ///< from outside: its inner side is seen too

    SeenSphere(const Emitter& e, const Vec3& world_from)
        : from(inverse(e.world_from_own.linear) * (world_from - e.world_from_own.translation)),
          squared(length_squared(from)),
          inside(!(squared > 1.0 + kOnSphere)),
          through(!inside && e.two_sided && e.unseen) {
        const double sine2 = 1.0 / squared;
        if (!inside) cap = sine2 / (1.0 + std::sqrt(1.0 - sine2));
    }
    /// Density by solid angle in the own frame, of each side that is seen.
    [[nodiscard]] double density() const {
        return inside ? 1.0 / (4.0 * kPi) : (through ? 0.5 : 1.0) / (2.0 * kPi * cap);
    }
};

/// Density by solid angle in world space over that in the own frame, for an own unit direction
/// whose image has length `length`.
double change_of_angle(const Emitter& e, double length) {
    return length * length * length / std::abs(determinant(e.world_from_own.linear));
}

EmitterSample sample_sphere(const Emitter& e, const Vec3& world_from, Vec2 u) {
    const SeenSphere seen(e, world_from);
    const bool far_side = seen.through && u.x < 0.5;
    if (seen.through) u.x = far_side ? 2.0 * u.x : 2.0 * u.x - 1.0;
    Vec3 own;
    double t = 0.0;
    if (seen.inside) {
        if (!e.two_sided) return {};
        own = on_own_sphere(u);
        const double b = dot(seen.from, own);
        t = -b + std::sqrt(std::max(0.0, b * b + 1.0 - seen.squared));
        if (!(t > near_on_sphere(e))) return {};
    } else {
        const double d = std::sqrt(seen.squared);
        const Vec2 p = on_unit_disc(u);
        const double height = (p.x * p.x + p.y * p.y) * seen.cap, cosine = 1.0 - height;
        const double across = std::sqrt(seen.cap * (2.0 - height));
        const Vec3 axis = (-1.0 / d) * seen.from, x = perpendicular(axis), y = cross(axis, x);
        own = normalize(cosine * axis + (across * p.x) * x + (across * p.y) * y);
        const double sine2 = height * (2.0 - height);
        const double half_chord = std::sqrt(std::max(0.0, 1.0 - seen.squared * sine2));
        t = d * cosine + (far_side ? half_chord : -half_chord);
    }
    const Vec3 direction = e.world_from_own.linear * own;
    const double scale = length(direction);
    const Vec3 to_light = direction / scale;
    return {to_light,
            t * scale,
            seen.density() * change_of_angle(e, scale),
            {},
            std::abs(dot(to_light, outer_normal(e, seen.from + t * own)))};
}

double density_of_sphere(const Emitter& e, const Vec3& world_from, const EmitterHit& hit) {
    const SeenSphere seen(e, world_from);
    const bool from_behind = dot(hit.direction, hit.normal) > 0.0;
    if (from_behind != seen.inside && !seen.through) return 0.0;
    const Vec3 own = inverse(e.world_from_own.linear) * hit.direction;
    const double scale = 1.0 / length(own);
    if (seen.inside && !(hit.distance > near_on_sphere(e) * scale)) return 0.0;
    return seen.density() * change_of_angle(e, scale);
}

// ---- the tube

/// The angles around a tube that are sampled from a point: up to `half` to both sides of `x`.
struct SeenTube {
    Vec3 x{1, 0, 0}, y{0, 1, 0};
    double half = kPi;

    SeenTube(const Emitter& e, const Vec3& world_from) {
        const Vec3 from =
            inverse(e.world_from_own.linear) * (world_from - e.world_from_own.translation);
        const double away = std::hypot(from.x, from.y);
        if (!(away > 0.0)) return;
        if (!e.two_sided && away > 1.0) half = std::acos(1.0 / away);
        x = {from.x / away, from.y / away, 0};
        y = {-x.y, x.x, 0};
    }
};

/// Area per angle (radians) and per fraction of the length, at the own normal `n`.
double stretch_of_tube(const Emitter& e, const Vec3& n) {
    return length(cross(e.world_from_own.linear * Vec3{-n.y, n.x, 0}, axis_z(e)));
}

EmitterPoint point_of_tube(const Emitter& e, const SeenTube& seen, const Vec2& u) {
    const double angle = seen.half * (2.0 * u.x - 1.0);
    const Vec3 n = std::cos(angle) * seen.x + std::sin(angle) * seen.y;
    return {e.world_from_own.point(n + Vec3{0, 0, u.y}),
            outer_normal(e, n),
            1.0 / (2.0 * seen.half * stretch_of_tube(e, n)),
            {}};
}

/// The own normal of the tube for a normal in world space.
Vec3 own_normal_of_tube(const Emitter& e, const Vec3& normal) {
    Vec3 n = transpose_times(e.world_from_own.linear, normal);
    n.z = 0.0;
    return normalize(n);
}

// ---- the patch

EmitterPoint point_of_patch(const Emitter& e, const Vec2& parameters) {
    const PatchValue value = patch_value(e.patch->net, parameters.x, parameters.y);
    const Mat3& m = e.world_from_own.linear;
    const Vec3 across = cross(m * value.du, m * value.dv);
    const double stretch = length(across);
    if (!(stretch > 0.0)) return {};
    // A mirroring transform reverses du x dv, but not the outer side.
    const bool turned = e.patch->turned != (determinant(m) < 0.0);
    return {e.world_from_own.point(value.point), (turned ? -1.0 : 1.0) / stretch * across,
            1.0 / stretch, parameters};
}

/// The area of a curved form, by a mean over a grid of its parameters.
double integrated_area(const Emitter& e) {
    constexpr int kGrid = 32;
    double sum = 0.0;
    for (int i = 0; i < kGrid; ++i) {
        for (int j = 0; j < kGrid; ++j) {
            const EmitterPoint p = point_of(e, {(i + 0.5) / kGrid, (j + 0.5) / kGrid});
            if (p.density > 0.0) sum += 1.0 / p.density;
        }
    }
    return sum / (kGrid * kGrid);
}

}  // namespace

bool make_ready(Emitter& e) {
    const Vec3 &x = axis_x(e), &y = axis_y(e);
    const double span = length(cross(x, y));
    switch (e.form) {
        case EmitterForm::Triangle:
            e.area = 0.5 * span;
            break;
        case EmitterForm::Rectangle:
            e.area = span;
            e.right_angled = std::abs(dot(x, y)) <= 1e-12 * length(x) * length(y);
            if (e.right_angled) e.sides = RectangleSides::of(x, y);
            break;
        case EmitterForm::Disc:
            e.area = kPi * (1.0 - e.inner * e.inner) * span;
            break;
        case EmitterForm::Polygon:
            e.area = e.parts->areas.empty() ? 0.0 : e.parts->areas.back();
            break;
        case EmitterForm::Sphere:
        case EmitterForm::Tube:
        case EmitterForm::Patch:
            e.area = integrated_area(e);
            break;
    }
    if (e.form == EmitterForm::Triangle || e.form == EmitterForm::Rectangle) {
        // No point is farther from the corner than the sum of the edges is long; from a distance d
        // of all of them the solid angle is at most area / d^2. The margin covers its rounding.
        constexpr double kMargin = 1.02;
        const double near = length(x) + length(y);
        const double far = near + std::sqrt(kMargin / kLeastSolidAngle * e.area);
        e.far_squared = far * far;
        constexpr double kRounding = 1e-12;
        e.in_plane = kRounding * (max_component(abs(corner_of(e))) + near);
    }
    return e.area > 0.0 && std::isfinite(e.area) && is_finite(corner_of(e)) &&
           is_finite(axis_z(e)) && e.radiance.is_finite();
}

void prefer_area(Emitter& e) {
    if (e.form != EmitterForm::Triangle && e.form != EmitterForm::Rectangle) return;
    // The density by solid angle of samples by area is as the cube of the distance.
    constexpr double kFarInEdges = 8.0;
    const double far = kFarInEdges * (length(axis_x(e)) + length(axis_y(e)));
    e.far_squared = std::min(e.far_squared, far * far);
}

EmitterSample sample_near(const EmittingTriangle& e, const Vec3& from, const Vec2& u) {
    const Vec3 corner = e.corner - from;
    const SphericalTriangle seen(corner, corner + e.x, corner + e.y);
    if (!(seen.solid_angle() > kLeastSolidAngle)) {
        const Vec2 w = weights_by_area(u);
        const Vec3 point = Affine{{e.x, e.y, e.normal}, e.corner}.point({w.x, w.y, 0});
        return seen_by_area(e.two_sided, from, {point, e.normal, e.density, w});
    }
    const Vec3 direction = seen.direction(u);
    const double height = dot(corner, e.normal), slope = dot(direction, e.normal);
    if (!e.two_sided && !(height < 0.0)) return {};
    const double distance = height / slope;
    if (!(distance > 0.0) || !std::isfinite(distance)) return {};
    return {direction, distance, 1.0 / seen.solid_angle(),
            weights_at(e.x, e.y, distance * direction - corner), std::abs(slope)};
}

EmitterSample sample(const Emitter& e, const Vec3& from, const Vec2& u) {
    switch (e.form) {
        case EmitterForm::Triangle:
            return sample_triangle(e, from, u);
        case EmitterForm::Rectangle:
            return sample_rectangle(e, from, u);
        case EmitterForm::Sphere:
            return sample_sphere(e, from, u);
        case EmitterForm::Tube:
            return seen_by_area(e, from, point_of_tube(e, SeenTube(e, from), u));
        case EmitterForm::Disc:
        case EmitterForm::Polygon:
        case EmitterForm::Patch:
            break;
    }
    return seen_by_area(e, from, point_of(e, u));
}

double density(const Emitter& e, const Vec3& from, const EmitterHit& hit) {
    if (!e.two_sided && !(dot(hit.direction, hit.normal) < 0.0)) return 0.0;
    switch (e.form) {
        case EmitterForm::Triangle: {
            if (is_sampled_by_area(e, from)) break;
            const double solid = triangle_from(e, from).solid_angle();
            if (solid > kLeastSolidAngle) return 1.0 / solid;
            break;
        }
        case EmitterForm::Rectangle:
            if (e.right_angled && !is_sampled_by_area(e, from)) {
                const SphericalRectangle seen(corner_of(e) - from, e.sides);
                if (seen.solid_angle() > kLeastSolidAngle) return 1.0 / seen.solid_angle();
            }
            break;
        case EmitterForm::Sphere:
            return density_of_sphere(e, from, hit);
        case EmitterForm::Tube: {
            const Vec3 n = own_normal_of_tube(e, hit.normal);
            const double half = SeenTube(e, from).half;
            return by_solid_angle(1.0 / (2.0 * half * stretch_of_tube(e, n)), hit);
        }
        case EmitterForm::Disc:
        case EmitterForm::Polygon:
        case EmitterForm::Patch:
            break;
    }
    return by_solid_angle(area_density(e, hit.normal, hit.parameters), hit);
}

EmitterPoint point_of(const Emitter& e, const Vec2& u) {
    const Affine& world = e.world_from_own;
    switch (e.form) {
        case EmitterForm::Triangle: {
            const Vec2 w = weights_by_area(u);
            return {world.point({w.x, w.y, 0}), axis_z(e), 1.0 / e.area, w};
        }
        case EmitterForm::Rectangle:
            return {world.point({u.x, u.y, 0}), axis_z(e), 1.0 / e.area, {}};
        case EmitterForm::Disc: {
            const Vec2 p = on_own_disc(e, u);
            return {world.point({p.x, p.y, 0}), axis_z(e), 1.0 / e.area, {}};
        }
        case EmitterForm::Polygon:
            return point_of_parts(e, u);
        case EmitterForm::Sphere: {
            const Vec3 n = on_own_sphere(u);
            return {world.point(n),
                    outer_normal(e, n),
                    1.0 / (4.0 * kPi * length(transformed_area(world.linear, n))),
                    {}};
        }
        case EmitterForm::Tube: {
            SeenTube all(e, world.translation);
            all.half = kPi;
            return point_of_tube(e, all, u);
        }
        case EmitterForm::Patch:
            break;
    }
    return point_of_patch(e, u);
}

double area_density(const Emitter& e, const Vec3& normal, const Vec2& parameters) {
    switch (e.form) {
        case EmitterForm::Sphere: {
            const Vec3 n = normalize(transpose_times(e.world_from_own.linear, normal));
            return 1.0 / (4.0 * kPi * length(transformed_area(e.world_from_own.linear, n)));
        }
        case EmitterForm::Tube:
            return 1.0 / (2.0 * kPi * stretch_of_tube(e, own_normal_of_tube(e, normal)));
        case EmitterForm::Patch:
            return point_of_patch(e, parameters).density;
        default:
            return 1.0 / e.area;
    }
}

}  // namespace alhazen
