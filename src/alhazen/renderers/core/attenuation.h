#pragma once
/// Attenuation of light along a distance, per channel.

#include <cmath>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Beer's law: exp(-absorption * distance).
[[nodiscard]] inline Rgb transmittance(const Rgb& absorption, double distance) {
    return {std::exp(-absorption.r * distance), std::exp(-absorption.g * distance),
            std::exp(-absorption.b * distance)};
}

[[nodiscard]] inline Rgb power(const Rgb& base, double exponent) {
    return {std::pow(base.r, exponent), std::pow(base.g, exponent), std::pow(base.b, exponent)};
}

}  // namespace alhazen
