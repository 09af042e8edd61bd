#include "alhazen/imaging/film/filter_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

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
/// The Gaussian whose standard deviation is a third of the radius.
double gaussian_kernel(double x, double radius) {
    const double t = 3.0 * x / radius;
    return std::exp(-0.5 * t * t);
}
double gaussian_integral(double x, double radius) {
    return std::sqrt(0.5 * kPi) * radius / 3.0 * std::erf(3.0 * x / (radius * std::sqrt(2.0)));
}
/// The Mitchell-Netravali filter with B = C = 1/3.
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
/// The minimum four-term window.
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
/// The windowed sinc, with zeros at the integers; the radius is their number on each side.
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
        const double middle = place(std::min(node + 0.5, double{kCells}));
        const double sign = entry.value(middle, radius) < 0.0 ? -1.0 : 1.0;
        nodes_.push_back({0.0, std::abs(entry.value(place(node), radius)), sign});
    }
    even_ = std::all_of(nodes_.begin(), nodes_.end(),
                        [](const Node& n) { return n.magnitude == 1.0 && n.sign == 1.0; });
    double sum = 0.0, signed_sum = 0.0;
    for (std::size_t cell = 0; cell < kCells; ++cell) {
        const double area = 0.5 * (nodes_[cell].magnitude + nodes_[cell + 1].magnitude);
        sum += area;
        signed_sum += nodes_[cell].sign * area;
        nodes_[cell + 1].share = sum;
    }
    for (Node& node : nodes_) node.share /= sum;
    nodes_.back().share = 1.0;
    if (signed_sum < sum) mean_sign_ = signed_sum / sum;

    std::uint32_t cell = 0;
    for (int k = 0; k < kCells; ++k) {
        while (nodes_[cell + 1].share <= static_cast<double>(k) / kCells) ++cell;
        guide_.push_back(cell);
    }
}

FilterKernel::OneDrawn FilterKernel::draw_one(double u) const {
    std::size_t cell =
        guide_[std::min<std::size_t>(static_cast<std::size_t>(u * kCells), kCells - 1)];
    while (cell + 1 < kCells && nodes_[cell + 1].share <= u) ++cell;
    const Node &from = nodes_[cell], &to = nodes_[cell + 1];
    const double a = from.magnitude, b = to.magnitude;
    const double width = to.share - from.share;
    const double v = width > 0.0 ? (u - from.share) / width : 0.5;
    // The root of a t + (b - a) t^2 / 2 = v (a + b) / 2, computed without cancellation.
    const double root = std::sqrt(a * a + v * (b * b - a * a));
    const double t = a + root > 0.0 ? std::min(1.0, v * (a + b) / (a + root)) : v;
    return {radius_ * (2.0 * (static_cast<double>(cell) + t) / kCells - 1.0), from.sign};
}

}  // namespace alhazen
