#include "alhazen/imaging/image/tone_mapping.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

using Rows = Rgb[3];

Rgb times(const Rows& m, const Rgb& v) {
    const auto row = [&](const Rgb& r) { return r.r * v.r + r.g * v.g + r.b * v.b; };
    return {row(m[0]), row(m[1]), row(m[2])};
}

/// From linear sRGB to CIE XYZ, and its inverse (IEC 61966-2-1).
constexpr Rows kXyzFromRgb = {{0.4123908, 0.3575843, 0.1804808},
                              {0.2126390, 0.7151687, 0.0721923},
                              {0.0193308, 0.1191948, 0.9505322}};
constexpr Rows kRgbFromXyz = {{3.2409699, -1.5373832, -0.4986108},
                              {-0.9692436, 1.8759675, 0.0415551},
                              {0.0556301, -0.2039770, 1.0569715}};
/// Bradford's cone responses.
constexpr Rows kConesFromXyz = {
    {0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
constexpr Rows kXyzFromCones = {{0.9869929, -0.1470543, 0.1599627},
                                {0.4323053, 0.5183603, 0.0492912},
                                {-0.0085287, 0.0400428, 0.9684867}};

double luminance(const Rgb& c) {
    return 0.2126390 * c.r + 0.7151687 * c.g + 0.0721923 * c.b;
}

/// The colour, Y = 1, of daylight for 4000 K and above, of a black body below.
Rgb xyz_of_temperature(double kelvin) {
    const double t = 1e3 / kelvin;
    double x, y;
    if (kelvin >= 4000.0) {
        x = kelvin <= 7000.0 ? 0.244063 + t * (0.09911 + t * (2.9678 - 4.6070 * t))
                             : 0.237040 + t * (0.24748 + t * (1.9018 - 2.0064 * t));
        y = -3.000 * x * x + 2.870 * x - 0.275;
    } else {
        x = 0.179910 + t * (0.8776956 + t * (-0.2343589 - 0.2661239 * t));
        y = kelvin >= 2222.0 ? -0.16748867 + x * (2.09137015 + x * (-1.37418593 - 0.9549476 * x))
                             : -0.20219683 + x * (2.18555832 + x * (-1.34811020 - 1.1063814 * x));
    }
    return {x / y, 1.0, (1.0 - x - y) / y};
}

Rgb reinhard(const Rgb& c) {
    constexpr double kWhite = 4.0;
    const double l = luminance(c);
    if (!(l > 0.0)) return c;
    return ((1.0 + l / (kWhite * kWhite)) / (1.0 + l)) * c;
}

Rgb aces(const Rgb& c) {
    const auto curve = [](double x) {
        return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    };
    const auto of = [&](double x) { return x > 0.0 ? std::min(1.0, curve(x)) : x; };
    return {of(c.r), of(c.g), of(c.b)};
}

Rgb agx(const Rgb& c) {
    constexpr Rows kInset = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                             {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                             {0.0423756549057051, 0.0784336, 0.879142973793104}};
    constexpr Rows kOutset = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                              {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                              {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
    constexpr double kLeastStop = -12.47393, kMostStop = 4.026069;
    const auto curve = [](double value) {
        const double stop = std::log2(std::max(value, 1e-10));
        const double x = std::clamp((stop - kLeastStop) / (kMostStop - kLeastStop), 0.0, 1.0);
        return -0.00232 +
               x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
    };
    const Rgb inset = times(kInset, c);
    const Rgb shown = times(kOutset, {curve(inset.r), curve(inset.g), curve(inset.b)});
    const auto linear = [](double v) { return v > 0.0 ? std::pow(std::min(v, 1.0), 2.2) : 0.0; };
    return {linear(shown.r), linear(shown.g), linear(shown.b)};
}

}  // namespace

ToneMapper::ToneMapper(const ToneMapping& mapping)
    : mapping_(mapping), scale_(std::exp2(mapping.stops)) {
    if (!(mapping.kelvin > 0.0)) return;
    const Rgb from = times(kConesFromXyz, xyz_of_temperature(mapping.kelvin));
    const Rgb to = times(kConesFromXyz, times(kXyzFromRgb, {1, 1, 1}));
    const Rgb gain{to.r / from.r, to.g / from.g, to.b / from.b};
    // The columns of the complete matrix, one for each primary.
    for (int i = 0; i < 3; ++i) {
        Rgb primary;
        primary[i] = 1.0;
        const Rgb cones = gain * times(kConesFromXyz, times(kXyzFromRgb, primary));
        const Rgb column = times(kRgbFromXyz, times(kXyzFromCones, cones));
        for (int row = 0; row < 3; ++row) balance_[row][i] = column[row];
    }
}

Rgb ToneMapper::operator()(const Rgb& radiance) const {
    const Rgb c = scale_ * (mapping_.kelvin > 0.0 ? times(balance_, radiance) : radiance);
    switch (mapping_.curve) {
        case ToneCurve::None:
            return c;
        case ToneCurve::Reinhard:
            return reinhard(c);
        case ToneCurve::Aces:
            return aces(c);
        case ToneCurve::Agx:
            return c.is_finite() ? agx(c) : c;
    }
    return c;
}

}  // namespace alhazen
