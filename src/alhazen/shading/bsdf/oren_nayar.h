#pragma once
/// Rough matt surfaces, of flatter shading than Lambert's (like the full moon).
///
/// Source: Oren and Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994; in the
/// form of Portsmouth, Kutz and Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT
/// 14(1), 2025, equations 8 to 21 (Fujii's form, with multiple scattering).
/// Differs: directions are sampled with density cosine / pi.

#include <optional>

#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

struct OrenNayar {
    static constexpr bool kSingular = false, kTransmits = false;
    Spectrum color{1, 1, 1, 1};  ///< 0..1
    double roughness = 0;        ///< 0 (Lambert) to 1

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
};

}  // namespace alhazen
