#pragma once
/// Angles, and points of the unit circle, by polynomials: for formulas that are also evaluated in
/// lanes and whose own rounding errors are larger. Errors: below 3 ulp of the angle, and 1 ulp of 1
/// of a coordinate.
///
/// Source: Cody and Waite, "Software Manual for the Elementary Functions", 1980 (the reductions).
/// Coefficients: interpolation at Chebyshev's points.
/// Conventions: no operation is fused, so the bits are the same on every machine and in the lanes
/// of simd/angles-inl.h. NaN gives NaN.

#include <cmath>
#include <cstddef>

#include "alhazen/math/constants.h"
#include "alhazen/math/vec.h"

namespace alhazen {

namespace angles {

/// tan(pi / 8): half of the octant.
inline constexpr double kHalfOctant = 0x1.a827999fcef32p-2;
/// (atan(t) / t - 1) / t^2 of z = t^2 for |t| up to kHalfOctant, to 3.2e-17.
inline constexpr double kArc[] = {
    -0x1.5555555555555p-2, 0x1.999999999934cp-3, -0x1.2492492436201p-3, 0x1.c71c71853d7c8p-4,
    -0x1.745d0b28a7649p-4, 0x1.3b12630643e8ap-4, -0x1.10fa77b104ae8p-4, 0x1.dfe6497394f40p-5,
    -0x1.a0999c2994d42p-5, 0x1.4162bf84bf0bfp-5, -0x1.3a31b0297d745p-6};
/// (sin(t) / t - 1) / t^2 and (cos(t) - 1 + t^2 / 2) / t^4 of t^2 for |t| up to pi / 4, to 2.1e-17.
inline constexpr double kSine[] = {-0x1.5555555555555p-3,  0x1.1111111110bb2p-7,
                                   -0x1.a01a019e83aaep-13, 0x1.71de37968a024p-19,
                                   -0x1.ae600b02a7c74p-26, 0x1.5e0b19f38405ap-33};
inline constexpr double kCosine[] = {0x1.5555555555555p-5,  -0x1.6c16c16c16967p-10,
                                     0x1.a01a019f4eb01p-16, -0x1.27e4fa17da09ep-22,
                                     0x1.1eeb68e93b64cp-29, -0x1.907da367a37cbp-37};
/// pi / 2 as a sum; products of the first part with whole numbers up to 4 are exact.
inline constexpr double kQuarter = 0x1.921fb54442000p+0, kQuarterRest = 0x1.a308d313198a3p-41;
/// Added and subtracted, it rounds to whole numbers.
inline constexpr double kRounder = 0x1.8p+52;
/// The smallest normal number.
inline constexpr double kTiny = 0x1p-1022;

/// The coefficients kFirst, kFirst + 2, ... times powers of `squared`.
template <std::size_t kFirst, std::size_t N>
[[nodiscard]] constexpr double every_second(double squared, const double (&coefficients)[N]) {
    if constexpr (kFirst + 2 >= N) {
        return coefficients[kFirst];
    } else {
        return every_second<kFirst + 2>(squared, coefficients) * squared + coefficients[kFirst];
    }
}
/// Even and odd powers apart: half as many steps depend on each other.
template <std::size_t N>
[[nodiscard]] constexpr double polynomial(double x, const double (&coefficients)[N]) {
    return every_second<1>(x * x, coefficients) * x + every_second<0>(x * x, coefficients);
}

/// The point of the unit circle at `quarter` right angles and `t`; |t| up to pi / 4.
[[nodiscard]] inline Vec2 direction_beside(double quarter, double t) {
    const double z = t * t;
    const double sine = t + t * (z * polynomial(z, kSine));
    const double cosine = (1.0 - 0.5 * z) + z * z * polynomial(z, kCosine);
    const auto within = [&](double low, double high) { return quarter > low && quarter < high; };
    const bool odd = within(0.5, 1.5) || within(2.5, 3.5);
    const double s = odd ? cosine : sine, c = odd ? sine : cosine;
    return {within(0.5, 2.5) ? -c : c, within(1.5, 3.5) ? -s : s};
}

}  // namespace angles

/// The angle in [0, pi] between the axis x and (x, y); for y >= 0 that of std::atan2. The larger of
/// |x| and |y| is 0, and then the angle is 0, or from 2^-1022 to 2^1022.
[[nodiscard]] inline double angle_from_axis(double y, double x) {
    using namespace angles;
    const double size_y = std::abs(y), size_x = std::abs(x);
    const bool steep = size_y > size_x;
    const double low = steep ? size_x : size_y, high = steep ? size_y : size_x;
    const bool outer = low > kHalfOctant * high;
    const double usable = high < kTiny ? kTiny : high;
    const double t = (outer ? low - high : low) / (outer ? low + high : usable), z = t * t;
    const double arc = t + t * (z * polynomial(z, kArc));
    const double in_octant = outer ? 0.25 * kPi + arc : arc;
    const double in_quarter = steep ? 0.5 * kPi - in_octant : in_octant;
    return x < 0.0 ? kPi - in_quarter : in_quarter;
}

/// The point of the unit circle at an angle in [0, 7]: its cosine and sine.
[[nodiscard]] inline Vec2 direction_at(double angle) {
    using namespace angles;
    const double quarter = (angle * (2.0 / kPi) + kRounder) - kRounder;
    return direction_beside(quarter, (angle - quarter * kQuarter) - quarter * kQuarterRest);
}

/// The point of the unit circle after `turns` in [0, 1] whole turns. The reduction is exact.
[[nodiscard]] inline Vec2 direction_after(double turns) {
    using namespace angles;
    const double quarters = 4.0 * turns, quarter = (quarters + kRounder) - kRounder;
    return direction_beside(quarter, (0.5 * kPi) * (quarters - quarter));
}

}  // namespace alhazen
