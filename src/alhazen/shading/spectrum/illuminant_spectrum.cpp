#include "alhazen/shading/spectrum/illuminant_spectrum.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shading/spectrum/color_matching.h"

namespace alhazen {

namespace {

/// Planck's law, relative to its value at 560 nm.
double black_body(double nm, double kelvin) {
    constexpr double kSecondConstant = 1.438776877e7;  // h c / k in nm K
    const auto radiance = [&](double l) {
        return std::pow(560.0 / l, 5.0) / std::expm1(kSecondConstant / (l * kelvin));
    };
    return radiance(nm) / radiance(560.0);
}

/// The equation of illuminant A in CIE 15:2004.
double illuminant_a(double nm) {
    constexpr double kConstant = 1.435e7, kKelvin = 2848.0;
    return std::pow(560.0 / nm, 5.0) * std::expm1(kConstant / (560.0 * kKelvin)) /
           std::expm1(kConstant / (nm * kKelvin));
}

double relative(const Illuminant& illuminant, double nm) {
    switch (illuminant.kind) {
        case IlluminantKind::BlackBody:
            return black_body(nm, illuminant.kelvin);
        case IlluminantKind::A:
            return illuminant_a(nm);
        case IlluminantKind::E:
            return 1.0;
        case IlluminantKind::D65:
            break;
    }
    return white_light(nm);
}

/// The integral over the visible range.
template <class Value>
Value integral(const Illuminant& illuminant, Value (*seen)(double)) {
    Value sum{};
    for (double nm = kShortestWave + 0.5; nm < kLongestWave; nm += 1.0) {
        sum += relative(illuminant, nm) * seen(nm);
    }
    return sum;
}

double luminance_of(const Illuminant& illuminant) {
    // Caches the last illuminant, which is often requested repeatedly.
    struct Cached {
        IlluminantKind kind = IlluminantKind::E;
        double kelvin = -1, luminance = 1;
    };
    thread_local Cached cached;
    if (cached.kind != illuminant.kind || cached.kelvin != illuminant.kelvin) {
        cached = {illuminant.kind, illuminant.kelvin, integral(illuminant, luminance_response)};
    }
    return cached.luminance;
}

}  // namespace

double radiance_of(const Illuminant& illuminant, double nm) {
    return illuminant.scale / luminance_of(illuminant) * relative(illuminant, nm);
}

Rgb color_of(const Illuminant& illuminant) {
    return (illuminant.scale / luminance_of(illuminant)) * integral(illuminant, response);
}

Rgb color_in_gamut(const Illuminant& illuminant) {
    const Rgb color = color_of(illuminant);
    const Rgb positive{std::max(color.r, 0.0), std::max(color.g, 0.0), std::max(color.b, 0.0)};
    if (positive == color) return color;
    return (illuminant.scale / luminance_of(positive)) * positive;
}

}  // namespace alhazen
