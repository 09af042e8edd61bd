#pragma once
/// Estimates with confidence intervals of a stated probability.
///
/// Source: Student, "The Probable Error of a Mean", Biometrika 6, 1908; Abramowitz and Stegun,
/// "Handbook of Mathematical Functions", 1964, 26.7.3-4 (the distribution for whole degrees of
/// freedom).
/// Satterthwaite, "An Approximate Distribution of Estimates of Variance Components", Biometrics
/// Bulletin 2, 1946 (degrees of freedom of a sum).
/// Differs: finds the quantile by bisection.

#include <span>

namespace alhazen {

/// A value and half the width of its interval.
struct Estimate {
    double value = 0;
    double half_width = 0;
    double rounding = 0;  ///< the part of half_width that is rounding: it adds up, never averages

    [[nodiscard]] double lo() const { return value - half_width; }
    [[nodiscard]] double hi() const { return value + half_width; }
    [[nodiscard]] bool holds(double truth) const { return lo() <= truth && truth <= hi(); }
};

/// P(|T| <= t) for Student's distribution. degrees >= 1, t >= 0.
[[nodiscard]] double student_two_sided(double t, int degrees);
/// The t with P(|T| <= t) = probability, in (0, 1).
[[nodiscard]] double student_quantile(double probability, int degrees);

/// How far a sum of independent parts scatters, and how well that is known.
struct Spread {
    double deviation = 0;  ///< standard deviation
    double degrees = 1;    ///< of freedom; at least 1
};
/// The spread of a sum of parts, where the square of part i is estimated by q_i = d_i^2 of one
/// difference d_i each: from the sums of q_i and of q_i^2.
[[nodiscard]] Spread spread_of_differences(double squares, double fourths);
/// The spread of the sum of independent numbers.
[[nodiscard]] Spread sum_of(std::span<const Spread> independent);
/// The value with its interval.
[[nodiscard]] Estimate estimate_of(double value, const Spread& spread, double probability = 0.95);

/// Mean of independent estimates of one number, with its interval; needs at least two. The interval
/// is valid as far as the estimates are normally distributed.
[[nodiscard]] Estimate mean_of(std::span<const double> independent, double probability = 0.95);

}  // namespace alhazen
