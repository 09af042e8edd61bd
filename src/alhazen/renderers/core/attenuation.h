#pragma once
/// Attenuation of light along a distance, per channel.

#include <cmath>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Beer's law: exp(-absorption * distance). A channel without absorption has 1 even at infinite
/// distance.
[[nodiscard]] inline Rgb transmittance(const Rgb& absorption, double distance) {
    const auto of = [&](double a) { return a > 0.0 ? std::exp(-a * distance) : 1.0; };
    return {of(absorption.r), of(absorption.g), of(absorption.b)};
}

[[nodiscard]] inline Rgb power(const Rgb& base, double exponent) {
    return {std::pow(base.r, exponent), std::pow(base.g, exponent), std::pow(base.b, exponent)};
}

}  // namespace alhazen
