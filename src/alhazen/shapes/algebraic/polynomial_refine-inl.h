/// Refines the roots in eight brackets of polynomials in Bernstein form, in lanes.
///
/// Source: math/bernstein_roots.h and shapes/algebraic/polynomial_solid.h, the same operations in
/// the same order.
/// Conventions: included once per target (see simd/lanes-inl.h); internal to this folder.

#if defined(ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_REFINE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_REFINE_INL_H_
#undef ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_REFINE_INL_H_
#else
#define ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_REFINE_INL_H_
#endif

#include "alhazen/shapes/algebraic/polynomial_roots-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// As `bracketed_newton`; the results of lanes that are not `wanted` are undefined.
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
        // One more step for the lanes that have converged.
        result = select_lanes(finishing, select_lanes(within, next, x), result);
        running = running & !finishing;
        const Mask positive = value > Doubles(0.0), differs = positive | (value < Doubles(0.0));
        const Mask nan = !(value >= value);
        const Mask at_root = running & !(differs | nan);
        result = select_lanes(at_root, x, result);
        running = running & !at_root;
        if (none(running)) return result;
        const Mask below = value * sign_lo > Doubles(0.0);
        lo = select_lanes(below, x, lo);
        hi = select_lanes(below, hi, x);
        const Doubles half = Doubles(0.5) * (lo + hi);
        within = (next >= lo) & (next <= hi);
        next = select_lanes(within, next, half);
        const Doubles step = abs(next - x);
        if (i > 2) next = select_lanes(step > Doubles(0.5) * last_step, half, next);
        const Mask fast = (step <= Doubles(1e-9) * abs(x)) & (step <= Doubles(1e-4) * last_step);
        last_step = abs(next - x);
        x = next;
        const Doubles size = abs(x);
        const Mask near = running & (fast | (last_step <= Doubles(0x1p-52) * size));
        const Mask done = (near & (last_step <= Doubles(0x1p-51) * size)) |
                          (running & !near & !(hi - lo > Doubles(0x1p-53) * hi));
        result = select_lanes(done, x, result);
        running = running & !done;
        finishing = near & running;
        if (none(running)) return result;
    }
    return select_lanes(running, x, result);
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
        lo = select_lanes(across & below, half, lo);
        hi = select_lanes(across & !below, half, hi);
    }
    const Mask mirrored = !(hi <= half);
    q.mirror(mirrored);
    const Doubles near = select_lanes(mirrored, unit - hi, lo),
                  near_by = select_lanes(mirrored, hi, unit - lo);
    const Doubles far = select_lanes(mirrored, unit - lo, hi),
                  far_by = select_lanes(mirrored, lo, unit - hi);
    const Doubles w_lo = near / near_by, w_hi = far / far_by;
    const Doubles sign = select_lanes(mirrored, -sign_lo, sign_lo);
    Doubles f_lo, f_hi;
    q(w_lo, f_lo, slope);
    f_lo = select_lanes(w_lo > Doubles(0.0), f_lo, q.s[0]);
    q(w_hi, f_hi, slope);
    Doubles guess = w_lo + (w_hi - w_lo) * (f_lo / (f_lo - f_hi));
    guess = select_lanes((guess >= w_lo) & (guess <= w_hi), guess, half * (w_lo + w_hi));
    const Doubles w = newton(q, w_lo, w_hi, sign, guess, wanted);
    return select_lanes(mirrored, unit, w) / (unit + w);
}

/// The slope at u, as computed by `evaluate`.
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
    Doubles u = polished<N>(lanes, lanes_of_bits<double>(lanes.bracketed));
    u = select_lanes(u < lo, lo, select_lanes(hi < u, hi, u));
    const Doubles t = parameter_at(lanes, u);
    Doubles largest(0.0);
    for (int i = 0; i <= degree_of<N>(lanes); ++i) {
        largest = max_lanes(largest, abs(load_lanes(lanes.b[i])));
    }
    const Mask steep = abs(slope_at<N>(lanes, u)) >= Doubles(kSteepEnough) * largest;
    const Mask covered = (load_lanes(rays.t_min) <= t) & (t <= load_lanes(rays.t_max));
    store_lanes(u, lanes.u);
    store_lanes(t, lanes.t);
    lanes.steep = bits_of(steep);
    lanes.covered = bits_of(covered & is_finite(t));
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
