/// Arc cosine and tangent, sine and cosine of lanes, with the bits of <cmath>.
///
/// Each lane is computed to about 60 bits. If these determine the rounding to 53 bits with a margin
/// of 1/32 ulp, the rounded value is the result. Assumption: the library's error is at most 0.53
/// ulp, so that it rounds the same way (largest known error of glibc: 0.523 ulp; Zimmermann and
/// others, "Accuracy of Mathematical Functions in Single, Double, Double Extended, and Quadruple
/// Precision", 2024). All other lanes, about a sixteenth, call the library.
///
/// Source: Ziv, "Fast Evaluation of Elementary Mathematical Functions with Correctly Rounded Last
/// Bit", ACM TOMS 17(3), 1991 (the test of the rounding); Cody and Waite, "Software Manual for the
/// Elementary Functions", 1980 (the reductions). Coefficients: interpolation at Chebyshev's points.
/// Conventions: those of lanes-inl.h.

#if defined(ALHAZEN_SIMD_TRIGONOMETRY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SIMD_TRIGONOMETRY_INL_H_
#undef ALHAZEN_SIMD_TRIGONOMETRY_INL_H_
#else
#define ALHAZEN_SIMD_TRIGONOMETRY_INL_H_
#endif

#include <bit>
#include <cmath>

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace trigonometry {

template <std::size_t N>
inline constexpr std::uint32_t kAll = (1u << N) - 1;

/// Lanes of high + low; |low| is at most about 1/2 ulp of high.
template <std::size_t N>
struct Pairs {
    Lanes<double, N> high, low;
};

/// The exact sum for |a| >= |b| in each lane.
template <std::size_t N>
HWY_INLINE Pairs<N> fast_two_sum(const Lanes<double, N>& a, const Lanes<double, N>& b) {
    const Lanes<double, N> sum = a + b;
    return {sum, b - (sum - a)};
}
template <std::size_t N>
HWY_INLINE Pairs<N> two_sum(const Lanes<double, N>& a, const Lanes<double, N>& b) {
    const Lanes<double, N> sum = a + b, b_virtual = sum - a;
    return {sum, (a - (sum - b_virtual)) + (b - b_virtual)};
}

/// The lanes whose rounding is certain: |low| is at least 1/32 ulp below a tie.
template <std::size_t N>
HWY_INLINE std::uint32_t lanes_rounded(const Pairs<N>& x) {
    // At least 1 / (1 - 2 / 32): 1/2 - 1/32 ulp becomes 1/2 ulp.
    const Lanes<double, N> with_margin = mul_add(x.low, Lanes<double, N>(0x1.12p+0), x.high);
    return bits_of((with_margin <= x.high) & (with_margin >= x.high));
}

/// Even and odd powers apart: half as many steps depend on each other.
template <std::size_t N, std::size_t kCount>
HWY_INLINE Lanes<double, N> polynomial(const Lanes<double, N>& x,
                                       const double (&coefficients)[kCount]) {
    using D = Lanes<double, N>;
    const D squared = x * x;
    D last(coefficients[kCount - 1]), other(coefficients[kCount - 2]);
    ALHAZEN_UNROLL
    for (std::size_t i = kCount - 2; i-- > 0;) {
        const D next = mul_add(last, squared, D(coefficients[i]));
        last = other;
        other = next;
    }
    return mul_add(last, x, other);
}

/// The product with the constant `constant` + `constant_low`.
template <std::size_t N>
HWY_INLINE Pairs<N> product(const Pairs<N>& x, double constant, double constant_low) {
    const Lanes<double, N> c(constant), c_low(constant_low), high = x.high * c;
    return {high, mul_add(x.low, c, mul_add(x.high, c_low, mul_sub(x.high, c, high)))};
}
template <std::size_t N>
HWY_INLINE Pairs<N> square(const Pairs<N>& x) {
    const Lanes<double, N> high = x.high * x.high;
    return {high, mul_add(x.high + x.high, x.low, mul_sub(x.high, x.high, high))};
}

/// y (1 + first + second + rest), in order of decreasing magnitude; the terms after `first` are
/// added without compensation.
template <std::size_t N>
HWY_INLINE Pairs<N> odd_function(const Pairs<N>& y, const Pairs<N>& first, const Pairs<N>& second,
                                 const Lanes<double, N>& rest) {
    using D = Lanes<double, N>;
    const Pairs<N> sum = fast_two_sum(D(1.0), first.high);
    const D low = sum.low + (second.high + (second.low + first.low + rest));
    const D product = y.high * sum.high;
    return {product,
            mul_add(y.high, low, mul_add(y.low, sum.high, mul_sub(y.high, sum.high, product)))};
}

/// Sets the lanes of `value` that are not in `known` to f of the lanes of `x`.
template <std::size_t N, class F>
HWY_INLINE void call_libm(std::uint32_t known, const Lanes<double, N>& x, Lanes<double, N>& value,
                          F&& f) {
    if (known == kAll<N>) return;
    HWY_ALIGN double in[N], out[N];
    store_lanes(x, in);
    store_lanes(value, out);
    for (std::uint32_t left = ~known & kAll<N>; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        out[i] = f(in[i]);
    }
    value = load_lanes<N>(out);
}

/// Sets `value` to the arc cosines of `x` in [-1, 1]; returns the lanes that are certain.
template <std::size_t N>
HWY_INLINE std::uint32_t find_acos(const Lanes<double, N>& x, Lanes<double, N>& value) {
    using D = Lanes<double, N>;
    if constexpr (kFusesExactly) {
        static constexpr double kRest[] = {
            0x1.6db6db6db6e53p-5, 0x1.f1c71c71b35f6p-6, 0x1.6e8ba2f094655p-6, 0x1.1c4ec34c36091p-6,
            0x1.c99a006f82965p-7, 0x1.7a7f54c0d5f42p-7, 0x1.404f481b3686fp-7, 0x1.0eba461a2c9c9p-7,
            0x1.0b94d31c8181fp-7, 0x1.4b700d9dd8936p-9, 0x1.23291da97be2fp-6, -0x1.230cab6b32200p-6,
            0x1.bb8cd3a934fc8p-6};
        // |x| > 1/2: acos(x) = 2 asin(sqrt((1 - x) / 2)); else pi / 2 - asin(x).
        const D size = abs(x), half = (D(1.0) - size) * D(0.5);
        const LaneMask<double, N> outer = size > D(0.5), right = x > D(0.0);
        const D root = sqrt(half);
        const D rest = neg_mul_add(root, root, half) / max_lanes(root + root, D(0x1p-500));
        const D two = select_lanes(right, D(-2.0), D(2.0));
        const Pairs<N> y{select_lanes(outer, two * root, x),
                         select_lanes(outer, two * rest, D(0.0))};
        const Pairs<N> own = square(Pairs<N>{x, D(0.0)});
        const Pairs<N> z{select_lanes(outer, half, own.high), select_lanes(outer, D(0.0), own.low)};
        const Pairs<N> zz = square(z);
        // The amount to be subtracted from 0, pi / 2 or pi.
        const Pairs<N> taken =
            odd_function(y, product(z, 0x1.5555555555555p-3, 0x1.5555555555555p-57),
                         product(zz, 0x1.3333333333333p-4, 0x1.999999999999ap-59),
                         zz.high * z.high * polynomial(z.high, kRest));
        const D whole = select_lanes(right, D(0.0), D(0x1.921fb54442d18p+1));
        const D whole_low = select_lanes(right, D(0.0), D(0x1.1a62633145c07p-53));
        const D from = select_lanes(outer, whole, D(0x1.921fb54442d18p+0));
        const D from_low = select_lanes(outer, whole_low, D(0x1.1a62633145c07p-54));
        const Pairs<N> sum = fast_two_sum(from, -taken.high);
        const Pairs<N> result = fast_two_sum(sum.high, sum.low + (from_low - taken.low));
        value = result.high;
        return lanes_rounded(result);
    }
    value = x;
    return 0;
}

/// Sets `value` to the arc tangents of y / x in the quadrant of (x, y); returns the lanes that are
/// certain.
template <std::size_t N>
HWY_INLINE std::uint32_t find_atan2(const Lanes<double, N>& y, const Lanes<double, N>& x,
                                    Lanes<double, N>& value) {
    using D = Lanes<double, N>;
    if constexpr (kFusesExactly) {
        // Of k / 4.
        static constexpr double kArcs[] = {0x1.f5b75f92c80ddp-3, 0x1.dac670561bb4fp-2,
                                           0x1.4978fa3269ee1p-1, 0x1.921fb54442d18p-1};
        static constexpr double kLowArcs[] = {0x1.8ab6e3cf7afbdp-57, 0x1.a2b7f222f65e2p-56,
                                              0x1.2419a87f2a458p-56, 0x1.1a62633145c07p-55};
        static constexpr double kRest[] = {-0x1.2492492492483p-3, 0x1.c71c71c6fa6b8p-4,
                                           -0x1.745d16e59486dp-4, 0x1.3b134d91ad47ap-4,
                                           -0x1.10e252e3a3a18p-4, 0x1.cd940859136a4p-5};
        const D zero(0.0), size_x = abs(x), size_y = abs(y);
        const LaneMask<double, N> steep = size_y > size_x, left = x < zero;
        const D n = select_lanes(steep, size_x, size_y), d = select_lanes(steep, size_y, size_x);
        // With c the nearest quarter to n / d: atan(n / d) = atan(c) + atan(t), where
        // t = (n - c d) / (d + c n) is at most 1/8.
        D c(0.0), arc(0.0), arc_low(0.0);
        for (int k = 0; k < 4; ++k) {
            const LaneMask<double, N> beyond = n > D(0.125 + 0.25 * k) * d;
            c = select_lanes(beyond, D(0.25 * (k + 1)), c);
            arc = select_lanes(beyond, D(kArcs[k]), arc);
            arc_low = select_lanes(beyond, D(kLowArcs[k]), arc_low);
        }
        const D cd = c * d, cn = c * n;
        const Pairs<N> above = two_sum(n, -cd), below = fast_two_sum(d, cn);
        const D above_low = above.low - mul_sub(c, d, cd);
        const D below_low = below.low + mul_sub(c, n, cn);
        const D ratio = above.high / below.high;
        const D rest = neg_mul_add(ratio, below.high, above.high) + above_low;
        const Pairs<N> t = fast_two_sum(ratio, neg_mul_add(ratio, below_low, rest) / below.high);
        const Pairs<N> z = square(t), zz = square(z);
        const Pairs<N> own =
            odd_function(t, product(z, -0x1.5555555555555p-2, -0x1.5555555555555p-56),
                         product(zz, 0x1.999999999999ap-3, -0x1.999999999999ap-57),
                         zz.high * z.high * polynomial(z.high, kRest));
        const Pairs<N> sum = fast_two_sum(arc, own.high);
        const D low = sum.low + (own.low + arc_low);
        // Steep: pi / 2 -+ the angle; else, on the left, pi - the angle.
        const D half_turn = select_lanes(left, D(0x1.921fb54442d18p+1), zero);
        const D half_turn_low = select_lanes(left, D(0x1.1a62633145c07p-53), zero);
        const D from = select_lanes(steep, D(0x1.921fb54442d18p+0), half_turn);
        const D from_low = select_lanes(steep, D(0x1.1a62633145c07p-54), half_turn_low);
        const LaneMask<double, N> turned = (steep & !left) | (left & !steep);
        const Pairs<N> whole = fast_two_sum(from, select_lanes(turned, -sum.high, sum.high));
        const Pairs<N> result =
            fast_two_sum(whole.high, whole.low + (from_low + select_lanes(turned, -low, low)));
        value = copysign(result.high, y);
        const LaneMask<double, N> sane =
            (d > D(0x1p-400)) & (d < D(0x1p+400)) & ((n > D(0x1p-400)) | (n <= zero));
        return lanes_rounded(result) & bits_of(sane);
    }
    value = x;
    return 0;
}

}  // namespace trigonometry

