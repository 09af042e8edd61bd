#include "alhazen/shapes/polynomial_lanes.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

#include "alhazen/shapes/algebraic.h"
#include "alhazen/shapes/torus.h"
#include "alhazen/shapes/torus_polynomial.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/polynomial_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(kRayLanes == kLaneCount);

using Mask = LaneMask<double>;

HWY_INLINE Doubles select(const Mask& mask, const Doubles& yes, const Doubles& no) {
    Doubles r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<double>; ++i) {
        r.part[i] = hn::IfThenElse(mask.part[i], yes.part[i], no.part[i]);
    }
    return r;
}
HWY_INLINE Mask operator!(const Mask& mask) {
    Mask r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<double>; ++i) r.part[i] = hn::Not(mask.part[i]);
    return r;
}
HWY_INLINE bool none(const Mask& mask) {
    bool r = true;
    for (std::size_t i = 0; i < kParts<double>; ++i) {
        r = r && hn::AllFalse(LaneTag<double>(), mask.part[i]);
    }
    return r;
}
HWY_INLINE Mask is_finite(const Doubles& a) {
    return abs(a) < Doubles(std::numeric_limits<double>::infinity());
}

struct Point {
    Doubles x, y, z;
};
HWY_INLINE Point load_point(const double (&rows)[3][kRayLanes]) {
    return {load_lanes(rows[0]), load_lanes(rows[1]), load_lanes(rows[2])};
}
HWY_INLINE void store_point(const Point& p, double (&rows)[3][kRayLanes]) {
    store_lanes(p.x, rows[0]);
    store_lanes(p.y, rows[1]);
    store_lanes(p.z, rows[2]);
}
HWY_INLINE Point minus(const Point& p, const Vec3& v) {
    return {p.x - Doubles(v.x), p.y - Doubles(v.y), p.z - Doubles(v.z)};
}
HWY_INLINE Point times(const Mat3& m, const Point& v) {
    const auto row = [&](double a, double b, double c) HWY_ATTR {
        return v.x * Doubles(a) + v.y * Doubles(b) + v.z * Doubles(c);
    };
    return {row(m.x_axis.x, m.y_axis.x, m.z_axis.x), row(m.x_axis.y, m.y_axis.y, m.z_axis.y),
            row(m.x_axis.z, m.y_axis.z, m.z_axis.z)};
}
HWY_INLINE Doubles dot(const Point& a, const Point& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// The largest magnitude of a coordinate that is a number.
HWY_INLINE Doubles reach_of(const Point& p) {
    return max_lanes(abs(p.x), max_lanes(abs(p.y), abs(p.z)));
}

/// Eight lines in the frame of a shape, and the part of each that is within its clip.
struct Lines {
    Point from;  ///< as in `clip_segment_by`
    Point o, d;
    Doubles entry, exit;
    Doubles entry_part, exit_part;
};

HWY_INLINE Lines to_frame(const SolidFrame& frame, const RayLanes& rays) {
    Lines l;
    l.from = minus(load_point(rays.origin), frame.origin);
    l.o = times(frame.local_from_object, l.from);
    l.d = times(frame.local_from_object, load_point(rays.direction));
    l.entry = Doubles(-std::numeric_limits<double>::infinity());
    l.exit = Doubles(std::numeric_limits<double>::infinity());
    l.entry_part = l.exit_part = Doubles(0.0);
    return l;
}

/// As `cut_around` of the torus; the lanes that it leaves.
HWY_INLINE std::uint32_t cut_around(double reach, double height, Lines& l) {
    const auto cut = [&](const Doubles& o, const Doubles& d, double half) HWY_ATTR {
        const Doubles inverse = Doubles(1.0) / d;
        const Doubles far = copysign(Doubles(half), d);
        const Doubles near = (-far - o) * inverse, beyond = (far - o) * inverse;
        l.entry = select(near > l.entry, near, l.entry);
        l.exit = select(beyond < l.exit, beyond, l.exit);
    };
    cut(l.o.x, l.d.x, reach);
    cut(l.o.y, l.d.y, reach);
    cut(l.o.z, l.d.z, height);
    const Point c = cross(l.o, l.d);
    return bits_of((l.entry < l.exit) & is_finite(l.exit - l.entry) &
                   (dot(c, c) <= Doubles(reach * reach) * dot(l.d, l.d)));
}

/// As `cut_by_box`; the lanes that it leaves. `unsure` are those where a quotient overflows.
HWY_INLINE std::uint32_t cut_by_box(const Box3& box, Lines& l, std::uint32_t& unsure) {
    std::uint32_t left = kAllLanes;
    unsure = 0;
    const auto cut = [&](const Doubles& o, const Doubles& d, double low, double high,
                         double low_part) HWY_ATTR {
        const Doubles lo(low), hi(high);
        const Mask up = d > Doubles(0.0), moves = up | (d < Doubles(0.0));
        const Doubles near = (select(up, lo, hi) - o) / d, far = (select(up, hi, lo) - o) / d;
        const Mask later = moves & (near > l.entry), sooner = moves & (far < l.exit);
        const Doubles first(low_part), second(low_part + 1.0);
        l.entry = select(later, near, l.entry);
        l.entry_part = select(later, select(up, first, second), l.entry_part);
        l.exit = select(sooner, far, l.exit);
        l.exit_part = select(sooner, select(up, second, first), l.exit_part);
        const std::uint32_t moving = bits_of(moves);
        left &= moving | bits_of((lo < o) & (o < hi));
        unsure |= moving & ~bits_of(is_finite(near) & is_finite(far));
    };
    cut(l.o.x, l.d.x, box.lo.x, box.hi.x, 1.0);
    cut(l.o.y, l.d.y, box.lo.y, box.hi.y, 3.0);
    cut(l.o.z, l.d.z, box.lo.z, box.hi.z, 5.0);
    return left & bits_of(l.entry < l.exit);
}

/// The rest of `clip_segment_by`, for the lanes in `left`: the ends of the segments. False when all
/// lanes miss.
HWY_INLINE bool end_points(const SolidFrame& frame, const RayLanes& rays, double size,
                           std::uint32_t left, Lines& l, PolynomialLanes& out, Point& p, Point& q) {
    left &= bits_of((l.exit >= load_lanes(rays.t_min)) & (l.entry <= load_lanes(rays.t_max)));
    out.missed = kAllLanes & ~left;
    if (left == 0) return false;
    const Point direction = load_point(rays.direction);
    const Doubles step = reach_of(direction);
    store_lanes(l.entry, out.entry);
    store_lanes(l.exit, out.exit);
    store_lanes(Doubles(0.0), out.shift);
    std::uint32_t far_off =
        left & bits_of(abs(l.entry) * step * Doubles(frame.stretch) > Doubles(16.0 * size));
    if (far_off != 0) {
        alignas(64) double origin[3][kRayLanes];
        store_point(l.from, origin);
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
        l.from = load_point(origin);
        l.o = times(frame.local_from_object, l.from);
    }
    const Doubles shift = load_lanes(out.shift);
    const Doubles begin = l.entry - shift, end = l.exit - shift;
    const Doubles relative =
        Doubles(6.0 * frame.stretch / size) *
        (reach_of(l.from) + Doubles(max_component(alhazen::abs(frame.origin))) +
         max_lanes(abs(begin), abs(end)) * step);
    store_lanes(relative, out.relative_error);
    store_point(l.o, out.o);
    store_point(l.d, out.d);
    store_lanes(l.entry_part, out.entry_part);
    store_lanes(l.exit_part, out.exit_part);
    p = {l.o.x + begin * l.d.x, l.o.y + begin * l.d.y, l.o.z + begin * l.d.z};
    q = {l.o.x + end * l.d.x, l.o.y + end * l.d.y, l.o.z + end * l.d.z};
    return true;
}

/// The degree: a constant where it is N <= 6.
template <int N>
HWY_INLINE int degree_of(const PolynomialLanes& lanes) {
    return N <= 6 ? N : lanes.degree;
}

/// Polynomials with coefficients times binomials: see ScaledPolynomial.
template <int N>
struct ScaledLanes {
    Doubles s[N + 1];
    int n;

    HWY_INLINE explicit ScaledLanes(const PolynomialLanes& lanes) : n(degree_of<N>(lanes)) {
        const double* row = bernstein::kBinomials<N>[static_cast<std::size_t>(n)].data();
        for (int i = 0; i <= n; ++i) s[i] = Doubles(row[i]) * load_lanes(lanes.b[i]);
    }
    HWY_INLINE void mirror(const Mask& mirrored) {
        for (int i = 0; i <= (n - 1) / 2; ++i) {
            const Doubles a = s[i], b = s[n - i];
            s[i] = select(mirrored, b, a);
            s[n - i] = select(mirrored, a, b);
        }
    }
    HWY_INLINE void operator()(const Doubles& w, Doubles& value, Doubles& slope) const {
        value = s[n];
        slope = Doubles(0.0);
        for (int i = n - 1; i >= 0; --i) {
            slope = slope * w + value;
            value = value * w + s[i];
        }
    }
};

/// Of lanes whose coefficients change their sign twice: those where a place between the changes is
/// found, as by `found_between`; it becomes `hi`.
template <int N>
HWY_INLINE std::uint32_t find_between(const PolynomialLanes& lanes, const Doubles& first,
                                      const Doubles& largest, Doubles& hi) {
    const int n = degree_of<N>(lanes);
    Doubles lowest(0.0), middle(0.5);
    for (int i = 1; i < n; ++i) {
        const Doubles value = first * load_lanes(lanes.b[i]);
        const Mask lower = value < lowest;
        lowest = select(lower, value, lowest);
        const double place = std::clamp(static_cast<int>(8.0 * i / n + 0.5), 1, 7) / 8.0;
        middle = select(lower, Doubles(place), middle);
    }
    const Mask mirrored = middle > Doubles(0.5);
    const Doubles rest = Doubles(1.0) - middle;
    const Doubles far = select(mirrored, middle, rest), near = select(mirrored, rest, middle);
    Doubles value, slope;
    ScaledLanes<N> q(lanes);
    q.mirror(mirrored);
    q(near / far, value, slope);
    Doubles scale(1.0);
    for (int i = 1; i <= n; ++i) scale = scale * far;
    const Doubles error = load_lanes(lanes.error) + Doubles(4.0 * n * 0x1p-52) * largest;
    hi = middle;
    return bits_of(-first * value * scale > error);
}

/// What the signs of the coefficients tell of the first crossing.
template <int N>
HWY_INLINE void classify(const RayLanes& rays, bool capped, PolynomialLanes& lanes) {
    const int n = degree_of<N>(lanes);
    const Doubles error = load_lanes(lanes.error), entry = load_lanes(lanes.entry);
    Doubles total = error, largest(0.0);
    Mask known = error >= Doubles(0.0);
    std::uint32_t negative = 0, starts_negative = 0;
    std::uint32_t one = 0, two = 0, three = 0;  // so many changes of sign and more
    for (int i = 0; i <= n; ++i) {
        const Doubles b = load_lanes(lanes.b[i]), size = abs(b);
        total = total + size;
        largest = max_lanes(largest, size);
        known = known & (size > error);
        const std::uint32_t now = bits_of(b < Doubles(0.0)), change = now ^ negative;
        negative = now;
        if (i == 0) {
            starts_negative = now;
            continue;
        }
        three |= two & change;
        two |= one & change;
        one |= change;
    }
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    const Mask finite = is_finite(total);
    // The parameter at the start of the search is the entry: +0 where that is -0, which is as good.
    const std::uint32_t covered = bits_of((t_min <= entry) & (entry <= t_max) & is_finite(entry));
    lanes.at_entry = 0;
    if (capped) {
        const Mask negative_start = load_lanes(lanes.b[0]) < Doubles(-2.0) * error;
        lanes.at_entry =
            ~(lanes.missed | lanes.unsure) & covered & bits_of(negative_start & finite);
    }
    const std::uint32_t plain =
        ~(lanes.missed | lanes.unsure | lanes.at_entry) & bits_of(known & finite);
    lanes.missed |= plain & ~one & ~starts_negative;
    // A cap at the start comes before what follows; after two changes the first may be behind.
    const std::uint32_t behind_cap = capped ? starts_negative & covered : 0;
    lanes.bracketed = plain & one & ~two & ~behind_cap;
    const Doubles first =
        select(load_lanes(lanes.b[0]) < Doubles(0.0), Doubles(-1.0), Doubles(1.0));
    Doubles hi(1.0);
    const std::uint32_t twice = plain & covered & two & ~three & ~(capped ? starts_negative : 0);
    if (twice != 0) {
        Doubles middle;
        const std::uint32_t found = twice & find_between<N>(lanes, first, largest, middle);
        store_lanes(middle, lanes.hi);
        for (std::uint32_t rest = ~found & kAllLanes; rest != 0; rest &= rest - 1) {
            lanes.hi[std::countr_zero(rest)] = 1.0;
        }
        hi = load_lanes(lanes.hi);
        lanes.bracketed |= found;
    }
    store_lanes(Doubles(0.0), lanes.lo);
    store_lanes(hi, lanes.hi);
    store_lanes(first, lanes.sign_lo);
}

/// As `restrict_to_segment`, with b already there.
HWY_INLINE void set_error(double magnitude, double roundings, PolynomialLanes& lanes) {
    store_lanes(
        Doubles(0x1p-53 * magnitude) *
            (Doubles(roundings) + Doubles(1.5 * lanes.degree) * load_lanes(lanes.relative_error)),
        lanes.error);
}

namespace formulas {

#include "alhazen/shapes/torus_formula-inl.h"

template <class Real>
HWY_INLINE Real constant_as(const DoubleDouble& c) {
    return Real(c.high);
}
HWY_INLINE Doubles divided(const Doubles& a, double by) {
    return a / Doubles(by);
}

#include "alhazen/shapes/restricted_polynomial-inl.h"

}  // namespace formulas

void torus(const Torus& shape, const RayLanes& rays, PolynomialLanes& lanes) {
    const double reach = kTorusRoom * (1.0 + shape.tube), height = kTorusRoom * shape.tube;
    lanes.unsure = lanes.at_entry = lanes.bracketed = 0;
    Lines lines = to_frame(shape.frame, rays);
    Point p, q;
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
    lanes.at_entry = lanes.bracketed = 0;
    const SolidFrame frame;
    Lines lines = to_frame(frame, rays);
    Point p, q;
    const std::uint32_t left = cut_by_box(shape.clip_box, lines, lanes.unsure);
    const bool any = end_points(frame, rays, shape.size, left, lines, lanes, p, q);
    // What is unsure is neither missed nor anything else.
    lanes.missed &= ~lanes.unsure;
    if (!any) return;
    const PolynomialExpression& polynomial = *shape.polynomial;
    // Room that is not set before it is used.
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

/// As `bracketed_newton`; what comes out of lanes that are not `wanted` is nothing.
template <int N>
HWY_INLINE Doubles newton(const ScaledLanes<N>& f, Doubles lo, Doubles hi, const Doubles& sign_lo,
                          const Doubles& guess, const Mask& wanted) {
    Doubles x = guess, result = guess;
    Doubles last_step = hi - lo;
    Mask running = wanted;
    Mask finishing = !(running | !running);
    for (int i = 0; i < 200; ++i) {
        Doubles value, slope;
        f(x, value, slope);
        Doubles next = x - value / slope;
        Mask within = (next >= lo) & (next <= hi);
        // The one more step of those that have come near.
        result = select(finishing, select(within, next, x), result);
        running = running & !finishing;
        const Mask positive = value > Doubles(0.0), differs = positive | (value < Doubles(0.0));
        const Mask nan = !(value >= value);
        const Mask at_root = running & !(differs | nan);
        result = select(at_root, x, result);
        running = running & !at_root;
        if (none(running)) return result;
        const Mask below = value * sign_lo > Doubles(0.0);
        lo = select(below, x, lo);
        hi = select(below, hi, x);
        const Doubles half = Doubles(0.5) * (lo + hi);
        within = (next >= lo) & (next <= hi);
        next = select(within, next, half);
        const Doubles step = abs(next - x);
        if (i > 2) next = select(step > Doubles(0.5) * last_step, half, next);
        const Mask fast = (step <= Doubles(1e-9) * abs(x)) & (step <= Doubles(1e-4) * last_step);
        last_step = abs(next - x);
        x = next;
        const Doubles size = abs(x);
        const Mask near = running & (fast | (last_step <= Doubles(0x1p-52) * size));
        const Mask done = (near & (last_step <= Doubles(0x1p-51) * size)) |
                          (running & !near & !(hi - lo > Doubles(0x1p-53) * hi));
        result = select(done, x, result);
        running = running & !done;
        finishing = near & running;
        if (none(running)) return result;
    }
    return select(running, x, result);
}

/// As `polish`.
template <int N>
HWY_INLINE Doubles polished(const PolynomialLanes& lanes, const Mask& wanted) {
    const Doubles half(0.5), unit(1.0);
    Doubles lo = load_lanes(lanes.lo), hi = load_lanes(lanes.hi);
    const Doubles sign_lo = load_lanes(lanes.sign_lo);
    const Mask across = (lo < half) & (hi > half);
    ScaledLanes<N> q(lanes);
    Doubles value, slope;
    if (!none(across & wanted)) {
        q(unit, value, slope);
        const Mask below = value * sign_lo > Doubles(0.0);
        lo = select(across & below, half, lo);
        hi = select(across & !below, half, hi);
    }
    const Mask mirrored = !(hi <= half);
    q.mirror(mirrored);
    const Doubles near = select(mirrored, unit - hi, lo), near_by = select(mirrored, hi, unit - lo);
    const Doubles far = select(mirrored, unit - lo, hi), far_by = select(mirrored, lo, unit - hi);
    const Doubles w_lo = near / near_by, w_hi = far / far_by;
    const Doubles sign = select(mirrored, -sign_lo, sign_lo);
    Doubles f_lo, f_hi;
    q(w_lo, f_lo, slope);
    f_lo = select(w_lo > Doubles(0.0), f_lo, q.s[0]);
    q(w_hi, f_hi, slope);
    Doubles guess = w_lo + (w_hi - w_lo) * (f_lo / (f_lo - f_hi));
    guess = select((guess >= w_lo) & (guess <= w_hi), guess, half * (w_lo + w_hi));
    const Doubles w = newton(q, w_lo, w_hi, sign, guess, wanted);
    return select(mirrored, unit, w) / (unit + w);
}

/// The slope at u, as `evaluate` has it.
template <int N>
HWY_INLINE Doubles slope_at(const PolynomialLanes& lanes, const Doubles& u) {
    const int n = degree_of<N>(lanes);
    const Doubles rest = Doubles(1.0) - u;
    Doubles row[N + 1];
    for (int i = 0; i <= n; ++i) row[i] = load_lanes(lanes.b[i]);
    for (int k = n; k > 1; --k) {
        for (int i = 0; i < k; ++i) row[i] = rest * row[i] + u * row[i + 1];
    }
    return Doubles(static_cast<double>(n)) * (row[1] - row[0]);
}

template <int N>
void refine_degree(const RayLanes& rays, PolynomialLanes& lanes) {
    const Doubles lo = load_lanes(lanes.lo), hi = load_lanes(lanes.hi);
    alignas(64) double flags[kRayLanes];
    for (std::size_t i = 0; i < kRayLanes; ++i) {
        flags[i] = static_cast<double>(lanes.bracketed >> i & 1);
    }
    Doubles u = polished<N>(lanes, load_lanes(flags) > Doubles(0.0));
    u = select(u < lo, lo, select(hi < u, hi, u));
    const Doubles entry = load_lanes(lanes.entry), exit = load_lanes(lanes.exit);
    const Doubles along = entry + u * (exit - entry);
    const Doubles t = select(exit < along, exit, along);
    Doubles largest(0.0);
    for (int i = 0; i <= degree_of<N>(lanes); ++i) {
        largest = max_lanes(largest, abs(load_lanes(lanes.b[i])));
    }
    const Mask steep = abs(slope_at<N>(lanes, u)) >= Doubles(kSteepEnough) * largest;
    const Mask covered = (load_lanes(rays.t_min) <= t) & (t <= load_lanes(rays.t_max));
    store_lanes(u, lanes.u);
    store_lanes(t, lanes.t);
    lanes.steep = bits_of(steep & covered & is_finite(t));
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

HWY_EXPORT(polynomial_kernels_of_target);

const PolynomialKernels& polynomial_kernels() {
    // Asked for every eight rays: what the processor can do is not looked up again.
    return HWY_DYNAMIC_DISPATCH(polynomial_kernels_of_target)();
}

}  // namespace alhazen
#endif
