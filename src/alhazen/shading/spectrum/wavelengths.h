#pragma once
/// What the four numbers of a Spectrum stand for along a path, and how colours become those
/// numbers and they a colour: channels of colours, or four wavelengths.
///
/// Source: Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014; Jakob and Hanika, "A
/// Low-Dimensional Function Space for Efficient Spectral Upsampling", Eurographics 2019.
/// Differs: the four lie a quarter apart in the distribution of what is seen of white light
/// (color_matching.h), not in nanometres. Directions are drawn by what all four say together, so
/// that all have the same density; where an index disperses only the hero, the first, goes on, and
/// counts four times: the density with which another of them would have found that way is 0.
/// Conventions: colours are linear sRGB. Colours of surfaces are their reflectances under white
/// light; lights are white light, filtered, or have spectra of their own (illuminant.h). A grey is
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
    /// The channels of colours.
    Wavelengths() = default;
    /// Four wavelengths; `u` in [0, 1) chooses the hero.
    [[nodiscard]] static Wavelengths drawn(double u);
    /// One at which all is seen, for tests.
    [[nodiscard]] static Wavelengths single(double nm);

    [[nodiscard]] bool is_spectral() const { return spectral_; }
    /// Of the four; only of those that are spectral.
    [[nodiscard]] double nm(int i) const { return nm_[i]; }
    /// 0 of channels.
    [[nodiscard]] const Spectrum& all_nm() const { return nm_; }

    /// Of a surface or a filter.
    [[nodiscard]] Spectrum reflectance(const Rgb& color) const {
        return spectral_ ? lifted_reflectance(color) : channels(color);
    }
    /// Of a light, whose white is that of the picture.
    [[nodiscard]] Spectrum emission(const Rgb& color) const {
        return spectral_ ? lifted_emission(color) : channels(color);
    }
    /// Of a light whose spectrum is known: of its colour the luminance counts then, where there are
    /// wavelengths.
    [[nodiscard]] Spectrum emission(const Rgb& color,
                                    const std::optional<Illuminant>& illuminant) const {
        return spectral_ && illuminant ? spectrum_of(*illuminant, color) : emission(color);
    }
    /// Coefficients of Beer's law, of any size.
    [[nodiscard]] Spectrum absorption(const Rgb& color) const {
        return spectral_ ? lifted_of_any_size(color) : channels(color);
    }
    /// Of a metal, from its values at the wavelengths that stand for the channels (metals.h):
    /// linear between them, and constant beyond.
    [[nodiscard]] Spectrum optical_constant(const Rgb& value) const {
        return spectral_ ? between_channels(value) : channels(value);
    }
    /// Indices of refraction; all the same without wavelengths, or where only the hero counts.
    [[nodiscard]] Spectrum index(double index_d, const Dispersion& dispersion) const;

    /// The colour that light adds to the picture.
    [[nodiscard]] Rgb color(const Spectrum& light) const {
        return spectral_ ? seen(light) : Rgb{light.a, light.b, light.c};
    }

    /// Only the hero goes on; it then carries the light of all four.
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
    std::array<Rgb, Spectrum::kCount> seen_{};  ///< colour of light 1 at each
};

/// For what knows of no path.
inline const Wavelengths kColorChannels;

}  // namespace alhazen
