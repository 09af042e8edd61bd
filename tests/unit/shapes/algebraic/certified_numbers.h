#pragma once
/// Ball arithmetic: numbers as a centre and an error radius. An operation encloses the exact result
/// or throws `Uncertain`; the computation is then repeated with more digits.
/// The centre is a double or a DoubleDouble; radii are doubles, each enlarged by more than its
/// rounding. Has only the operations needed for counting roots.
/// Source: van der Hoeven, "Ball arithmetic", 2009.

#include <cmath>
#include <limits>

#include "alhazen/math/double_double.h"

namespace alhazen::testing {

/// Thrown where the precision is insufficient.
struct Uncertain {};

template <class Real>
struct Ball {
    static constexpr bool kPlain = std::is_same_v<Real, double>;
    /// Relative rounding error of one operation.
    static constexpr double kUlp = kPlain ? 0x1p-53 : kDoubleDoubleUlp;
    /// Bound of the loss by underflow of products.
    static constexpr double kTiny = 1e-280;
    static constexpr double kMargin = 1.0 + 0x1p-48;

    Real center{};
    double radius = 0;

    Ball() = default;
    Ball(double value) : center(value) {}  // NOLINT: a double converts exactly
    Ball(const Real& c, double r) : center(c), radius(r) {}

    [[nodiscard]] double high() const {
        if constexpr (kPlain) {
            return center;
        } else {
            return center.high;
        }
    }
    /// Upper bound of the magnitude of the centre.
    [[nodiscard]] double magnitude() const { return std::abs(high()) * kMargin; }

    friend Ball operator-(const Ball& a) { return {Real(0.0) - a.center, a.radius}; }
    friend Ball operator+(const Ball& a, const Ball& b) {
        return rounded(a.center + b.center, a.radius + b.radius);
    }
    friend Ball operator-(const Ball& a, const Ball& b) {
        return rounded(a.center - b.center, a.radius + b.radius);
    }
    friend Ball operator*(const Ball& a, const Ball& b) {
        return rounded(a.center * b.center, a.magnitude() * b.radius + b.magnitude() * a.radius +
                                                a.radius * b.radius + kTiny);
    }
    friend Ball operator/(const Ball& a, const Ball& b) {
        const double least = std::abs(b.high()) / kMargin - b.radius;
        if (!(least > 0.0)) throw Uncertain{};
        Ball q(divided(a.center, b.center), 0.0);
        // |a / b - q| = |a - q b| / |b|
        const Ball rest = a - q * b;
        q.radius = (rest.magnitude() + rest.radius) / least * kMargin + kTiny;
        return q;
    }
    friend Ball square_root(const Ball& a) {
        const int sign = sign_of(a);
        if (sign < 0) throw Uncertain{};
        if (sign == 0) return a;
        Ball s(rooted(a.center), 0.0);
        // |sqrt(a) - s| = |a - s s| / (sqrt(a) + s)
        const Ball rest = a - s * s;
        s.radius = (rest.magnitude() + rest.radius) / std::abs(s.high()) * kMargin + kTiny;
        return s;
    }
    /// Zero only for an exact 0.
    friend int sign_of(const Ball& a) {
        const int sign = known_sign(a);
        if (sign == 0 && (a.high() != 0.0 || a.radius != 0.0)) throw Uncertain{};
        return sign;
    }
    /// Zero where the sign is unknown.
    friend int known_sign(const Ball& a) {
        if (!(std::abs(a.high()) > a.radius * kMargin)) return 0;
        return a.high() > 0.0 ? 1 : -1;
    }
    /// Multiplies by 2^n; exact except for underflow.
    friend Ball scaled(const Ball& a, int n) {
        const double factor = std::ldexp(1.0, n);
        if constexpr (kPlain) {
            return {a.center * factor, a.radius * factor + kTiny};
        } else {
            return {{a.center.high * factor, a.center.low * factor}, a.radius * factor + kTiny};
        }
    }

  private:
    static Ball rounded(const Real& value, double radius) {
        Ball b(value, 0.0);
        b.radius = (radius + kUlp * b.magnitude()) * kMargin;
        if (!std::isfinite(b.radius)) throw Uncertain{};
        return b;
    }
    static double divided(double a, double b) { return a / b; }
    static DoubleDouble divided(const DoubleDouble& a, const DoubleDouble& b) {
        return quotient(a, b);
    }
    static double rooted(double a) { return std::sqrt(a); }
    static DoubleDouble rooted(const DoubleDouble& a) { return square_root(a); }
};

using DoubleBall = Ball<double>;
using PreciseBall = Ball<DoubleDouble>;

/// Rounds the centre to double.
inline DoubleBall shortened(const PreciseBall& a) {
    return {a.center.high, (a.radius + std::abs(a.center.low)) * PreciseBall::kMargin};
}

}  // namespace alhazen::testing
