#pragma once
/// Estimates with the interval that holds the truth with a stated probability.
///
/// Source: Student, "The Probable Error of a Mean", Biometrika 6, 1908; Abramowitz and Stegun,
/// "Handbook of Mathematical Functions", 1964, 26.7.3-4 (the distribution for whole degrees of
/// freedom). Differs: the quantile is found by bisection.

#include <span>

namespace alhazen {

/// A value, and half the width of its interval.
struct Estimate {
    double value = 0;
    double half_width = 0;

    [[nodiscard]] double lo() const { return value - half_width; }
    [[nodiscard]] double hi() const { return value + half_width; }
    [[nodiscard]] bool holds(double truth) const { return lo() <= truth && truth <= hi(); }
};

/// P(|T| <= t) for Student's distribution. degrees >= 1, t >= 0.
[[nodiscard]] double student_two_sided(double t, int degrees);
/// The t with P(|T| <= t) = probability, which is in (0, 1).
[[nodiscard]] double student_quantile(double probability, int degrees);

/// Mean of independent estimates of one number with its interval; at least two of them. Right as
/// far as they are normally distributed.
[[nodiscard]] Estimate mean_of(std::span<const double> independent, double probability = 0.95);

}  // namespace alhazen
