#pragma once
/// Reflection by a rough metal, or by the rough face of any body: mirror-like microfacets, and a
/// matt lobe for multiple scattering.
///
/// Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007,
/// equation 20; Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
/// course (the matt lobe); Turquin, "Practical Multiple Scattering Compensation for Microfacet
/// Models", 2019 (its colour).
/// Differs: for unequal alphas the albedos depend on the azimuth of the direction too.

#include <optional>

#include "alhazen/shading/bsdf/fresnel_term.h"
#include "alhazen/shading/bsdf/transport.h"
#include "alhazen/shading/microfacets/ggx.h"

namespace alhazen {

class RoughReflection {
  public:
    static constexpr bool kSingular = false, kTransmits = false;

    RoughReflection() : RoughReflection({0.1, 0.1}, SchlickTerm{}) {}
    /// `axis`: unit tangent along which the roughness is ggx.x.
    RoughReflection(const Ggx& ggx, const FresnelTerm& fresnel, const Vec2& axis = {1, 0});

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    /// The direction of `sample`; empty if the light is absorbed.
    [[nodiscard]] std::optional<Vec3> direction(const Vec3& view, double choice,
                                                const Vec2& u) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

    /// The single-scattering part of `value`, and the cosine to the facet's normal.
    struct OneFacet {
        Spectrum value;
        double cosine = 0;
    };
    [[nodiscard]] OneFacet one_facet(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] const FresnelTerm& fresnel() const { return fresnel_; }
    [[nodiscard]] const Ggx& ggx() const { return ggx_; }
    [[nodiscard]] const Vec2& axis() const { return axis_; }
    [[nodiscard]] bool is_anisotropic() const { return ggx_.x != ggx_.y; }
    /// Geometric mean.
    [[nodiscard]] double mean_alpha() const { return mean_alpha_; }
    /// Mean over the hemisphere of the single-scattering albedo, whose deficit is the matt lobe.
    [[nodiscard]] double mean_single() const { return mean_single_; }
    /// Colour of the multiple scattering.
    [[nodiscard]] const Spectrum& several() const { return several_; }
    /// `v` in the frame of ggx().
    [[nodiscard]] Vec3 turned(const Vec3& v) const {
        return {axis_.x * v.x + axis_.y * v.y, axis_.x * v.y - axis_.y * v.x, v.z};
    }

  private:
    [[nodiscard]] Vec3 turned_back(const Vec3& v) const {
        return {axis_.x * v.x - axis_.y * v.y, axis_.x * v.y + axis_.y * v.x, v.z};
    }
    /// Single-scattering albedo for a view in the frame of ggx().
    [[nodiscard]] double single(const Vec3& turned_view) const;

    Ggx ggx_;
    FresnelTerm fresnel_;
    Vec2 axis_{1, 0};
    double mean_alpha_ = 0;
    double mean_single_ = 1;  ///< cosine-weighted mean of `single` over the hemisphere
    Spectrum several_;        ///< colour of the multiple scattering
};

/// Transmission through a sheet with rough faces: the lobe of RoughReflection mirrored to the other
/// side. Light is not bent.
class RoughSheet {
  public:
    static constexpr bool kSingular = false, kTransmits = true;

    RoughSheet() = default;
    /// `axis`: unit tangent along which the roughness is ggx.x.
    explicit RoughSheet(const Ggx& ggx, const Vec2& axis = {1, 0})
        : reflection_(ggx, SchlickTerm{}, axis) {}

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
