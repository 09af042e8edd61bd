#pragma once
/// Reflection of a rough metal, or of the rough face of any body: microfacets that are mirrors
/// themselves, and a matt part for the light that meets several of them.
///
/// Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007,
/// equation 20; Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
/// course (the matt part; its colour as of Turquin, "Practical Multiple Scattering Compensation for
/// Microfacet Models", 2019).
/// Differs: of grooves (unequal alphas) the matt part is that of their geometric mean.

#include <optional>

#include "alhazen/shading/bsdf/fresnel_term.h"
#include "alhazen/shading/bsdf/transport.h"
#include "alhazen/shading/microfacets/ggx.h"

namespace alhazen {

class RoughReflection {
  public:
    static constexpr bool kSingular = false, kTransmits = false;

    RoughReflection() : RoughReflection({0.1, 0.1}, SchlickTerm{}) {}
    /// `axis`: the tangent along which the roughness is ggx.x, as a unit vector in the surface.
    RoughReflection(const Ggx& ggx, const FresnelTerm& fresnel, const Vec2& axis = {1, 0});

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    /// Of `sample`; none where the light is absorbed.
    [[nodiscard]] std::optional<Vec3> direction(const Vec3& view, double choice,
                                                const Vec2& u) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

    /// The part of `value` that met one facet, and the cosine to that facet's normal.
    struct OneFacet {
        Spectrum value;
        double cosine = 0;
    };
    [[nodiscard]] OneFacet one_facet(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] const FresnelTerm& fresnel() const { return fresnel_; }

  private:
    [[nodiscard]] Vec3 turned(const Vec3& v) const {
        return {axis_.x * v.x + axis_.y * v.y, axis_.x * v.y - axis_.y * v.x, v.z};
    }
    [[nodiscard]] Vec3 turned_back(const Vec3& v) const {
        return {axis_.x * v.x - axis_.y * v.y, axis_.x * v.y + axis_.y * v.x, v.z};
    }
    /// Share of the light that leaves after one facet, of a view at this cosine.
    [[nodiscard]] double single(double mu) const;

    Ggx ggx_;
    FresnelTerm fresnel_;
    Vec2 axis_{1, 0};
    double mean_alpha_ = 0;
    double mean_single_ = 1;  ///< mean of `single` over the hemisphere
    Spectrum several_;        ///< colour of light that met several facets
};

/// The same where the light goes on through a sheet of rough faces, in the mirror image of the
/// direction. Nothing is bent.
class RoughSheet {
  public:
    static constexpr bool kSingular = false, kTransmits = true;

    RoughSheet() = default;
    explicit RoughSheet(const Ggx& ggx) : reflection_(ggx, SchlickTerm{}) {}

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

  private:
    RoughReflection reflection_;
};

}  // namespace alhazen
