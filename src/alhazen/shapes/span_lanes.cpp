#include "alhazen/shapes/span_lanes.h"

#include "alhazen/geometry/sphere_roots.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/span_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(kRayLanes == kLaneCount);

#include "alhazen/geometry/sphere_roots_formula-inl.h"

struct Vec3Lanes {
    Doubles x, y, z;
};
HWY_INLINE Vec3Lanes load_vectors(const double (&rows)[3][kRayLanes]) {
    return {load_lanes(rows[0]), load_lanes(rows[1]), load_lanes(rows[2])};
}
HWY_INLINE Vec3Lanes operator-(const Vec3Lanes& a, const Vec3& b) {
    return {a.x - Doubles(b.x), a.y - Doubles(b.y), a.z - Doubles(b.z)};
}
HWY_INLINE Doubles dot(const Vec3Lanes& a, const Vec3Lanes& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE Doubles dot(const Vec3& a, const Vec3Lanes& b) {
    return Doubles(a.x) * b.x + Doubles(a.y) * b.y + Doubles(a.z) * b.z;
}

/// A number that no crossing is beyond, nor any that makes one; not one that overflows when it is
/// squared either.
constexpr double kFarNumber = 0x1p500;

/// Tells the lanes apart that are asked alone: those whose crossings are not finite.
HWY_INLINE void set_spans(const Doubles& entry, const Doubles& exit, std::uint32_t maybe,
                          SpanLanes& out) {
    const Doubles far(kFarNumber);
    const std::uint32_t finite = bits_of((abs(entry) < far) & (abs(exit) < far));
    out.unsure |= maybe & ~finite;
    out.met = maybe & finite & bits_of(entry <= exit);
    store_lanes(entry, out.entry);
    store_lanes(exit, out.exit);
}

void sphere_spans(const RayLanes& rays, const Sphere& sphere, SpanLanes& out) {
    const Vec3Lanes d = load_vectors(rays.direction);
    const Vec3Lanes f = load_vectors(rays.origin) - sphere.center;
    const Doubles a = dot(d, d), radius(sphere.radius), zero(0.0);
    const SphereLine<Doubles> line = sphere_line(d.x, d.y, d.z, a, f.x, f.y, f.z, radius);
    const std::uint32_t met = bits_of(line.discriminant >= zero);
    out.met = out.unsure = 0;
    if (met == 0) return;
    const SphereRoots<Doubles> roots = sphere_roots(line, a, f.x, f.y, f.z, radius);
    const Doubles &entry = roots.t_near, &exit = roots.t_far;
    // As `are_plain_roots`, but for the largest numbers.
    const std::uint32_t plain =
        bits_of(entry <= exit) & bits_of((entry < zero) | (entry > zero)) &
        bits_of((exit < zero) | (exit > zero));
    out.unsure = met & ~plain;
    set_spans(entry, exit, met & plain, out);
    store_lanes(zero, out.entry_part);
    store_lanes(zero, out.exit_part);
}

/// As BoxShape::intersect. What lies in the plane of a face, or along it, is asked alone.
void box_spans(const RayLanes& rays, const BoxShape& box, SpanLanes& out) {
    Doubles entry(-kFarNumber), exit(kFarNumber), entry_part(0.0), exit_part(0.0);
    const Doubles zero(0.0);
    std::uint32_t level = 0;
    HWY_UNROLL(3)
    for (int k = 0; k < 3; ++k) {
        const Doubles o = load_lanes(rays.origin[k]), d = load_lanes(rays.direction[k]);
        const LaneMask<double> up = d > zero, down = d < zero;
        level |= kAllLanes & ~bits_of(up | down);
        const Doubles lo(box.lo[k]), hi(box.hi[k]);
        const Doubles low_face(2.0 * k), high_face(2.0 * k + 1.0);
        const Doubles t_near = (select_lanes(up, lo, hi) - o) / d;
        const Doubles t_far = (select_lanes(up, hi, lo) - o) / d;
        const LaneMask<double> later = t_near > entry, sooner = t_far < exit;
        entry = select_lanes(later, t_near, entry);
        exit = select_lanes(sooner, t_far, exit);
        entry_part = select_lanes(later, select_lanes(up, low_face, high_face), entry_part);
        exit_part = select_lanes(sooner, select_lanes(up, high_face, low_face), exit_part);
    }
    out.unsure = level;
    set_spans(entry, exit, kAllLanes & ~level, out);
    store_lanes(entry_part, out.entry_part);
    store_lanes(exit_part, out.exit_part);
}

/// As frustum.cpp: `localise`, `inside_side` for lines flatter than the cone, `intersect_solid`.
void frustum_spans(const RayLanes& rays, const Frustum& f, SpanLanes& out) {
    out.met = 0;
    out.unsure = kAllLanes;
    if (!kFusesExactly) return;
    const Vec3Lanes d = load_vectors(rays.direction);
    Vec3Lanes o = load_vectors(rays.origin) - f.center;
    const Doubles zero(0.0);
    // Far away the origin is shifted to the line's nearest point.
    const LaneMask<double> far = dot(o, o) > Doubles(16.0 * f.bounding_radius_squared);
    const Doubles by = -dot(o, d) / dot(d, d);
    const Doubles shift = select_lanes(far, by, zero);
    o = {select_lanes(far, o.x + by * d.x, o.x), select_lanes(far, o.y + by * d.y, o.y),
         select_lanes(far, o.z + by * d.z, o.z)};
    const Doubles ox = dot(f.x_axis, o), oy = dot(f.y_axis, o), oz = dot(f.axis, o);
    const Doubles dx = dot(f.x_axis, d), dy = dot(f.y_axis, d), dz = dot(f.axis, d);
    const Doubles slope(f.slope);
    const Doubles radius = Doubles(f.middle_radius) + slope * oz, growth = slope * dz;
    const Doubles a = dx * dx + dy * dy - growth * growth;
    const Doubles wx = difference_of_products(radius, dx, growth, ox);
    const Doubles wy = difference_of_products(radius, dy, growth, oy);
    const Doubles w = sqrt(wx * wx + wy * wy);
    const Doubles moment = abs(difference_of_products(ox, dy, oy, dx));
    const Doubles discriminant = (w - moment) * (w + moment);
    const std::uint32_t flat = bits_of(a > zero);
    out.unsure = kAllLanes & ~flat;
    std::uint32_t maybe = flat & bits_of(discriminant >= zero);
    if (maybe == 0) return;
    const Doubles b = ox * dx + oy * dy - radius * growth;
    const Doubles across = sqrt(ox * ox + oy * oy);
    const Doubles c = (across - radius) * (across + radius);
    // In the nappe of the roots' middle.
    maybe &= ~bits_of(radius + (-b / a) * growth < zero);
    const Doubles s = sqrt(discriminant);
    const LaneMask<double> safe = (Doubles(4.0) * abs(b) < s) | !((s < zero) | (s > zero));
    const Doubles q = -(b + copysign(s, b));
    const Doubles t0 = select_lanes(safe, -b - s, q) / a;
    const Doubles t1 = select_lanes(safe, -b + s, c) / select_lanes(safe, a, q);
    const LaneMask<double> swapped = t1 < t0;
    Doubles entry = select_lanes(swapped, t1, t0), exit = select_lanes(swapped, t0, t1);
    maybe &= bits_of(entry <= exit);
    // Between the caps.
    const LaneMask<double> up = dz > zero, level = !(up | (dz < zero));
    const Doubles half(f.half_height);
    const Doubles slab_entry = (copysign(half, -dz) - oz) / dz;
    const Doubles slab_exit = (copysign(half, dz) - oz) / dz;
    maybe &= ~bits_of(level) | bits_of(abs(oz) < half);
    const LaneMask<double> by_cap = (!level) & (slab_entry > entry);
    const LaneMask<double> to_cap = (!level) & (slab_exit < exit);
    entry = select_lanes(by_cap, slab_entry, entry);
    exit = select_lanes(to_cap, slab_exit, exit);
    maybe &= bits_of(entry <= exit);
    if (maybe == 0) return;
    const Doubles base(1.0), top(2.0);
    set_spans(shift + entry, shift + exit, maybe, out);
    store_lanes(select_lanes(by_cap, select_lanes(up, base, top), zero), out.entry_part);
    store_lanes(select_lanes(to_cap, select_lanes(up, top, base), zero), out.exit_part);
}

}  // namespace

const SpanKernels& span_kernels_of_target() {
    static constexpr SpanKernels kKernels{&sphere_spans, &box_spans, &frustum_spans};
    return kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(span_kernels_of_target);

const SpanKernels& span_kernels() {
    // Asked for every eight rays: what the processor can do is not looked up again.
    return HWY_DYNAMIC_DISPATCH(span_kernels_of_target)();
}

}  // namespace alhazen
#endif
