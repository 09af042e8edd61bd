#include "alhazen/shading/optics/thin_film.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

/// Index of a dielectric in air with this reflectance at normal incidence.
double index_of(double reflectance) {
    const double root = std::sqrt(std::clamp(reflectance, 0.0, 0.9999));
    return (1.0 + root) / (1.0 - root);
}

/// Fourier transform of the eye's sensitivities x, y, z at an optical path difference (nm) and a
/// phase shift, relative to those without a film; as linear sRGB.
Rgb sensitivity(double path_nm, const Rgb& shift) {
    // Gaussians in the wave number: weight, centre and variance of x, y, z; x has a second one.
    constexpr double kWeight[] = {5.4856e-13, 4.4201e-13, 5.2481e-13};
    constexpr double kCentre[] = {1.6810e+06, 1.7953e+06, 2.2084e+06};
    constexpr double kVariance[] = {4.3278e+09, 9.3046e+09, 6.6121e+09};
    const double phase = 2.0 * kPi * path_nm * 1e-9;
    double xyz[3];
    for (int i = 0; i < 3; ++i) {
        xyz[i] = kWeight[i] * std::sqrt(2.0 * kPi * kVariance[i]) *
                 std::cos(kCentre[i] * phase + shift[i]) * std::exp(-kVariance[i] * phase * phase);
    }
    xyz[0] += 9.7470e-14 * std::sqrt(2.0 * kPi * 4.5282e+09) *
              std::cos(2.2399e+06 * phase + shift[0]) * std::exp(-4.5282e+09 * phase * phase);
    for (double& value : xyz) value /= 1.0685e-7;
    return {3.2404542 * xyz[0] - 1.5371385 * xyz[1] - 0.4985314 * xyz[2],
            -0.9692660 * xyz[0] + 1.8760108 * xyz[1] + 0.0415560 * xyz[2],
            0.0556434 * xyz[0] - 0.2040259 * xyz[1] + 1.0572252 * xyz[2]};
}

}  // namespace

double thin_film_reflectance_at(double nm, double cosine, double film_index, double thickness_nm,
                                double base) {
    const double c = std::clamp(cosine, 0.0, 1.0), index = film_index;
    const double squared = 1.0 - (1.0 - c * c) / (index * index);
    if (!(squared > 0.0)) return 1.0;
    const double inside = std::sqrt(squared);
    const double r12 = dielectric_reflectance(c, 1.0 / index);
    const double ratio = index_of(base) / index;
    const double at_normal = normal_reflectance_of(ratio);
    const double r23 = at_normal + (1.0 - at_normal) * schlick_weight(inside);
    const double shift = (index < 1.0 ? 0.0 : kPi) + (ratio < 1.0 ? kPi : 0.0);
    const double phase = 2.0 * kPi * 2.0 * index * thickness_nm * inside / nm + shift;
    const double r123 = std::min(r12 * r23, 0.99999),
                 through = (1.0 - r12) * (1.0 - r12) * r23 / (1.0 - r123);
    // The sum of q^m cos(m phase) over m = 1, 2, ...
    const double q = std::sqrt(r123), cosine_of_phase = std::cos(phase);
    const double series = (q * cosine_of_phase - q * q) / (1.0 - 2.0 * q * cosine_of_phase + q * q);
    return std::clamp(r12 + through + 2.0 * (through - (1.0 - r12)) * series, 0.0, 1.0);
}

Rgb thin_film_reflectance(double cosine, double film_index, double thickness_nm, const Rgb& base) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    // The index tends to that of air as the thickness tends to 0.
    const double vanish = std::clamp(thickness_nm / 30.0, 0.0, 1.0);
    const double index = 1.0 + (film_index - 1.0) * vanish * vanish * (3.0 - 2.0 * vanish);
    const double squared = 1.0 - (1.0 - c * c) / (index * index);
    if (!(squared > 0.0)) return {1, 1, 1};
    const double inside = std::sqrt(squared);

    // Upper side: reflectance, transmittance, phase shifts (0 or pi) from above and below.
    const double r12 = dielectric_reflectance(c, 1.0 / index);
    const double t121 = 1.0 - r12;
    const double phase21 = index < 1.0 ? 0.0 : kPi;
    // Lower side, with the index of a dielectric of the base's reflectance.
    Rgb r23, shift;
    for (int i = 0; i < 3; ++i) {
        const double ratio = index_of(base[i]) / index;
        const double at_normal = normal_reflectance_of(ratio);
        r23[i] = at_normal + (1.0 - at_normal) * schlick_weight(inside);
        shift[i] = phase21 + (ratio < 1.0 ? kPi : 0.0);
    }
    const double path_nm = 2.0 * index * thickness_nm * inside;

    Rgb sum, power;
    for (int i = 0; i < 3; ++i) {
        const double r123 = std::min(r12 * r23[i], 0.99999);
        const double through = t121 * t121 * r23[i] / (1.0 - r123);
        sum[i] = r12 + through;
        power[i] = through - t121;
    }
    for (int order = 1; order <= 2; ++order) {
        const Rgb term = sensitivity(order * path_nm, double(order) * shift);
        for (int i = 0; i < 3; ++i) {
            power[i] *= std::sqrt(std::min(r12 * r23[i], 0.99999));
            sum[i] += 2.0 * power[i] * term[i];
        }
    }
    return {std::clamp(sum.r, 0.0, 1.0), std::clamp(sum.g, 0.0, 1.0), std::clamp(sum.b, 0.0, 1.0)};
}

}  // namespace alhazen
