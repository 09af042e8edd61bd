#pragma once
/// Real roots of a quadratic, computed without cancellation.
///
/// Source: W. Kahan, "On the Cost of Floating-Point Computation Without Extra-Precise Arithmetic",
/// 2004 (difference of products); the second root from the product of the roots (Vieta).

#include <cmath>

namespace alhazen {

/// a*b - c*d with an error of at most 1.5 ulp and an exact sign (barring over- and underflow). The
/// operations are explicitly fused: the bits are the same on every machine.
inline double difference_of_products(double a, double b, double c, double d) {
    const double cd = c * d;
    const double error = std::fma(-c, d, cd);
    return std::fma(a, b, -cd) + error;
}

/// Roots of a t^2 + 2 b t + c = 0 in ascending order; count 0, 1 (only when a is 0) or 2. A double
/// root is reported twice. NaN coefficients give no root.
struct QuadraticRoots {
    int count = 0;
    double t0 = 0, t1 = 0;
};
[[nodiscard]] QuadraticRoots solve_half_b_quadratic(double a, double b, double c);

}  // namespace alhazen
