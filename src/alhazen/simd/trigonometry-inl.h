/// Arc cosine, sine and cosine of eight lanes, with the bits of <cmath>.
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

/// Lanes of high + low; |low| is at most about 1/2 ulp of high.
struct Pairs {
    Doubles high, low;
};

/// The exact sum for |a| >= |b| in each lane.
HWY_INLINE Pairs fast_two_sum(const Doubles& a, const Doubles& b) {
    const Doubles sum = a + b;
    return {sum, b - (sum - a)};
}
HWY_INLINE Pairs two_sum(const Doubles& a, const Doubles& b) {
    const Doubles sum = a + b, b_virtual = sum - a;
    return {sum, (a - (sum - b_virtual)) + (b - b_virtual)};
}

/// The lanes whose rounding is certain: |low| is at least 1/32 ulp below a tie.
HWY_INLINE std::uint32_t lanes_rounded(const Pairs& x) {
    // At least 1 / (1 - 2 / 32): 1/2 - 1/32 ulp becomes 1/2 ulp.
    const Doubles with_margin = mul_add(x.low, Doubles(0x1.12p+0), x.high);
    return bits_of((with_margin <= x.high) & (with_margin >= x.high));
}

template <std::size_t N>
HWY_INLINE Doubles polynomial(const Doubles& x, const double (&coefficients)[N]) {
    Doubles sum(coefficients[N - 1]);
    for (std::size_t i = N - 1; i-- > 0;) sum = mul_add(sum, x, Doubles(coefficients[i]));
    return sum;
}

/// The product with the constant `constant` + `constant_low`.
HWY_INLINE Pairs product(const Pairs& x, double constant, double constant_low) {
    const Doubles c(constant), high = x.high * c;
    return {high,
            mul_add(x.low, c, mul_add(x.high, Doubles(constant_low), mul_sub(x.high, c, high)))};
}
HWY_INLINE Pairs square(const Pairs& x) {
    const Doubles high = x.high * x.high;
    return {high, mul_add(x.high + x.high, x.low, mul_sub(x.high, x.high, high))};
}

/// y (1 + first + second + rest), in order of decreasing magnitude; the terms after `first` are
/// added without compensation.
HWY_INLINE Pairs odd_function(const Pairs& y, const Pairs& first, const Pairs& second,
                              const Doubles& rest) {
    const Pairs sum = fast_two_sum(Doubles(1.0), first.high);
    const Doubles low = sum.low + (second.high + (second.low + first.low + rest));
    const Doubles product = y.high * sum.high;
    return {product,
            mul_add(y.high, low, mul_add(y.low, sum.high, mul_sub(y.high, sum.high, product)))};
}

/// Sets the lanes of `value` that are not in `known` to f of the lanes of `x`.
template <class F>
HWY_INLINE void call_libm(std::uint32_t known, const Doubles& x, Doubles& value, F&& f) {
    if (known == kAllLanes) return;
    HWY_ALIGN double in[kLaneCount], out[kLaneCount];
    store_lanes(x, in);
    store_lanes(value, out);
    for (std::uint32_t left = ~known & kAllLanes; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        out[i] = f(in[i]);
    }
    value = load_lanes(out);
}

/// Sets `value` to the arc cosines of `x` in [-1, 1]; returns the lanes that are certain.
HWY_INLINE std::uint32_t find_acos(const Doubles& x, Doubles& value) {
    if constexpr (kFusesExactly) {
        static constexpr double kRest[] = {
            0x1.6db6db6db6e53p-5, 0x1.f1c71c71b35f6p-6, 0x1.6e8ba2f094655p-6, 0x1.1c4ec34c36091p-6,
            0x1.c99a006f82965p-7, 0x1.7a7f54c0d5f42p-7, 0x1.404f481b3686fp-7, 0x1.0eba461a2c9c9p-7,
            0x1.0b94d31c8181fp-7, 0x1.4b700d9dd8936p-9, 0x1.23291da97be2fp-6, -0x1.230cab6b32200p-6,
            0x1.bb8cd3a934fc8p-6};
        // |x| > 1/2: acos(x) = 2 asin(sqrt((1 - x) / 2)); else pi / 2 - asin(x).
        const Doubles size = abs(x), half = (Doubles(1.0) - size) * Doubles(0.5);
        const LaneMask<double> outer = size > Doubles(0.5), right = x > Doubles(0.0);
        const Doubles root = sqrt(half);
        const Doubles rest =
            neg_mul_add(root, root, half) / max_lanes(root + root, Doubles(0x1p-500));
        const Doubles two = select_lanes(right, Doubles(-2.0), Doubles(2.0));
        const Pairs y{select_lanes(outer, two * root, x),
                      select_lanes(outer, two * rest, Doubles(0.0))};
        const Pairs own = square({x, Doubles(0.0)});
        const Pairs z{select_lanes(outer, half, own.high),
                      select_lanes(outer, Doubles(0.0), own.low)};
        const Pairs zz = square(z);
        // The amount to be subtracted from 0, pi / 2 or pi.
        const Pairs taken = odd_function(y, product(z, 0x1.5555555555555p-3, 0x1.5555555555555p-57),
                                         product(zz, 0x1.3333333333333p-4, 0x1.999999999999ap-59),
                                         zz.high * z.high * polynomial(z.high, kRest));
        const Doubles whole = select_lanes(right, Doubles(0.0), Doubles(0x1.921fb54442d18p+1));
        const Doubles whole_low = select_lanes(right, Doubles(0.0), Doubles(0x1.1a62633145c07p-53));
        const Doubles from = select_lanes(outer, whole, Doubles(0x1.921fb54442d18p+0));
        const Doubles from_low = select_lanes(outer, whole_low, Doubles(0x1.1a62633145c07p-54));
        const Pairs sum = fast_two_sum(from, -taken.high);
        const Pairs result = fast_two_sum(sum.high, sum.low + (from_low - taken.low));
        value = result.high;
        return lanes_rounded(result);
    }
    value = x;
    return 0;
}

}  // namespace trigonometry

