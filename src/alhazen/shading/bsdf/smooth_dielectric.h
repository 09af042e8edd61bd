#pragma once
/// A smooth boundary between two clear media: Fresnel reflection and refraction, with total
/// reflection beyond the critical angle.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, section 1.5; Veach 1997,
/// section 5.2 (refraction scales radiance by eta^2, importance not); Wilkie et al., "Hero
/// Wavelength Spectral Sampling", EGSR 2014 (the weights of reflection for a dispersive index: the
/// balance heuristic over the four choices of hero).

#include <optional>

#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

struct SmoothDielectric {
    static constexpr bool kSingular = true, kTransmits = true;
    double eta = 1;  ///< index on the side of the view over that behind
    Spectrum reflection_tint{1, 1, 1, 1}, transmission_tint{1, 1, 1, 1};
    /// False: Whitted's refraction, without reflection except beyond the critical angle.
    bool fresnel = true;
    /// `eta` of each wavelength, the first of which equals `eta`; empty if not dispersive.
    std::optional<Spectrum> etas;

    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
    /// Weights of reflection and transmission: those of `sample` times its probabilities.
    struct Shares {
        Spectrum reflected, transmitted;
        double cosine_behind = 0;
    };
    [[nodiscard]] Shares shares(const Vec3& view, Transport transport) const;
};

/// A thin sheet: transmitted light keeps its direction.
struct ThinSheet {
    static constexpr bool kSingular = true, kTransmits = true;
    Spectrum tint{1, 1, 1, 1};

    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
};

}  // namespace alhazen
