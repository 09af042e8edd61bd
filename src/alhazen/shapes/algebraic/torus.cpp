#include "alhazen/shapes/algebraic/torus.h"

#include "alhazen/base/instruction_sets.h"
#include "alhazen/shapes/algebraic/polynomial_lanes.h"
#include "alhazen/shapes/algebraic/torus_polynomial.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/core/first_hits.h"
#include "alhazen/shapes/core/plain_surface.h"

namespace alhazen {

namespace {

/// Cuts the line to a cylinder's box around the torus. The cut has no other use, so that products
/// with reciprocals are accurate enough.
bool cut_around(const Vec3& o, const Vec3& d, double reach, double height, ClipRange& range) {
    const double half[] = {reach, reach, height};
    for (int k = 0; k < 3; ++k) {
        const double inverse = 1.0 / d[k];
        const double far = std::copysign(half[k], d[k]);
        // NaN where the line runs within a face: there it is outside of the torus.
        const double near = (-far - o[k]) * inverse, beyond = (far - o[k]) * inverse;
        range.entry = near > range.entry ? near : range.entry;
        range.exit = beyond < range.exit ? beyond : range.exit;
    }
    if (!(range.entry < range.exit) || !std::isfinite(range.exit - range.entry)) return false;
    // True if the line is nearer to the centre than `reach`.
    return length_squared(cross(o, d)) <= reach * reach * length_squared(d);
}

}  // namespace

void Torus::prepare() {
    unit_axis = unit_or(axis, {0, 0, 1});
    const Vec3 x = perpendicular(unit_axis);
    frame = SolidFrame(center, Mat3{major_radius * x, major_radius * cross(unit_axis, x),
                                    major_radius * unit_axis});
    tube = minor_radius / major_radius;
}

void Torus::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (!checks.ok()) return;
    if (minor_radius > major_radius) {
        checks.fail("minor_radius must not exceed major_radius");
    } else if (minor_radius < 1e-6 * major_radius) {
        checks.fail("minor_radius must be at least a millionth of major_radius");
    }
}

Box3 Torus::box() const {
    // As circle_half_box, less accurate for a half near zero, since the tube is added here; called
    // for every surface.
    const Vec3& n = unit_axis;
    const double xx = n.x * n.x, yy = n.y * n.y, zz = n.z * n.z;
    const Vec3 ring{std::sqrt(yy + zz), std::sqrt(zz + xx), std::sqrt(xx + yy)};
    return outward_box(center,
                       major_radius * ring + Vec3{minor_radius, minor_radius, minor_radius});
}

Interval Torus::extent(const Vec3& direction) const {
    return outward_extent(direction, center,
                          major_radius * length(accurate_cross(direction, unit_axis)) +
                              minor_radius * length(direction));
}

