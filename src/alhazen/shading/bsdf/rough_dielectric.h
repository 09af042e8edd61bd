#pragma once
/// A rough boundary between two clear media: microfacets that reflect and refract, and a matt part
/// each way for the light that meets several of them.
///
/// Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007,
/// equations 20 and 21; Kulla and Conty, "Revisiting Physically Based Shading at Imageworks",
/// SIGGRAPH 2017 course (the matt parts).
/// Differs: the shares of the matt parts follow from reciprocity, radiance over the square of the
/// index being what is equal both ways.

#include <optional>

#include "alhazen/shading/bsdf/transport.h"
#include "alhazen/shading/microfacets/ggx.h"

namespace alhazen {

class RoughDielectric {
  public:
    static constexpr bool kSingular = false, kTransmits = true;

    RoughDielectric() : RoughDielectric(0.1, 1.0 / 1.5, {1, 1, 1, 1}, {1, 1, 1, 1}) {}
    /// `eta`: index on the side of the view over that behind; not nearer to 1 than 1e-3 (there is
    /// no boundary to speak of). Tints: of what is reflected, of what is transmitted.
    RoughDielectric(double alpha, double eta, const Spectrum& reflection,
                    const Spectrum& transmission);

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

    /// The part of `value` that met one facet, and the cosine of the view to that facet's normal.
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
    /// Without tint and without the change of radiance.
    [[nodiscard]] Facet facet_value(const Vec3& view, const Vec3& direction) const;
    /// Probability of reflection, of two ways with these shares.
    [[nodiscard]] double reflection_choice(double reflected, double transmitted) const;
    [[nodiscard]] double missing(double mu) const;
    [[nodiscard]] double missing_behind(double mu) const;

    Ggx ggx_;
    double eta_ = 1;
    Spectrum reflection_, transmission_;
    double mean_missing_ = 0, mean_missing_behind_ = 0;
    double through_ = 0;  ///< share of the matt parts that is transmitted
};

}  // namespace alhazen
