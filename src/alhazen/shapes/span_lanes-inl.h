/// Finds where eight lines in lanes enter and leave a closed convex shape, or cross the side of an
/// open frustum.
///
/// Source: sphere_roots.h, frustum.cpp, box_shape.cpp; the same operations in the same order.
/// Differs: rare cases (a cone steeper than the line or very flat, a line along an axis, numbers
/// out of range) are left to the scalar version. Conventions: included once per target (see
/// simd/lanes-inl.h); ignores the limits of the rays. `unsure` lanes need the scalar version; for
/// the other wanted lanes entry and exit are bit-identical to the two crossings that `intersect`
/// writes for the whole line, or there are none.

#if defined(ALHAZEN_SHAPES_SPAN_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SHAPES_SPAN_LANES_INL_H_
#undef ALHAZEN_SHAPES_SPAN_LANES_INL_H_
#else
#define ALHAZEN_SHAPES_SPAN_LANES_INL_H_
#endif

#include <algorithm>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/geometry/sphere_roots.h"
#include "alhazen/shapes/polygons/box_shape.h"
#include "alhazen/shapes/quadrics/frustum.h"
#include "alhazen/shapes/quadrics/sphere.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

static_assert(kRayLanes == kLaneCount);

namespace span_lanes {
#include "alhazen/geometry/sphere_roots_formula-inl.h"
}  // namespace span_lanes