/// std::acos of each lane of four blocks, in [-1, 1].
HWY_INLINE void acos_of_lanes(const Doubles (&x)[4], Doubles (&value)[4]) {
    using namespace trigonometry;
    std::uint32_t unknown = 0;
    for (int i = 0; i < 4; ++i) unknown |= (~find_acos(x[i], value[i]) & kAllLanes) << (8 * i);
    if (unknown == 0) return;
    HWY_ALIGN double in[4][kLaneCount], out[4][kLaneCount];
    for (int i = 0; i < 4; ++i) {
        store_lanes(x[i], in[i]);
        store_lanes(value[i], out[i]);
    }
    for (; unknown != 0; unknown &= unknown - 1) {
        const int i = std::countr_zero(unknown);
        out[i / 8][i % 8] = std::acos(in[i / 8][i % 8]);
    }
    for (int i = 0; i < 4; ++i) value[i] = load_lanes(out[i]);
}

struct SineCosine {
    Doubles sine, cosine;
};

/// std::sin and std::cos of each lane, in [0, 7].
HWY_INLINE SineCosine sine_cosine_of_lanes(const Doubles& x) {
    using namespace trigonometry;
    SineCosine value{x, x};
    std::uint32_t sine_known = 0, cosine_known = 0;
    if constexpr (kFusesExactly) {
        static constexpr double kSine[] = {-0x1.a01a01a019ed4p-13, 0x1.71de3a550c541p-19,
                                           -0x1.ae6455332472dp-26, 0x1.61225a315314fp-33,
                                           -0x1.ab933c1a644cdp-41};
        static constexpr double kCosine[] = {-0x1.6c16c16c16c16p-10, 0x1.a01a01a019d06p-16,
                                             -0x1.27e4fb77125c5p-22, 0x1.1eed8deac3dfep-29,
                                             -0x1.9394b8bd50ae1p-37, 0x1.ab779550c8d45p-45};
        // Added and subtracted, it rounds to whole numbers.
        const Doubles rounder(0x1.8p+52);
        const Doubles quarter = mul_add(x, Doubles(0x1.45f306dc9c883p-1), rounder) - rounder;
        const Doubles near = neg_mul_add(quarter, Doubles(0x1.921fb54442d18p+0), x);
        const Pairs r = two_sum(near, -(quarter * Doubles(0x1.1a62633145c07p-54)));
        const Pairs z = square(r), zz = square(z);
        const Doubles cube = zz.high * z.high;
        const Pairs s = odd_function(r, product(z, -0x1.5555555555555p-3, -0x1.5555555555555p-57),
                                     product(zz, 0x1.1111111111111p-7, 0x1.1111111111111p-63),
                                     cube * polynomial(z.high, kSine));
        // The cosine: 1 - z / 2 + zz / 24 + ...
        const Pairs one_less = fast_two_sum(Doubles(1.0), Doubles(-0.5) * z.high);
        const Pairs term = product(zz, 0x1.5555555555555p-5, 0x1.5555555555555p-59);
        const Doubles c_low = mul_add(Doubles(-0.5), z.low, one_less.low) +
                              (term.high + mul_add(cube, polynomial(z.high, kCosine), term.low));
        const Pairs sine = fast_two_sum(s.high, s.low), cosine = fast_two_sum(one_less.high, c_low);
        // Quarters 1 and 3 swap the functions; the sine is negative in 2 and 3, the cosine in 1
        // and 2.
        const auto within = [&](double low, double high) {
            return (quarter > Doubles(low)) & (quarter < Doubles(high));
        };
        const LaneMask<double> other = within(0.5, 1.5) | within(2.5, 3.5);
        const auto signed_by = [](const LaneMask<double>& negative, const Doubles& of) {
            return select_lanes(negative, -of, of);
        };
        value.sine = signed_by(within(1.5, 3.5), select_lanes(other, cosine.high, sine.high));
        value.cosine = signed_by(within(0.5, 2.5), select_lanes(other, sine.high, cosine.high));
        // Nearer to a multiple of pi / 2 the reduced argument has too few digits.
        const std::uint32_t others = bits_of(other);
        const std::uint32_t sane =
            bits_of((abs(near) > Doubles(0x1p-20)) | (quarter < Doubles(0.5)));
        const std::uint32_t s_known = lanes_rounded(sine) & sane;
        const std::uint32_t c_known = lanes_rounded(cosine) & sane;
        sine_known = (others & c_known) | (~others & s_known);
        cosine_known = (others & s_known) | (~others & c_known);
    }
    call_libm(sine_known & kAllLanes, x, value.sine, [](double lane) { return std::sin(lane); });
    call_libm(cosine_known & kAllLanes, x, value.cosine,
              [](double lane) { return std::cos(lane); });
    return value;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
