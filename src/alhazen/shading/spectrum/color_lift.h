#pragma once
/// Smooth reflectances for colours: of all that have the colour one that a few numbers describe.
///
/// Source: Jakob and Hanika, "A Low-Dimensional Function Space for Efficient Spectral Upsampling",
/// Eurographics 2019.
/// Differs: the coefficients of a colour are found by Newton's method when they are asked for, from
/// those of a coarse table, made where it is asked for: the colour of the reflectance under white
/// light is that of the argument (kLiftError), not only near it. Integrals are sums over 43
/// wavelengths with weights that are exact for parabolas between them.
/// Conventions: reflectances lie in 0..1, and so do the channels of colours (others are clipped).
/// A grey has the same reflectance at all wavelengths.
/// Threads: everything may be called from many.

#include <cmath>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Largest error of a channel of a lifted colour, for channels in 0..1.
inline constexpr double kLiftError = 1e-3;

/// 1/2 + p / (2 sqrt(1 + p^2)) of the polynomial p = (a t + b) t + c, t = (nm - 580) / 200.
struct SmoothReflectance {
    double a = 0, b = 0, c = 0;

    [[nodiscard]] static double place(double nm) { return (nm - 580.0) / 200.0; }
    /// `t`: of `place`.
    [[nodiscard]] double at(double t) const {
        const double p = (a * t + b) * t + c;
        return 0.5 + 0.5 * p / std::sqrt(1.0 + p * p);
    }
};

/// The reflectance of a colour that is no grey; remembers those of late.
[[nodiscard]] SmoothReflectance lifted(const Rgb& color);

/// Of a colour whose largest channel is 1/2, as lights have them: interpolated in a fine table
/// without more ado, for lights of pictures and skies are all different; remembers those of late.
[[nodiscard]] SmoothReflectance lifted_half(const Rgb& color);

/// The colour of a reflectance under white light, as `lifted` computes it.
[[nodiscard]] Rgb color_of(const SmoothReflectance& reflectance);

}  // namespace alhazen
