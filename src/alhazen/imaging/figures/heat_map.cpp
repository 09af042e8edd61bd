#include "alhazen/imaging/figures/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

namespace {

Rgb linear_from_oklab(double lightness, double a, double b) {
    const auto cube = [](double x) { return x * x * x; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool displayable(const Rgb& c) {
    return c.r >= 0 && c.g >= 0 && c.b >= 0 && c.r <= 1 && c.g <= 1 && c.b <= 1;
}

Rgb path_color(double t) {
    const double lightness = 0.16 + 0.81 * t;
    const double hue = (280.0 + 185.0 * t) * std::numbers::pi / 180.0;
    const auto at = [&](double chroma) {
        return linear_from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
    };
    double inside = 0.0, outside = 0.19;
    if (displayable(at(outside))) inside = outside;
    for (int i = 0; i < 30; ++i) {
        const double middle = 0.5 * (inside + outside);
        (displayable(at(middle)) ? inside : outside) = middle;
    }
    const Rgb c = at(inside);
    return {srgb_from_linear(c.r), srgb_from_linear(c.g), srgb_from_linear(c.b)};
}

constexpr int kHeatSteps = 256;

std::array<Rgb, kHeatSteps> make_table() {
    std::array<Rgb, kHeatSteps> table;
    for (int i = 0; i < kHeatSteps; ++i) {
        table[static_cast<std::size_t>(i)] = path_color(static_cast<double>(i) / (kHeatSteps - 1));
    }
    return table;
}

}  // namespace

Rgb heat_color(double t) {
    static const std::array<Rgb, kHeatSteps> table = make_table();
    const double clamped = t > 0.0 ? std::min(t, 1.0) : 0.0;
    return table[static_cast<std::size_t>(std::lround(clamped * (kHeatSteps - 1)))];
}

}  // namespace alhazen
