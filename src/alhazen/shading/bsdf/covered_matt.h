#pragma once
/// A matt body below a reflecting face: the light that the face reflects is lost to the body on the
/// way in and again on the way out.
///
/// Source: Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with
/// Importance Sampling", Eurographics 2001.
/// Differs: light that the face reflects back down is accounted for by the same factors;
/// interreflection does not saturate the body's colour.
/// Conventions: with a white body, body and face together reflect all light.

#include <optional>

#include "alhazen/shading/bsdf/cover.h"
#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

class CoveredMatt {
  public:
    static constexpr bool kSingular = false, kTransmits = false;

    CoveredMatt() : CoveredMatt({1, 1, 1, 1}, {}) {}
    CoveredMatt(const Spectrum& color, const Cover& cover);

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

  private:
    Spectrum color_;
    Cover cover_;
    double mean_ = 1;  ///< transmittance of the cover
};

}  // namespace alhazen
