#pragma once
/// Layers of the picture: the light of pixels by the kind of its path.
///
/// Source: Lafortune, "Mathematical Models and Monte Carlo Algorithms for Physically Based
/// Rendering", 1996 (light by the number and kind of its scatterings); the names are those of
/// compositing programs.
/// Conventions: emission, direct and indirect light (no, one, more scatterings) sum to the picture,
/// and so do emission, diffuse, specular and transmitted light, by the first scattering from the
/// eye. Straight passage through thin sheets and cut-outs is no scattering. The variance is that of
/// the mean of a pixel, for independent samples. Polarisation is that of the luminance: degree,
/// angle and Stokes vector of the mean of the samples. Threads: `add` may be called at the same
/// time for different pixels.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/imaging/film/sample_sum.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/estimator.h"
#include "alhazen/renderers/light_transport/polarized_path.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// The kind of the first scattering from the eye.
struct FirstScattering {
    bool transmitted = false;
    Spectrum diffuse{};  ///< share of diffuse lobes in the reflected light
};

/// The light of one sample.
struct LightParts {
    Spectrum emission;
    struct Scattered {
        Spectrum diffuse, specular, transmitted;
        void add(const Spectrum& light, const FirstScattering& first) {
            if (first.transmitted) {
                transmitted += light;
            } else {
                diffuse += first.diffuse * light;
                specular += light - first.diffuse * light;
            }
        }
        [[nodiscard]] Spectrum sum() const { return diffuse + specular + transmitted; }
    };
    Scattered direct, indirect;
    StokesLight polarized;  ///< sum of all parts; only with polarisation

    /// `scatterings`: number along the path.
    void add(const Spectrum& light, int scatterings, const FirstScattering& first) {
        if (scatterings == 0) {
            emission += light;
        } else {
            (scatterings == 1 ? direct : indirect).add(light, first);
        }
    }
};

class LightLayers {
  public:
    /// `mean_sign`: of the filter.
    LightLayers(const PixelBox& crop, const AovSet& wanted, double mean_sign);

    /// True if any of the layers is wanted.
    [[nodiscard]] static bool has_any(const AovSet& wanted);

    /// `radiance`: the sum of the parts as a colour.
    void add(const SampleId& id, const LightParts& parts, const Wavelengths& waves,
             const Rgb& radiance);
    void write(AovFilm& film) const;

  private:
    /// Sums over the samples of each pixel of the crop.
    struct Layer {
        AovKind kind;
        std::vector<Rgb> plain;
        std::vector<Rgb> with_signs;  ///< empty: all signs are 1
        std::vector<Rgb> squares;     ///< of LightVariance
    };
    [[nodiscard]] Layer layer_of(AovKind kind) const;
    static void add(Layer& layer, std::size_t pixel, const Rgb& light, double sign);
    [[nodiscard]] SampleSum sum_of(const Layer& layer, std::size_t pixel) const;
    void write_polarization(AovFilm& film, int x, int y, std::size_t pixel) const;

    PixelBox crop_;
    double mean_sign_;
    std::vector<Layer> layers_;
    std::optional<Layer> intensity_, stokes_;  ///< luminances of I, and of Q, U, V
    std::vector<double> signs_;                ///< [pixel] sums; empty: all are 1
    std::vector<std::uint32_t> counts_;
};

}  // namespace alhazen
