#pragma once
/// Lambertian surfaces: constant radiance in all directions, on the side of the light (reflection)
/// or on the other (transmission, as through paper).
///
/// Source: Lambert, "Photometria", 1760.

#include <optional>

#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

struct Lambert {
    static constexpr bool kSingular = false, kTransmits = false;
    Spectrum color{1, 1, 1, 1};

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
};

struct LambertTransmission {
    static constexpr bool kSingular = false, kTransmits = true;
    Spectrum color{1, 1, 1, 1};

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
};

}  // namespace alhazen
