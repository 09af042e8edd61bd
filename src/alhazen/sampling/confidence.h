#pragma once
/// Estimates with confidence intervals of a stated probability.
///
/// Source: Student, "The Probable Error of a Mean", Biometrika 6, 1908; Abramowitz and Stegun,
/// "Handbook of Mathematical Functions", 1964, 26.7.3-4 (the distribution for whole degrees of
/// freedom).
/// Differs: finds the quantile by bisection.

#include <span>

namespace alhazen {

/// A value and half the width of its interval.
struct Estimate {
    double value = 0;
    double half_width = 0;

    [[nodiscard]] double lo() const { return value - half_width; }
    [[nodiscard]] double hi() const { return value + half_width; }
    [[nodiscard]] bool holds(double truth) const { return lo() <= truth && truth <= hi(); }
};

/// P(|T| <= t) for Student's distribution. degrees >= 1, t >= 0.
[[nodiscard]] double student_two_sided(double t, int degrees);
/// The t with P(|T| <= t) = probability, in (0, 1).
[[nodiscard]] double student_quantile(double probability, int degrees);

/// Mean of independent estimates of one number, with its interval; needs at least two. The interval
/// is valid as far as the estimates are normally distributed.
[[nodiscard]] Estimate mean_of(std::span<const double> independent, double probability = 0.95);

}  // namespace alhazen