struct Vec3Lanes {
    Doubles x, y, z;
};
HWY_INLINE Vec3Lanes load_ray_vectors(const double (&rows)[3][kRayLanes]) {
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

/// Lanes whose points are outside a shape and farther than `margin` from it. Conservative: may miss
/// some. Points must be finite.
HWY_INLINE LaneMask<double> far_outside(const Sphere& sphere, const Vec3Lanes& point,
                                        const Doubles& margin) {
    const Vec3Lanes p = point - sphere.center;
    const Doubles reach = Doubles(sphere.radius) + margin;
    return dot(p, p) > reach * reach;
}
HWY_INLINE LaneMask<double> far_outside(const BoxShape& box, const Vec3Lanes& point,
                                        const Doubles& margin) {
    const Vec3Lanes below = point - box.lo, above = point - box.hi;
    return (max_lanes(max_lanes(above.x, above.y), above.z) > margin) |
           (min_lanes(min_lanes(below.x, below.y), below.z) < -margin);
}
/// Tests the cylinder around the frustum.
HWY_INLINE LaneMask<double> far_outside(const Frustum& f, const Vec3Lanes& point,
                                        const Doubles& margin) {
    const Vec3Lanes p = point - f.center;
    const Doubles x = dot(f.x_axis, p), y = dot(f.y_axis, p), z = dot(f.axis, p);
    const Doubles reach = Doubles(std::max(f.base_radius, f.top_radius)) + margin;
    return (x * x + y * y > reach * reach) | (abs(z) > Doubles(f.half_height) + margin);
}

/// Zero in lanes below zero, of which the root is not used.
HWY_INLINE Doubles or_zero_below(const Doubles& square) {
    return select_lanes(square < Doubles(0.0), Doubles(0.0), square);
}

/// Bound of all crossings and of the numbers they are computed from; its square does not overflow.
constexpr double kFarNumber = 0x1p500;

/// The entries and exits of lines.
struct LaneSpans {
    Doubles entry, exit;            ///< valid for lanes that hit; entry <= exit
    Doubles entry_part, exit_part;  ///< integers
    std::uint32_t met = 0;          ///< the line crosses the shape
    std::uint32_t unsure = 0;       ///< left to the scalar version; not in `met`

    /// Sets the spans of the lines in `maybe`; lines with crossings that are not finite are unsure.
    HWY_INLINE void set(const Doubles& in, const Doubles& out, std::uint32_t maybe) {
        const Doubles far(kFarNumber);
        const std::uint32_t finite = bits_of((abs(in) < far) & (abs(out) < far));
        unsure |= maybe & ~finite;
        met = maybe & finite & bits_of(in <= out);
        entry = in;
        exit = out;
    }
};

HWY_INLINE void find_spans(const RayLanes& rays, const Sphere& sphere, std::uint32_t wanted,
                           LaneSpans& spans) {
    const Vec3Lanes d = load_ray_vectors(rays.direction);
    const Vec3Lanes f = load_ray_vectors(rays.origin) - sphere.center;
    const Doubles a = dot(d, d), radius(sphere.radius), zero(0.0);
    auto line = span_lanes::sphere_line(d.x, d.y, d.z, a, f.x, f.y, f.z, radius);
    const std::uint32_t met = wanted & bits_of(line.discriminant >= zero);
    if (met == 0) return;
    line.discriminant = or_zero_below(line.discriminant);
    spans.entry_part = spans.exit_part = zero;
    const Doubles distance = sqrt(dot(f, f));
    const Doubles c = (distance - radius) * (distance + radius);
    if ((met & ~bits_of((line.b < zero) & (c > zero))) == 0) {
        const auto ahead = span_lanes::sphere_roots_ahead(line, a, c);
        const std::uint32_t plain =
            bits_of((ahead.t_near > zero) & (ahead.t_far < Doubles(kFarNumber)));
        spans.entry = ahead.t_near;
        spans.exit = ahead.t_far;
        spans.met = met & plain;
        spans.unsure = met & ~plain;
        return;
    }
    const auto roots = span_lanes::sphere_roots(line, a, f.x, f.y, f.z, radius);
    const Doubles &entry = roots.t_near, &exit = roots.t_far;
    // As `are_plain_roots`, except for the largest numbers.
    const std::uint32_t plain = bits_of(entry <= exit) & bits_of((entry < zero) | (entry > zero)) &
                                bits_of((exit < zero) | (exit > zero));
    spans.unsure = met & ~plain;
    spans.set(entry, exit, met & plain);
}

/// As BoxShape::intersect. Lines in the plane of a face or parallel to it are unsure.
HWY_INLINE void find_spans(const RayLanes& rays, const BoxShape& box, std::uint32_t wanted,
                           LaneSpans& spans) {
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
    spans.unsure = wanted & level;
    spans.set(entry, exit, wanted & ~level);
    spans.entry_part = entry_part;
    spans.exit_part = exit_part;
}

/// Lines in the frame of a frustum, as FrustumLine of frustum.cpp, with their crossings of the
/// infinite side.
struct FrustumLines {
    Doubles shift, oz, dz, radius, growth, a, b;
    Doubles first, last;    ///< in ascending order, without `shift`
    std::uint32_t crossed;  ///< the lines that cross it
    std::uint32_t unsure;   ///< not flatter than the cone; not in `crossed`

    /// As `localise` and `roots`.
    HWY_INLINE FrustumLines(const RayLanes& rays, const Frustum& f, std::uint32_t wanted) {
        crossed = 0;
        unsure = wanted;
        if (!kFusesExactly || f.is_flat()) return;
        const Vec3Lanes d = load_ray_vectors(rays.direction);
        Vec3Lanes o = load_ray_vectors(rays.origin) - f.center;
        const Doubles zero(0.0);
        // Shifts distant origins to the line's nearest point.
        const LaneMask<double> far = dot(o, o) > Doubles(16.0 * f.bounding_radius_squared);
        const Doubles by = -dot(o, d) / dot(d, d);
        shift = select_lanes(far, by, zero);
        o = {select_lanes(far, o.x + by * d.x, o.x), select_lanes(far, o.y + by * d.y, o.y),
             select_lanes(far, o.z + by * d.z, o.z)};
        const Doubles ox = dot(f.x_axis, o), oy = dot(f.y_axis, o);
        const Doubles dx = dot(f.x_axis, d), dy = dot(f.y_axis, d);
        oz = dot(f.axis, o);
        dz = dot(f.axis, d);
        const Doubles slope(f.slope);
        radius = Doubles(f.middle_radius) + slope * oz;
        growth = slope * dz;
        a = dx * dx + dy * dy - growth * growth;
        const Doubles wx = difference_of_products(radius, dx, growth, ox);
        const Doubles wy = difference_of_products(radius, dy, growth, oy);
        const Doubles w = sqrt(wx * wx + wy * wy);
        const Doubles moment = abs(difference_of_products(ox, dy, oy, dx));
        const Doubles discriminant = (w - moment) * (w + moment);
        const std::uint32_t flat = wanted & bits_of(a > zero);
        unsure = wanted & ~flat;
        crossed = flat & bits_of(discriminant >= zero);
        if (crossed == 0) return;
        b = ox * dx + oy * dy - radius * growth;
        const Doubles across = sqrt(ox * ox + oy * oy);
        const Doubles c = (across - radius) * (across + radius);
        const Doubles s = sqrt(or_zero_below(discriminant));
        const LaneMask<double> safe = (Doubles(4.0) * abs(b) < s) | !((s < zero) | (s > zero));
        const Doubles q = -(b + copysign(s, b));
        const Doubles t0 = select_lanes(safe, -b - s, q) / a;
        const Doubles t1 = select_lanes(safe, -b + s, c) / select_lanes(safe, a, q);
        const LaneMask<double> swapped = t1 < t0;
        first = select_lanes(swapped, t1, t0);
        last = select_lanes(swapped, t0, t1);
    }
};

/// As frustum.cpp: `inside_side` for lines flatter than the cone, and `intersect_solid`.
HWY_INLINE void find_spans(const RayLanes& rays, const Frustum& f, std::uint32_t wanted,
                           LaneSpans& spans) {
    const FrustumLines line(rays, f, wanted);
    spans.unsure = line.unsure;
    std::uint32_t maybe = line.crossed;
    if (maybe == 0) return;
    const Doubles zero(0.0);
    // Selects the nappe of the roots' middle.
    maybe &= ~bits_of(line.radius + (-line.b / line.a) * line.growth < zero);
    Doubles entry = line.first, exit = line.last;
    maybe &= bits_of(entry <= exit);
    // Clips to the caps.
    const Doubles &oz = line.oz, &dz = line.dz;
    const LaneMask<double> up = dz > zero, level = !(up | (dz < zero));
    const Doubles half(f.half_height);
    const Doubles slab_entry = (copysign(half, -dz) - oz) / dz;
    const Doubles slab_exit = (copysign(half, dz) - oz) / dz;
    spans.unsure |= maybe & bits_of(level);
    maybe &= ~bits_of(level);
    const LaneMask<double> by_cap = (!level) & (slab_entry > entry);
    const LaneMask<double> to_cap = (!level) & (slab_exit < exit);
    entry = select_lanes(by_cap, slab_entry, entry);
    exit = select_lanes(to_cap, slab_exit, exit);
    maybe &= bits_of(entry <= exit);
    if (maybe == 0) return;
    const Doubles base(1.0), top(2.0);
    spans.set(line.shift + entry, line.shift + exit, maybe);
    spans.entry_part = select_lanes(by_cap, select_lanes(up, base, top), zero);
    spans.exit_part = select_lanes(to_cap, select_lanes(up, top, base), zero);
}

/// The first crossings of rays with a shape, within their limits.
struct LaneCrossings {
    Doubles t, part;           ///< valid for the rays that hit; parts are integers
    std::uint32_t hit = 0;     ///< the rays that hit
    std::uint32_t unsure = 0;  ///< left to the scalar version; not in `hit`
};

/// The first crossings of `spans` within the limits of the rays.
HWY_INLINE void take_spans(const RayLanes& rays, const LaneSpans& spans, LaneCrossings& found) {
    found.unsure = spans.unsure;
    if (spans.met == 0) return;
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    const LaneMask<double> enters = (t_min <= spans.entry) & (spans.entry <= t_max);
    const LaneMask<double> leaves = (t_min <= spans.exit) & (spans.exit <= t_max);
    found.hit = spans.met & bits_of(enters | leaves);
    found.t = select_lanes(enters, spans.entry, spans.exit);
    found.part = select_lanes(enters, spans.entry_part, spans.exit_part);
}

/// As Sphere::intersect.
HWY_INLINE void find_first_crossings(const RayLanes& rays, const Sphere& sphere,
                                     std::uint32_t wanted, LaneCrossings& found) {
    LaneSpans spans;
    find_spans(rays, sphere, wanted, spans);
    take_spans(rays, spans, found);
}

/// As Frustum::intersect.
HWY_INLINE void find_first_crossings(const RayLanes& rays, const Frustum& f, bool capped,
                                     std::uint32_t wanted, LaneCrossings& found) {
    if (capped) {
        LaneSpans spans;
        find_spans(rays, f, wanted, spans);
        return take_spans(rays, spans, found);
    }
    const FrustumLines line(rays, f, wanted);
    found.unsure = line.unsure;
    if (line.crossed == 0) return;
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    const Doubles half(f.half_height), far(kFarNumber);
    const auto met = [&](const Doubles& root, const Doubles& t) HWY_ATTR {
        const Doubles z = line.oz + root * line.dz;
        return (-half <= z) & (z < half) & (t_min <= t) & (t <= t_max);
    };
    const Doubles entry = line.shift + line.first, exit = line.shift + line.last;
    const std::uint32_t finite = bits_of((abs(entry) < far) & (abs(exit) < far));
    found.unsure |= line.crossed & ~finite;
    const LaneMask<double> enters = met(line.first, entry);
    found.hit = line.crossed & finite & bits_of(enters | met(line.last, exit));
    found.t = select_lanes(enters, entry, exit);
    found.part = Doubles(0.0);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
