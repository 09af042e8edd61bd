#include "alhazen/shapes/algebraic/polynomial_lanes.h"

#include <cstddef>
#include <limits>
#include <span>

#include "alhazen/shapes/algebraic/algebraic.h"
#include "alhazen/shapes/algebraic/torus.h"
#include "alhazen/shapes/algebraic/torus_polynomial.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/algebraic/polynomial_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/shapes/algebraic/polynomial_refine-inl.h"
#include "alhazen/shapes/algebraic/polynomial_roots-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

struct LinePoint {
    Doubles x, y, z;
};
HWY_INLINE LinePoint load_line_point(const double (&rows)[3][kRayLanes]) {
    return {load_lanes(rows[0]), load_lanes(rows[1]), load_lanes(rows[2])};
}
HWY_INLINE void store_line_point(const LinePoint& p, double (&rows)[3][kRayLanes]) {
    store_lanes(p.x, rows[0]);
    store_lanes(p.y, rows[1]);
    store_lanes(p.z, rows[2]);
}
HWY_INLINE LinePoint minus(const LinePoint& p, const Vec3& v) {
    return {p.x - Doubles(v.x), p.y - Doubles(v.y), p.z - Doubles(v.z)};
}
HWY_INLINE LinePoint times(const Mat3& m, const LinePoint& v) {
    const auto row = [&](double a, double b, double c) HWY_ATTR {
        return v.x * Doubles(a) + v.y * Doubles(b) + v.z * Doubles(c);
    };
    return {row(m.x_axis.x, m.y_axis.x, m.z_axis.x), row(m.x_axis.y, m.y_axis.y, m.z_axis.y),
            row(m.x_axis.z, m.y_axis.z, m.z_axis.z)};
}
HWY_INLINE Doubles dot(const LinePoint& a, const LinePoint& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE LinePoint cross(const LinePoint& a, const LinePoint& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// The largest finite magnitude of a coordinate.
HWY_INLINE Doubles reach_of(const LinePoint& p) {
    return max_lanes(abs(p.x), max_lanes(abs(p.y), abs(p.z)));
}

/// Eight lines in the frame of a shape, and the part of each within its clip.
struct Lines {
    LinePoint from;  ///< as in `clip_segment_by`
    LinePoint o, d;
    Doubles entry, exit;
    Doubles entry_part, exit_part;
};

HWY_INLINE Lines to_frame(const SolidFrame& frame, const RayLanes& rays) {
    Lines l;
    l.from = minus(load_line_point(rays.origin), frame.origin);
    l.o = times(frame.local_from_object, l.from);
    l.d = times(frame.local_from_object, load_line_point(rays.direction));
    l.entry = Doubles(-std::numeric_limits<double>::infinity());
    l.exit = Doubles(std::numeric_limits<double>::infinity());
    l.entry_part = l.exit_part = Doubles(0.0);
    return l;
}

/// As `cut_around` of the torus; returns the lanes that remain.
HWY_INLINE std::uint32_t cut_around(double reach, double height, Lines& l) {
    const auto cut = [&](const Doubles& o, const Doubles& d, double half) HWY_ATTR {
        const Doubles inverse = Doubles(1.0) / d;
        const Doubles far = copysign(Doubles(half), d);
        const Doubles near = (-far - o) * inverse, beyond = (far - o) * inverse;
        l.entry = select_lanes(near > l.entry, near, l.entry);
        l.exit = select_lanes(beyond < l.exit, beyond, l.exit);
    };
    cut(l.o.x, l.d.x, reach);
    cut(l.o.y, l.d.y, reach);
    cut(l.o.z, l.d.z, height);
    const LinePoint c = cross(l.o, l.d);
    return bits_of((l.entry < l.exit) & is_finite(l.exit - l.entry) &
                   (dot(c, c) <= Doubles(reach * reach) * dot(l.d, l.d)));
}

/// As `cut_by_box` in the frame of the object; returns the lanes that remain. `unsure`: those where
/// a quotient overflows.
HWY_INLINE std::uint32_t cut_by_box(const Box3& box, Lines& l, std::uint32_t& unsure) {
    std::uint32_t left = kAllLanes;
    unsure = 0;
    const auto cut = [&](const Doubles& o, const Doubles& d, double low, double high,
                         double low_part) HWY_ATTR {
        const Doubles lo(low), hi(high);
        const Mask up = d > Doubles(0.0), moves = up | (d < Doubles(0.0));
        const Doubles near = (select_lanes(up, lo, hi) - o) / d,
                      far = (select_lanes(up, hi, lo) - o) / d;
        const Mask later = moves & (near > l.entry), sooner = moves & (far < l.exit);
        const Doubles first(low_part), second(low_part + 1.0);
        l.entry = select_lanes(later, near, l.entry);
        l.entry_part = select_lanes(later, select_lanes(up, first, second), l.entry_part);
        l.exit = select_lanes(sooner, far, l.exit);
        l.exit_part = select_lanes(sooner, select_lanes(up, second, first), l.exit_part);
        const std::uint32_t moving = bits_of(moves);
        left &= moving | bits_of((lo < o) & (o <= hi));
        unsure |= moving & ~bits_of(is_finite(near) & is_finite(far));
    };
    cut(l.o.x, l.d.x, box.lo.x, box.hi.x, 1.0);
    cut(l.o.y, l.d.y, box.lo.y, box.hi.y, 3.0);
    cut(l.o.z, l.d.z, box.lo.z, box.hi.z, 5.0);
    return left & bits_of(l.entry < l.exit);
}

/// The rest of `clip_segment_by` for the lanes in `left`: the ends of the segments. Returns false
/// when all lanes miss.
HWY_INLINE bool end_points(const SolidFrame& frame, const RayLanes& rays, double size,
                           std::uint32_t left, Lines& l, PolynomialLanes& out, LinePoint& p,
                           LinePoint& q) {
    left &= bits_of((l.exit >= load_lanes(rays.t_min)) & (l.entry <= load_lanes(rays.t_max)));
    out.missed = kAllLanes & ~left;
    if (left == 0) return false;
    const LinePoint direction = load_line_point(rays.direction);
    const Doubles step = reach_of(direction);
    store_lanes(l.entry, out.entry);
    store_lanes(l.exit, out.exit);
    store_lanes(Doubles(0.0), out.shift);
    std::uint32_t far_off =
        left & bits_of(abs(l.entry) * step * Doubles(frame.stretch) > Doubles(16.0 * size));
    if (far_off != 0) {
        alignas(64) double origin[3][kRayLanes];
        store_line_point(l.from, origin);
        for (; far_off != 0; far_off &= far_off - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(far_off));
            Ray ray;
            for (int k = 0; k < 3; ++k) {
                ray.origin[k] = rays.origin[k][i];
                ray.direction[k] = rays.direction[k][i];
            }
            out.shift[i] = out.entry[i];
            const Vec3 from = advanced(ray, out.shift[i]).origin - frame.origin;
            for (int k = 0; k < 3; ++k) origin[k][i] = from[k];
        }
        l.from = load_line_point(origin);
        l.o = times(frame.local_from_object, l.from);
    }
    const Doubles shift = load_lanes(out.shift);
    const Doubles begin = l.entry - shift, end = l.exit - shift;
    const Doubles relative =
        Doubles(6.0 * frame.stretch / size) *
        (reach_of(l.from) + Doubles(max_component(alhazen::abs(frame.origin))) +
         max_lanes(abs(begin), abs(end)) * step);
    store_lanes(relative, out.relative_error);
    store_line_point(l.o, out.o);
    store_line_point(l.d, out.d);
    store_lanes(l.entry_part, out.entry_part);
    store_lanes(l.exit_part, out.exit_part);
    p = {l.o.x + begin * l.d.x, l.o.y + begin * l.d.y, l.o.z + begin * l.d.z};
    q = {l.o.x + end * l.d.x, l.o.y + end * l.d.y, l.o.z + end * l.d.z};
    return true;
}

/// As `restrict_to_segment`, with b already computed.
HWY_INLINE void set_error(double magnitude, double roundings, PolynomialLanes& lanes) {
    store_lanes(
        Doubles(0x1p-53 * magnitude) *
            (Doubles(roundings) + Doubles(1.5 * lanes.degree) * load_lanes(lanes.relative_error)),
        lanes.error);
}

namespace formulas {

#include "alhazen/shapes/algebraic/torus_formula-inl.h"

template <class Real>
HWY_INLINE Real constant_as(const DoubleDouble& c) {
    return Real(c.high);
}
HWY_INLINE Doubles divided(const Doubles& a, double by) {
    return a / Doubles(by);
}

#include "alhazen/shapes/algebraic/restricted_polynomial-inl.h"

}  // namespace formulas

void torus(const Torus& shape, const RayLanes& rays, PolynomialLanes& lanes) {
    const double reach = kTorusRoom * (1.0 + shape.tube), height = kTorusRoom * shape.tube;
    lanes.unsure = lanes.at_entry = lanes.bracketed = lanes.last = 0;
    Lines lines = to_frame(shape.frame, rays);
    LinePoint p, q;
    const std::uint32_t left = cut_around(reach, height, lines);
    if (!end_points(shape.frame, rays, reach, left, lines, lanes, p, q)) return;
    const TorusPolynomial f{shape.tube};
    Doubles b[5];
    formulas::torus_coefficients(p, q, Doubles(f.k<double>()), Doubles(1.0 / 3.0), b);
    for (int i = 0; i <= 4; ++i) store_lanes(b[i], lanes.b[i]);
    lanes.degree = 4;
    set_error(f.magnitude(), f.roundings(), lanes);
    classify<4>(rays, true, lanes);
}

void algebraic(const Algebraic& shape, const RayLanes& rays, PolynomialLanes& lanes) {
    lanes.at_entry = lanes.bracketed = lanes.last = 0;
    const SolidFrame frame;
    Lines lines = to_frame(frame, rays);
    LinePoint p, q;
    const std::uint32_t left = cut_by_box(shape.clip_box, lines, lanes.unsure);
    const bool any = end_points(frame, rays, shape.size, left, lines, lanes, p, q);
    // Unsure lanes are in no other set.
    lanes.missed &= ~lanes.unsure;
    if (!any) return;
    const PolynomialExpression& polynomial = *shape.polynomial;
    // Storage, set before it is used.
    alignas(64) std::byte room[PolynomialExpression::kMaxCoefficients * sizeof(Doubles)];
    Doubles b[PolynomialLanes::kCoefficients];
    formulas::restrict_nodes(std::span(polynomial.nodes()), p, q, reinterpret_cast<Doubles*>(room),
                             b);
    lanes.degree = polynomial.degree();
    for (int i = 0; i <= lanes.degree; ++i) store_lanes(b[i], lanes.b[i]);
    set_error(shape.magnitude, shape.roundings, lanes);
    switch (lanes.degree) {
        case 3:
            return classify<3>(rays, shape.capped, lanes);
        case 4:
            return classify<4>(rays, shape.capped, lanes);
        case 6:
            return classify<6>(rays, shape.capped, lanes);
        default:
            return classify<PolynomialExpression::kMaxDegree>(rays, shape.capped, lanes);
    }
}

void refine(const RayLanes& rays, PolynomialLanes& lanes) {
    switch (lanes.degree) {
        case 3:
            return refine_degree<3>(rays, lanes);
        case 4:
            return refine_degree<4>(rays, lanes);
        case 6:
            return refine_degree<6>(rays, lanes);
        default:
            return refine_degree<PolynomialExpression::kMaxDegree>(rays, lanes);
    }
}

}  // namespace

const PolynomialKernels& polynomial_kernels_of_target() {
    static constexpr PolynomialKernels kernels{&torus, &algebraic, &refine};
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(polynomial_kernels_of_target);

const PolynomialKernels& polynomial_kernels() {
    // Called for every eight rays: the dispatch is cached.
    return ALHAZEN_KERNEL(polynomial_kernels_of_target)();
}

}  // namespace alhazen
#endif
