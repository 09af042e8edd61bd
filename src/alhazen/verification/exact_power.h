#pragma once
/// Powers with non-integer exponents, for any number type.
///
/// Source: Brent and Zimmermann, "Modern Computer Arithmetic", 2010, 4.2 and 4.4 (the series of the
/// exponential after halving its argument; Newton's method for the logarithm, here of third order).

#include <array>
#include <cmath>
#include <type_traits>

#include "alhazen/math/real128.h"

namespace alhazen {

/// e^x for |x| < 700, accurate to a few last bits of 113.
template <class R>
R exponential(const R& x) {
    constexpr int kTerms = 14;
    static const std::array<R, kTerms + 1> parts = [] {
        std::array<R, kTerms + 1> p{};
        for (int n = 1; n <= kTerms; ++n) p[n] = R(1) / n;
        return p;
    }();
    const R ln2 = R(0x1.62e42fefa39efp-1) + R(0x1.abc9e3b39803fp-56) + R(0x1.7b57a079a1934p-111);
    const double k = std::nearbyint(static_cast<double>(x) / 0.6931471805599453);
    const R small = (x - R(k) * ln2) * R(0x1p-8);
    R s = 0;  // e^small - 1
    for (int n = kTerms; n >= 1; --n) s = small * (1 + s) * parts[n];
    for (int i = 0; i < 8; ++i) s = s * (2 + s);
    return (1 + s) * R(std::ldexp(1.0, static_cast<int>(k)));
}

/// The natural logarithm of a number within the range of double.
template <class R>
R logarithm(const R& x) {
    // The logarithm in double, plus that of the remaining factor: r is about 1e-16.
    const R start = std::log(static_cast<double>(x));
    const R r = x * exponential(R(-start)) - 1;
    return start + r * (1 - r * (R(1) / 2 - r * (R(1) / 3)));
}

/// x^p for x >= 0 and p > 0.
template <class R>
R power_of(const R& x, const std::type_identity_t<R>& p) {
    if (!(x > 0)) return 0;
    const double whole = std::floor(static_cast<double>(p));
    if (p == R(whole) && whole <= 16) {
        R product = x;
        for (int i = 1; i < static_cast<int>(whole); ++i) product = product * x;
        return product;
    }
    const R exponent = p * logarithm(x);
    return static_cast<double>(exponent) < -690 ? R(0) : exponential(exponent);
}

}  // namespace alhazen