/// std::acos of each lane of four blocks, in [-1, 1].
template <std::size_t N>
HWY_INLINE void acos_of_lanes(const Lanes<double, N> (&x)[4], Lanes<double, N> (&value)[4]) {
    using namespace trigonometry;
    std::uint64_t unknown = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        unknown |= std::uint64_t{~find_acos(x[i], value[i]) & kAll<N>} << (N * i);
    }
    if (unknown == 0) return;
    HWY_ALIGN double in[4 * N], out[4 * N];
    for (std::size_t i = 0; i < 4; ++i) {
        store_lanes(x[i], in + N * i);
        store_lanes(value[i], out + N * i);
    }
    for (; unknown != 0; unknown &= unknown - 1) {
        const int i = std::countr_zero(unknown);
        out[i] = std::acos(in[i]);
    }
    for (std::size_t i = 0; i < 4; ++i) value[i] = load_lanes<N>(out + N * i);
}

/// std::atan2(y, x) of each lane.
template <std::size_t N>
HWY_INLINE Lanes<double, N> atan2_of_lanes(const Lanes<double, N>& y, const Lanes<double, N>& x) {
    using namespace trigonometry;
    Lanes<double, N> value;
    const std::uint32_t known = find_atan2(y, x, value);
    if (known == kAll<N>) return value;
    HWY_ALIGN double in_y[N], in_x[N], out[N];
    store_lanes(y, in_y);
    store_lanes(x, in_x);
    store_lanes(value, out);
    for (std::uint32_t left = ~known & kAll<N>; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        out[i] = std::atan2(in_y[i], in_x[i]);
    }
    return load_lanes<N>(out);
}

