#pragma once
/// Powers of double-double numbers (about 32 decimal digits) with any exponent.
///
/// Source: Hida, Li and Bailey, "Library for Double-Double and Quad-Double Arithmetic", 2008 (the
/// exponential by a series after halving, the logarithm by one step of Newton's method).
/// Differs: sums and doubles e^x - 1, so that halving costs no digits; integer exponents are
/// computed by multiplication.
/// Conventions: slow, for cases that double does not resolve; the power of a base that is not
/// positive is 0.

#include <array>
#include <cmath>
#include <limits>

#include "alhazen/math/double_double.h"

namespace alhazen {

/// e^a, to about 2^-98 relative, for a in [-700, 700]; 0 below, infinite above, NaN for NaN.
inline DoubleDouble exponential(const DoubleDouble& a) {
    constexpr DoubleDouble kLn2(0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56);
    if (a.high < -700.0) return {};
    if (!(a.high <= 700.0)) return DoubleDouble(a.high * std::numeric_limits<double>::infinity());
    const double k = std::nearbyint(a.high / kLn2.high);
    DoubleDouble x = a - DoubleDouble(k) * kLn2;
    x = {x.high * 0x1p-8, x.low * 0x1p-8};
    static const std::array<DoubleDouble, 11> kInverse = [] {
        std::array<DoubleDouble, 11> inverse{};
        for (std::size_t n = 1; n < inverse.size(); ++n) {
            inverse[n] = quotient(DoubleDouble(1.0), DoubleDouble(static_cast<double>(n)));
        }
        return inverse;
    }();
    DoubleDouble s(0.0);  // x + x^2 / 2! + x^3 / 3! + ...
    for (std::size_t n = 10; n >= 1; --n) s = x * kInverse[n] * (DoubleDouble(1.0) + s);
    for (int i = 0; i < 8; ++i) s = DoubleDouble(2.0) * s + s * s;
    s = s + DoubleDouble(1.0);
    const double scale = std::ldexp(1.0, static_cast<int>(k));
    return {s.high * scale, s.low * scale};
}

/// ln a, to about 2^-98 (absolute near 1). Precondition: a is in [1e-304, 1e304]; the result may be
/// NaN otherwise.
inline DoubleDouble logarithm(const DoubleDouble& a) {
    const double first = std::log(a.high);
    // a / e^first = 1 + rest; its logarithm is rest - rest^2 / 2 + ...
    const DoubleDouble rest = a * exponential(DoubleDouble(-first)) - DoubleDouble(1.0);
    return DoubleDouble(first) + (rest - DoubleDouble(0.5) * rest * rest);
}

/// base^exponent, to about 2^-97 (1 + exponent), for bases near 1 and below.
inline DoubleDouble power(const DoubleDouble& base, const DoubleDouble& exponent) {
    if (!(base.high > 0.0)) return {};
    if (exponent.low == 0.0 && exponent.high == std::floor(exponent.high) &&
        exponent.high <= 64.0) {
        DoubleDouble product(1.0), square = base;
        for (int n = static_cast<int>(exponent.high); n > 0; n /= 2) {
            if (n % 2 != 0) product = product * square;
            if (n > 1) square = square * square;
        }
        return product;
    }
    return exponential(exponent * logarithm(base));
}

}  // namespace alhazen
