#include "alhazen/imaging/film/filter_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace alhazen {

namespace {

constexpr double kPi = std::numbers::pi;

double box_kernel(double /*x*/, double /*radius*/) {
    return 1.0;
}
double box_integral(double x, double /*radius*/) {
    return x;
}
double tent_kernel(double x, double radius) {
    return std::max(0.0, 1.0 - std::abs(x) / radius);
}
double tent_integral(double x, double radius) {
    return x * (1.0 - 0.5 * std::abs(x) / radius);
}
/// Its standard deviation is a third of the radius.
double gaussian_kernel(double x, double radius) {
    const double t = 3.0 * x / radius;
    return std::exp(-0.5 * t * t);
}
double gaussian_integral(double x, double radius) {
    return std::sqrt(0.5 * kPi) * radius / 3.0 * std::erf(3.0 * x / (radius * std::sqrt(2.0)));
}
/// B = C = 1/3.
double mitchell_kernel(double x, double radius) {
    const double t = 2.0 * std::abs(x) / radius;
    if (t < 1.0) return (7.0 * t * t * t - 12.0 * t * t + 16.0 / 3.0) / 6.0;
    return (-7.0 / 3.0 * t * t * t + 12.0 * t * t - 20.0 * t + 32.0 / 3.0) / 6.0;
}
double mitchell_integral(double x, double radius) {
    const double t = 2.0 * std::abs(x) / radius;
    const auto inner = [](double u) {
        return (7.0 / 4.0 * u * u * u * u - 4.0 * u * u * u + 16.0 / 3.0 * u) / 6.0;
    };
    const auto outer = [](double u) {
        return (-7.0 / 12.0 * u * u * u * u + 4.0 * u * u * u - 10.0 * u * u + 32.0 / 3.0 * u) /
               6.0;
    };
    const double sum = t < 1.0 ? inner(t) : inner(1.0) + outer(t) - outer(1.0);
    return std::copysign(0.5 * radius * sum, x);
}
/// The minimum window of four terms.
double blackman_harris_kernel(double x, double radius) {
    const double t = kPi * x / radius;
    return 0.35875 + 0.48829 * std::cos(t) + 0.14128 * std::cos(2.0 * t) +
           0.01168 * std::cos(3.0 * t);
}
double blackman_harris_integral(double x, double radius) {
    const double t = kPi * x / radius;
    return radius / kPi *
           (0.35875 * t + 0.48829 * std::sin(t) + 0.14128 / 2.0 * std::sin(2.0 * t) +
            0.01168 / 3.0 * std::sin(3.0 * t));
}
double sinc(double x) {
    return x == 0.0 ? 1.0 : std::sin(kPi * x) / (kPi * x);
}
/// Zeros at the whole numbers, as many as the radius.
double lanczos_kernel(double x, double radius) {
    return sinc(x) * sinc(x / radius);
}

}  // namespace

std::span<const FilterEntry> filters() {
    static constexpr std::array<FilterEntry, 6> kTable{{
        {"box", "the mean over a square", 0.5, box_kernel, box_integral},
        {"tent", "falls in a straight line", 1.0, tent_kernel, tent_integral},
        {"gaussian", "a bell; its standard deviation is a third of the radius", 1.5,
         gaussian_kernel, gaussian_integral},
        {"mitchell", "Mitchell and Netravali's cubic, B = C = 1/3, with negative lobes", 2.0,
         mitchell_kernel, mitchell_integral},
        {"blackman_harris", "the window of four cosines", 1.5, blackman_harris_kernel,
         blackman_harris_integral},
        {"lanczos", "a windowed sinc, with negative lobes", 3.0, lanczos_kernel, nullptr},
    }};
    return kTable;
}

const FilterEntry* find_filter(const std::string& name) {
    for (const FilterEntry& entry : filters()) {
        if (name == entry.name) return &entry;
    }
    return nullptr;
}

FilterKernel::FilterKernel(const FilterEntry& entry, double radius) : radius_(radius) {
    const auto place = [&](double node) { return radius * (2.0 * node / kCells - 1.0); };
    for (int node = 0; node <= kCells; ++node) {
        values_.push_back(std::abs(entry.value(place(node), radius)));
    }
    double sum = 0.0, signed_sum = 0.0;
    shares_.push_back(0.0);
    for (int cell = 0; cell < kCells; ++cell) {
        const auto k = static_cast<std::size_t>(cell);
        signs_.push_back(entry.value(place(cell + 0.5), radius) < 0.0 ? -1.0 : 1.0);
        const double area = 0.5 * (values_[k] + values_[k + 1]);
        sum += area;
        signed_sum += signs_[k] * area;
        shares_.push_back(sum);
    }
    for (double& share : shares_) share /= sum;
    shares_.back() = 1.0;
    if (signed_sum < sum) mean_sign_ = signed_sum / sum;
}

FilterKernel::OneDrawn FilterKernel::draw_one(double u) const {
    const auto above = std::upper_bound(shares_.begin(), shares_.end() - 1, u);
    const auto cell = static_cast<std::size_t>(above - shares_.begin()) - 1;
    const double a = values_[cell], b = values_[cell + 1];
    const double width = shares_[cell + 1] - shares_[cell];
    const double v = width > 0.0 ? (u - shares_[cell]) / width : 0.5;
    // The root of a t + (b - a) t^2 / 2 = v (a + b) / 2, without cancellation.
    const double root = std::sqrt(a * a + v * (b * b - a * a));
    const double t = a + root > 0.0 ? std::min(1.0, v * (a + b) / (a + root)) : v;
    return {radius_ * (2.0 * (static_cast<double>(cell) + t) / kCells - 1.0), signs_[cell]};
}

}  // namespace alhazen