template <std::size_t N>
struct SineCosine {
    Lanes<double, N> sine, cosine;
};

/// std::sin and std::cos of each lane, in [0, 7].
template <std::size_t N>
HWY_INLINE SineCosine<N> sine_cosine_of_lanes(const Lanes<double, N>& x) {
    using namespace trigonometry;
    using D = Lanes<double, N>;
    SineCosine<N> value{x, x};
    std::uint32_t sine_known = 0, cosine_known = 0;
    if constexpr (kFusesExactly) {
        static constexpr double kSine[] = {-0x1.a01a01a019ed4p-13, 0x1.71de3a550c541p-19,
                                           -0x1.ae6455332472dp-26, 0x1.61225a315314fp-33,
                                           -0x1.ab933c1a644cdp-41};
        static constexpr double kCosine[] = {-0x1.6c16c16c16c16p-10, 0x1.a01a01a019d06p-16,
                                             -0x1.27e4fb77125c5p-22, 0x1.1eed8deac3dfep-29,
                                             -0x1.9394b8bd50ae1p-37, 0x1.ab779550c8d45p-45};
        // Added and subtracted, it rounds to whole numbers.
        const D rounder(0x1.8p+52);
        const D quarter = mul_add(x, D(0x1.45f306dc9c883p-1), rounder) - rounder;
        const D near = neg_mul_add(quarter, D(0x1.921fb54442d18p+0), x);
        const Pairs<N> r = two_sum(near, -(quarter * D(0x1.1a62633145c07p-54)));
        const Pairs<N> z = square(r), zz = square(z);
        const D cube = zz.high * z.high;
        const Pairs<N> s =
            odd_function(r, product(z, -0x1.5555555555555p-3, -0x1.5555555555555p-57),
                         product(zz, 0x1.1111111111111p-7, 0x1.1111111111111p-63),
                         cube * polynomial(z.high, kSine));
        // The cosine: 1 - z / 2 + zz / 24 + ...
        const Pairs<N> one_less = fast_two_sum(D(1.0), D(-0.5) * z.high);
        const Pairs<N> term = product(zz, 0x1.5555555555555p-5, 0x1.5555555555555p-59);
        const D c_low = mul_add(D(-0.5), z.low, one_less.low) +
                        (term.high + mul_add(cube, polynomial(z.high, kCosine), term.low));
        const Pairs<N> sine = fast_two_sum(s.high, s.low),
                       cosine = fast_two_sum(one_less.high, c_low);
        // Quarters 1 and 3 swap the functions; the sine is negative in 2 and 3, the cosine in 1
        // and 2.
        const auto within = [&](double low, double high) {
            return (quarter > D(low)) & (quarter < D(high));
        };
        const LaneMask<double, N> other = within(0.5, 1.5) | within(2.5, 3.5);
        const auto signed_by = [](const LaneMask<double, N>& negative, const D& of) {
            return select_lanes(negative, -of, of);
        };
        value.sine = signed_by(within(1.5, 3.5), select_lanes(other, cosine.high, sine.high));
        value.cosine = signed_by(within(0.5, 2.5), select_lanes(other, sine.high, cosine.high));
        // Nearer to a multiple of pi / 2 the reduced argument has too few digits.
        const std::uint32_t others = bits_of(other);
        const std::uint32_t sane = bits_of((abs(near) > D(0x1p-20)) | (quarter < D(0.5)));
        const std::uint32_t s_known = lanes_rounded(sine) & sane;
        const std::uint32_t c_known = lanes_rounded(cosine) & sane;
        sine_known = (others & c_known) | (~others & s_known);
        cosine_known = (others & s_known) | (~others & c_known);
    }
    call_libm(sine_known & kAll<N>, x, value.sine, [](double lane) { return std::sin(lane); });
    call_libm(cosine_known & kAll<N>, x, value.cosine, [](double lane) { return std::cos(lane); });
    return value;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
