#include "alhazen/sampling/confidence.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// Degrees of freedom beyond which Student's distribution is the normal one to half a percent.
constexpr double kMostDegrees = 200;

double mean(std::span<const double> numbers) {
    const double n = static_cast<double>(numbers.size());
    double sum = 0;
    for (const double x : numbers) sum += x / n;
    return sum;
}

}  // namespace

double student_two_sided(double t, int degrees) {
    const double angle = std::atan(t / std::sqrt(static_cast<double>(degrees)));
    const double c = std::cos(angle);
    const bool odd = degrees % 2 != 0;
    // 1 + 2/3 c^2 + (2 4)/(3 5) c^4 ... (odd) or 1 + 1/2 c^2 + (1 3)/(2 4) c^4 ... (even), up to
    // c^(degrees - 2) in all.
    double term = odd ? c : 1.0;
    double sum = degrees == 1 ? 0.0 : term;
    for (int k = odd ? 3 : 2; k <= degrees - 2; k += 2) {
        term *= (k - 1.0) / k * c * c;
        sum += term;
    }
    constexpr double kTwoOverPi = 0.63661977236758134308;
    return odd ? kTwoOverPi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
}

double student_quantile(double probability, int degrees) {
    double lo = 0, hi = 1;
    while (student_two_sided(hi, degrees) < probability) hi *= 2;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (lo + hi);
        (student_two_sided(middle, degrees) < probability ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

Spread spread_of_differences(double squares, double fourths) {
    if (!(squares > 0.0) || !(fourths > 0.0)) return {std::sqrt(squares), kMostDegrees};
    // For normally distributed d_i the mean of d_i^4 is three times the squared variance; the 2 is
    // the bias of the ratio.
    return {std::sqrt(squares),
            std::clamp(3 * squares * (squares / fourths) - 2, 1.0, kMostDegrees)};
}

Spread sum_of(std::span<const Spread> independent) {
    double largest = 0;
    for (const Spread& s : independent) largest = std::fmax(largest, s.deviation);
    if (!(largest > 0.0)) return {0, kMostDegrees};
    double sum = 0, weighted = 0;
    for (const Spread& s : independent) {
        const double ratio = s.deviation / largest;
        const double variance = ratio * ratio;
        sum += variance;
        weighted += variance * variance / s.degrees;
    }
    return {largest * std::sqrt(sum), std::clamp(sum * sum / weighted, 1.0, kMostDegrees)};
}

Estimate estimate_of(double value, const Spread& spread, double probability) {
    const int degrees = static_cast<int>(spread.degrees);
    return {value, student_quantile(probability, degrees) * spread.deviation};
}

Spread spread_of_mean(std::span<const double> independent) {
    const double n = static_cast<double>(independent.size()), middle = mean(independent);
    // Divides by the largest deviation, so that no square over- or underflows.
    double farthest = 0;
    for (const double x : independent) farthest = std::fmax(farthest, std::abs(x - middle));
    double squares = 0;
    for (const double x : independent) {
        const double off = farthest > 0 ? (x - middle) / farthest : 0;
        squares += off * off;
    }
    return {farthest * std::sqrt(squares / (n - 1) / n), n - 1};
}

Estimate mean_of(std::span<const double> independent, double probability) {
    return estimate_of(mean(independent), spread_of_mean(independent), probability);
}

}  // namespace alhazen
