#pragma once
/// Numbers of about 32 decimal digits: the unevaluated sum of two doubles.
///
/// Source: Dekker, "A floating-point technique for extending the available precision", Numerische
/// Mathematik 18, 1971; Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic
/// building blocks of double-word arithmetic", ACM TOMS 44(2), 2017: algorithms 4, 6, 9 and 12.
/// Differs: implements only the operations that exact shapes need.
/// Conventions: |low| is at most half an ulp of high. Sums and products have a relative error of at
/// most kDoubleDoubleUlp, barring over- and underflow (also sums of opposite signs).

#include <cmath>
#include <type_traits>

namespace alhazen {

/// Bound on the relative error of one operation; the source proves at most 5 * 2^-106.
inline constexpr double kDoubleDoubleUlp = 0x1p-103;
/// Relative rounding error of one operation.
template <class Real>
inline constexpr double kUnitRoundoff = std::is_same_v<Real, double> ? 0x1p-53 : kDoubleDoubleUlp;

struct DoubleDouble {
    double high = 0, low = 0;

    DoubleDouble() = default;
    constexpr DoubleDouble(double value) : high(value) {}  // NOLINT: exact for every double
    constexpr DoubleDouble(double h, double l) : high(h), low(l) {}
    explicit operator double() const { return high; }
};

/// The rounded sum and its exact error.
inline DoubleDouble two_sum(double a, double b) {
    const double sum = a + b;
    const double b_virtual = sum - a;
    return {sum, (a - (sum - b_virtual)) + (b - b_virtual)};
}

/// The rounded sum and its exact error, for |a| >= |b|.
inline DoubleDouble fast_two_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

/// The rounded product and its exact error.
inline DoubleDouble two_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

inline DoubleDouble operator-(const DoubleDouble& a) {
    return {-a.high, -a.low};
}
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = two_sum(a.high, b.high);
    const DoubleDouble t = two_sum(a.low, b.low);
    const DoubleDouble v = fast_two_sum(s.high, s.low + t.high);
    return fast_two_sum(v.high, t.low + v.low);
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
    return a + (-b);
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble p = two_product(a.high, b.high);
    const double low = std::fma(a.low, b.high, std::fma(a.high, b.low, a.low * b.low));
    return fast_two_sum(p.high, p.low + low);
}
inline DoubleDouble& operator+=(DoubleDouble& a, const DoubleDouble& b) {
    return a = a + b;
}
inline DoubleDouble& operator-=(DoubleDouble& a, const DoubleDouble& b) {
    return a = a - b;
}

/// The quotient, to about 30 digits; not finite if b is 0.
inline DoubleDouble quotient(const DoubleDouble& a, const DoubleDouble& b) {
    const double first = a.high / b.high;
    const DoubleDouble rest = a - b * DoubleDouble(first);
    return fast_two_sum(first, rest.high / b.high);
}
/// The square root, to about 30 digits. Precondition: a >= 0.
inline DoubleDouble square_root(const DoubleDouble& a) {
    if (a.high == 0.0) return {};
    const double first = std::sqrt(a.high);
    const DoubleDouble rest = a - two_product(first, first);
    return fast_two_sum(first, rest.high / (2.0 * first));
}

inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
}
inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) {
    return b < a;
}

}  // namespace alhazen
