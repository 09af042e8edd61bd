#pragma once
/// Sheen: scattering by fibres that stand off a surface, strongest at grazing angles.
///
/// Source: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", Imageworks 2017 (the
/// distribution and the fit of its shadowing), as in KHR_materials_sheen: alpha is the squared
/// roughness; the terminator is not softened.
/// Differs: roughnesses below 0.05 count as 0.05. Where the lobe would scatter more light than it
/// gets (cosines below 0.06 and roughnesses below 0.25) it is divided by its albedo, at the view
/// and at the light, so that it stays reciprocal.

#include <optional>

#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

struct Sheen {
    static constexpr bool kSingular = false, kTransmits = false;
    Spectrum color{1, 1, 1, 1};
    double roughness = 0.5;  ///< 0..1

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
};

}  // namespace alhazen
