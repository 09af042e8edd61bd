#pragma once
/// A rough boundary between two clear media: microfacets that reflect and refract, and a matt lobe
/// on each side for multiple scattering.
///
/// Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007,
/// equations 20 and 21; Kulla and Conty, "Revisiting Physically Based Shading at Imageworks",
/// SIGGRAPH 2017 course (the matt parts).
/// Differs: the reflected and transmitted shares of the matt lobes follow from reciprocity of
/// radiance over the squared index.

#include <optional>

#include "alhazen/shading/bsdf/transport.h"
#include "alhazen/shading/microfacets/ggx.h"

namespace alhazen {

class RoughDielectric {
  public:
    static constexpr bool kSingular = false, kTransmits = true;

    RoughDielectric() : RoughDielectric(0.1, 1.0 / 1.5, {1, 1, 1, 1}, {1, 1, 1, 1}) {}
    /// `eta`: index on the side of the view over that behind, at least 1e-3 away from 1 (nearer to
    /// 1 the boundary vanishes). Tints: of the reflected and of the transmitted light.
    RoughDielectric(double alpha, double eta, const Spectrum& reflection,
                    const Spectrum& transmission);

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

    /// The single-scattering part of `value`, and the cosine of the view to the facet's normal.
    struct OneFacet {
        Spectrum value;
        double cosine = 0;
    };
    [[nodiscard]] OneFacet one_facet(const Vec3& view, const Vec3& direction,
                                     Transport transport) const;
    [[nodiscard]] double eta() const { return eta_; }

  private:
    struct Facet {
        double value = 0, cosine = 0;
    };
    /// Without tint and without the change of radiance by eta^2.
    [[nodiscard]] Facet facet_value(const Vec3& view, const Vec3& direction) const;
    /// Probability of reflection, given the two shares.
    [[nodiscard]] double reflection_choice(double reflected, double transmitted) const;
    [[nodiscard]] double missing(double mu) const;
    [[nodiscard]] double missing_behind(double mu) const;

    Ggx ggx_;
    double eta_ = 1;
    Spectrum reflection_, transmission_;
    double mean_missing_ = 0, mean_missing_behind_ = 0;
    double through_ = 0;  ///< transmitted share of the matt lobes
};

}  // namespace alhazen
