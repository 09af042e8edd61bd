#pragma once
/// Estimates with confidence intervals of a given probability.
///
/// Source: Student, "The Probable Error of a Mean", Biometrika 6, 1908; Abramowitz and Stegun,
/// "Handbook of Mathematical Functions", 1964, 26.7.3-4 (the distribution for whole degrees of
/// freedom); Satterthwaite, "An Approximate Distribution of Estimates of Variance Components",
/// Biometrics Bulletin 2, 1946 (degrees of freedom of a sum).
/// Differs: finds the quantile by bisection.

#include <span>

namespace alhazen {

/// A value and half the width of its interval.
struct Estimate {
    double value = 0;
    double half_width = 0;
    double rounding = 0;  ///< part of half_width due to rounding, which does not average out

    [[nodiscard]] double lo() const { return value - half_width; }
    [[nodiscard]] double hi() const { return value + half_width; }
    [[nodiscard]] bool holds(double truth) const { return lo() <= truth && truth <= hi(); }
};

/// P(|T| <= t) for Student's distribution. Preconditions: degrees >= 1, t >= 0.
[[nodiscard]] double student_two_sided(double t, int degrees);
/// The t for which P(|T| <= t) = probability. Precondition: probability is in (0, 1).
[[nodiscard]] double student_quantile(double probability, int degrees);

/// The standard deviation of a sum of independent parts, with the degrees of freedom of its
/// estimate.
struct Spread {
    double deviation = 0;  ///< standard deviation
    double degrees = 1;    ///< degrees of freedom, at least 1
};
/// The spread of a sum of parts, where the variance of part i is estimated by q_i = d_i^2 from one
/// difference d_i: `squares` is the sum of q_i, `fourths` that of q_i^2.
[[nodiscard]] Spread spread_of_differences(double squares, double fourths);
/// The spread of a sum of independent numbers.
[[nodiscard]] Spread sum_of(std::span<const Spread> independent);
/// The estimate with `value` and the half width that follows from `spread`.
[[nodiscard]] Estimate estimate_of(double value, const Spread& spread, double probability = 0.95);

/// The spread of the mean of independent estimates of one number. Precondition: at least two.
[[nodiscard]] Spread spread_of_mean(std::span<const double> independent);
/// The mean of independent estimates of one number, with its interval. Precondition: at least two.
/// The interval is valid as far as the estimates are normally distributed.
[[nodiscard]] Estimate mean_of(std::span<const double> independent, double probability = 0.95);

}  // namespace alhazen
