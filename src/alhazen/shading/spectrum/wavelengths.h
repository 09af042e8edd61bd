#pragma once
/// The meaning of the four components of a Spectrum (RGB channels or four wavelengths), and
/// conversion from and to RGB.
///
/// Source: Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014; Jakob and Hanika, "A
/// Low-Dimensional Function Space for Efficient Spectral Upsampling", Eurographics 2019.
/// Differs: the wavelengths are equidistant, one in each quarter, in the CDF of the visible
/// spectrum of white light (color_matching.h), not in nanometres. Directions are sampled by all
/// four together, so that all have the same density. At a dispersive interface only the hero, the
/// first wavelength, continues, with a weight of four: the density with which another would have
/// sampled that direction is 0.
/// Conventions: colours are linear sRGB. Colours of surfaces are their reflectances under white
/// light; lights are filtered white light, or have spectra of their own (illuminant.h). A grey is
/// the same at all wavelengths.

#include <array>
#include <optional>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/shading/optics/dispersion.h"
#include "alhazen/shading/optics/illuminant.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

struct DrawnWaves;

class Wavelengths {
  public:
    /// RGB channels.
    Wavelengths() = default;
    /// Four wavelengths; `u` in [0, 1) selects the hero.
    [[nodiscard]] static Wavelengths drawn(double u);
    /// One wavelength in all four components, for tests.
    [[nodiscard]] static Wavelengths single(double nm);

    [[nodiscard]] bool is_spectral() const { return spectral_; }
    /// Wavelength `i` of the four, in nanometres; spectral only.
    [[nodiscard]] double nm(int i) const { return nm_[i]; }
    /// All four, in nanometres; 0 for RGB channels.
    [[nodiscard]] const Spectrum& all_nm() const { return nm_; }

    /// Reflectance or transmittance of a surface or filter of this colour.
    [[nodiscard]] Spectrum reflectance(const Rgb& color) const {
        return spectral_ ? lifted_reflectance(color) : channels(color);
    }
    /// Emission of a light of this colour; white is D65.
    [[nodiscard]] Spectrum emission(const Rgb& color) const {
        return spectral_ ? lifted_emission(color) : channels(color);
    }
    /// Emission of a light with a known spectrum, scaled to the luminance of `color`; without a
    /// spectrum, or for RGB channels, that of `color`.
    [[nodiscard]] Spectrum emission(const Rgb& color,
                                    const std::optional<Illuminant>& illuminant) const {
        return spectral_ && illuminant ? spectrum_of(*illuminant, color) : emission(color);
    }
    /// Coefficients of Beer's law, of any size.
    [[nodiscard]] Spectrum absorption(const Rgb& color) const {
        return spectral_ ? lifted_of_any_size(color) : channels(color);
    }
    /// Optical constant of a metal, given at the wavelengths that stand for the channels
    /// (metals.h); linear between them and constant beyond.
    [[nodiscard]] Spectrum optical_constant(const Rgb& value) const {
        return spectral_ ? between_channels(value) : channels(value);
    }
    /// Indices of refraction; all equal for RGB channels and once only the hero continues.
    [[nodiscard]] Spectrum index(double index_d, const Dispersion& dispersion) const;

    /// Linear sRGB contribution of light to the pixel.
    [[nodiscard]] Rgb color(const Spectrum& light) const {
        return spectral_ ? seen(light) : Rgb{light.a, light.b, light.c};
    }

    /// Drops all wavelengths but the hero, which then carries the light of all four.
    void keep_hero(Spectrum& throughput) {
        if (hero_only_) return;
        hero_only_ = true;
        throughput = {Spectrum::kCount * throughput.a, 0, 0, 0};
    }
    [[nodiscard]] bool hero_only() const { return hero_only_; }

  private:
    [[nodiscard]] static Spectrum channels(const Rgb& c) { return {c.r, c.g, c.b, c.b}; }
    [[nodiscard]] Spectrum lifted_reflectance(const Rgb& color) const;
    [[nodiscard]] Spectrum lifted_of_any_size(const Rgb& color) const;
    [[nodiscard]] Spectrum lifted_emission(const Rgb& color) const {
        return white_ * lifted_of_any_size(color);
    }
    [[nodiscard]] Spectrum spectrum_of(const Illuminant& illuminant, const Rgb& color) const;
    [[nodiscard]] Spectrum between_channels(const Rgb& value) const;
    [[nodiscard]] Rgb seen(const Spectrum& light) const;
    explicit Wavelengths(const DrawnWaves& four);

    bool spectral_ = false, hero_only_ = false;
    Spectrum nm_, places_, white_;
    std::array<Rgb, Spectrum::kCount> seen_{};  ///< colour of unit light at each
};

/// RGB channels, for code without a path.
inline const Wavelengths kColorChannels;

}  // namespace alhazen
