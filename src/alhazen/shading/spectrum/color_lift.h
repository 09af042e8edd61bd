#pragma once
/// Conversion of RGB colours to smooth reflectance spectra of a three-parameter family.
///
/// Source: Jakob and Hanika, "A Low-Dimensional Function Space for Efficient Spectral Upsampling",
/// Eurographics 2019.
/// Differs: the coefficients of a colour are found by Newton's method on demand, starting from
/// those of a coarse table that is filled on demand: the colour of the reflectance under white
/// light matches the argument up to kLiftError. Integrals are sums over 43 wavelengths with weights
/// that are exact for parabolas between them.
/// Conventions: reflectances lie in 0..1, and so do the channels of colours (others are clamped). A
/// grey has the same reflectance at all wavelengths.
/// Threads: all functions may be called concurrently.

#include <cmath>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Largest error of a channel of a lifted colour, for channels in 0..1.
inline constexpr double kLiftError = 1e-3;

/// 1/2 + p / (2 sqrt(1 + p^2)) of the polynomial p = (a t + b) t + c, t = (nm - 580) / 200.
struct SmoothReflectance {
    double a = 0, b = 0, c = 0;

    [[nodiscard]] static double place(double nm) { return (nm - 580.0) / 200.0; }
    /// `t`: the value of `place`.
    [[nodiscard]] double at(double t) const {
        const double p = (a * t + b) * t + c;
        return 0.5 + 0.5 * p / std::sqrt(1.0 + p * p);
    }
};

/// The reflectance of a colour that is not grey; recent results are cached.
[[nodiscard]] SmoothReflectance lifted(const Rgb& color);

/// The reflectance of a colour whose largest channel is 1/2, as used for lights: interpolated in a
/// fine table without Newton's method, because the colours of pictures and skies seldom repeat.
/// Recent results are cached.
[[nodiscard]] SmoothReflectance lifted_half(const Rgb& color);

/// The colour of a reflectance under white light, by the quadrature of `lifted`.
[[nodiscard]] Rgb color_of(const SmoothReflectance& reflectance);

}  // namespace alhazen