namespace {

/// Cuts the line to the neighbourhood of the torus.
bool segment_of(const Torus& torus, const Ray& ray, ClipSegment& s) {
    const double reach = kTorusRoom * (1.0 + torus.tube), height = kTorusRoom * torus.tube;
    const auto cut = [&](const Vec3& o, const Vec3& d, ClipRange& range) {
        return cut_around(o, d, reach, height, range);
    };
    return clip_segment_by(torus.frame, ray, reach, cut, s);
}

int all_hits_body(const Torus& torus, const Ray& ray, ShapeHit* hits) {
    ClipSegment s;
    if (!segment_of(torus, ray, s)) return 0;
    return intersect_segment(TorusPolynomial{torus.tube}, torus.frame, ray, s, true, hits);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET(int all_hits(const Torus& torus, const Ray& ray, ShapeHit* hits),
                                 all_hits_body(torus, ray, hits))

bool one_hit_body(const Torus& torus, const Ray& ray, ShapeHit& hit) {
    ClipSegment s;
    if (!segment_of(torus, ray, s)) return false;
    return first_on_segment(TorusPolynomial{torus.tube}, torus.frame, ray, s, true, hit);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET(bool one_hit(const Torus& torus, const Ray& ray, ShapeHit& hit),
                                 one_hit_body(torus, ray, hit))

}  // namespace

int Torus::intersect(const Ray& ray, ShapeHit* hits) const {
    return all_hits(*this, ray, hits);
}

bool first_hit(const Torus& shape, const Ray& ray, ShapeHit& hit) {
    return one_hit(shape, ray, hit);
}

namespace {

ALHAZEN_FOR_EACH_INSTRUCTION_SET(double improved(const Torus& torus, const Ray& ray,
                                                 std::size_t lane, const PolynomialLanes& lanes),
                                 improved_root_of_lane(TorusPolynomial{torus.tube}, torus.frame,
                                                       ray, lane, lanes))

}  // namespace

std::uint32_t first_hits(const Torus& shape, std::span<const Ray* const> rays, ShapeHit* hits) {
    return first_hits_in_lanes(
        rays, hits,
        [&](const PolynomialKernels& kernels, const RayLanes& in, PolynomialLanes& lanes) {
            kernels.torus(shape, in, lanes);
        },
        [&](const Ray& ray, std::size_t lane, const PolynomialLanes& lanes) {
            return improved(shape, ray, lane, lanes);
        },
        [&](const Ray& ray, ShapeHit& hit) { return one_hit(shape, ray, hit); });
}

namespace {

/// The nearest point of the tube, by projection towards the circle. Accurate to a few roundings of
/// the coordinates, which `Torus::surface` accounts for.
ProjectedPoint nearest_on_tube(const Vec3& p, double tube, const Vec3& direction) {
    const double across = std::sqrt(p.x * p.x + p.y * p.y);
    const double out = across - 1.0;
    const double distance = std::sqrt(out * out + p.z * p.z);
    // On the axis or on the circle this direction is undefined.
    if (!(across > 0.0 && distance > 0.0)) {
        const Vec3 back = -1e-6 * tube * unit_or(direction, {0, 0, 1});
        return project_to_zero(TorusPolynomial{tube}, p, back);
    }
    const double scale = tube / distance;
    const double ratio = (1.0 + out * scale) / across;
    const double radial = out / across;
    return {{p.x * ratio, p.y * ratio, p.z * scale}, {p.x * radial, p.y * radial, p.z}, 0.0};
}

ProjectedPoint point_on(const Torus& torus, const Ray& ray, const ShapeHit& hit) {
    const SolidFrame& frame = torus.frame;
    return nearest_on_tube(frame.to_local(ray.at(hit.t)), torus.tube,
                           frame.local_from_object * ray.direction);
}

ShapeSurface surface_at(const Torus& torus, const ProjectedPoint& at) {
    ShapeSurface surface = surface_of(torus.frame, at);
    surface.error += torus.frame.object_error(at.point, 8);
    return surface;
}

}  // namespace

ShapeSurface plain_surface(const Torus& shape, const Ray& ray, const ShapeHit& hit) {
    return surface_at(shape, point_on(shape, ray, hit));
}

ShapeSurface Torus::surface(const Ray& ray, const ShapeHit& hit) const {
    const ProjectedPoint at = point_on(*this, ray, hit);
    ShapeSurface surface = surface_at(*this, at);
    const Vec3& p = at.point;
    LocalUv local = turn_uv(p);
    const double across = std::sqrt(p.x * p.x + p.y * p.y);
    const double out = across - 1.0;
    local.uv.y = turn_fraction(out, p.z);
    const double squared = 2.0 * kPi * (out * out + p.z * p.z);
    if (across > 0.0 && squared > 0.0) {
        local.v_gradient = Vec3{-p.z * p.x / across, -p.z * p.y / across, out} / squared;
    }
    set_uv(frame, local, at.gradient, surface);
    return surface;
}

}  // namespace alhazen
