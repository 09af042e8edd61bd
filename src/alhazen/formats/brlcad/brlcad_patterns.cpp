#include "alhazen/formats/brlcad/brlcad_patterns.h"

#include <algorithm>
#include <cmath>

#include "alhazen/formats/brlcad/brlcad_database.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

void set_pixel(Image& image, int x, int y, const Rgb& color) {
    float* const p = image.pixel(x, y);
    p[0] = static_cast<float>(color.r);
    p[1] = static_cast<float>(color.g);
    p[2] = static_cast<float>(color.b);
}

Rgb mean_of(const Image& image) {
    Rgb sum;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) sum += image.rgb(x, y);
    }
    return (1.0 / (static_cast<double>(image.width) * image.height)) * sum;
}

/// Squares of two colours, the first at the origin; the side of a square is 1 / s.
BrlcadPattern checker(const BrlcadShader& shader) {
    const auto color = [&](const char* name, double otherwise) {
        const Rgb c = shader.three(name).value_or(Rgb{otherwise, otherwise, otherwise});
        return brlcad_color(c.r, c.g, c.b);
    };
    BrlcadPattern pattern;
    pattern.image = Image(2, 2, 3);
    const Rgb a = color("a", 255.0), b = color("b", 0.0);
    set_pixel(pattern.image, 0, 1, a);
    set_pixel(pattern.image, 1, 0, a);
    set_pixel(pattern.image, 0, 0, b);
    set_pixel(pattern.image, 1, 1, b);
    pattern.repeats = 0.5 * std::clamp(shader.number("s").value_or(2.0), 1e-3, 1e6);
    return pattern;
}

/// An image whose red grows with u, its blue with v.
BrlcadPattern test_map() {
    constexpr int kSide = 256;
    BrlcadPattern pattern;
    pattern.image = Image(kSide, kSide, 3);
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            set_pixel(pattern.image, x, kSide - 1 - y, {(x + 0.5) / kSide, 0.0, (y + 0.5) / kSide});
        }
    }
    pattern.smooth = true;
    return pattern;
}

/// Gardner's product of two sums of four sines each, which shift each other's phase; in 0 to 1.
double gardner(double u, double v) {
    constexpr double kQuarter = 0.5 * kPi;
    double frequency_u = 4.0 * kPi, frequency_v = 2.0 * kPi;
    double shift_u = kQuarter * std::sin(0.5 * frequency_v * v);
    double shift_v = kQuarter * std::sin(0.5 * frequency_u * u);
    double sum_u = 0.0, sum_v = 0.0, amplitude = 1.0;
    constexpr int kSines = 4;
    for (int i = 0; i < kSines; ++i) {
        sum_u += 1.0 + amplitude * std::sin(frequency_u * u + shift_u);
        sum_v += 1.0 + amplitude * std::sin(frequency_v * v + shift_v);
        shift_u = kQuarter * std::sin(frequency_v * v);
        shift_v = kQuarter * std::sin(frequency_u * u);
        frequency_u *= 2.0;
        frequency_v *= 2.0;
        amplitude *= 0.707;
    }
    return std::clamp(sum_u * sum_v / (2 * kSines * kSines), 0.0, 1.0);
}

BrlcadPattern cloud(const BrlcadShader& shader) {
    constexpr int kSide = 256;
    const double threshold = shader.number("thresh").value_or(0.35);
    const double range = std::max(1e-6, shader.number("range").value_or(0.3));
    const Rgb sky{0.31, 0.31, 0.78};
    BrlcadPattern pattern;
    pattern.image = Image(kSide, kSide, 3);
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const double density = gardner((x + 0.5) / kSide, (y + 0.5) / kSide);
            const double clear = std::clamp(1.0 - (density - threshold) / range, 0.0, 1.0);
            const double white = (1.0 - clear) * density;
            set_pixel(pattern.image, x, kSide - 1 - y, Rgb{white, white, white} + clear * sky);
        }
    }
    pattern.smooth = true;
    return pattern;
}

}  // namespace

std::optional<BrlcadPattern> brlcad_pattern(const BrlcadShader& shader) {
    std::optional<BrlcadPattern> pattern;
    if (shader.name == "checker") pattern = checker(shader);
    if (shader.name == "testmap") pattern = test_map();
    if (shader.name == "cloud") pattern = cloud(shader);
    if (pattern) pattern->mean = mean_of(pattern->image);
    return pattern;
}

}  // namespace alhazen
