#pragma once
/// Phong's and Blinn's highlights as reciprocal, energy-conserving lobes: with colour 1 they
/// reflect all light.
///
/// Source: Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975; Blinn, "Models
/// of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977 (with the V-shaped
/// cavities of Torrance and Sparrow); Neumann, Neumann and Szirmay-Kalos, "Compact Metallic
/// Reflectance Models", Eurographics 1999 (division by the larger cosine). Differs: the energy that
/// a lobe loses below the horizon and in cavities is restored by a matt lobe (albedo_table.h).

#include <optional>

#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

class Phong {
  public:
    static constexpr bool kSingular = false, kTransmits = false;

    Phong() : Phong(20) {}
    /// `exponent`: 0 to 10^6.
    explicit Phong(double exponent);

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

  private:
    double exponent_, alpha_, mean_missing_;
};

class BlinnPhong {
  public:
    static constexpr bool kSingular = false, kTransmits = false;

    BlinnPhong() : BlinnPhong(80) {}
    explicit BlinnPhong(double exponent);

    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;

  private:
    double exponent_, alpha_, mean_missing_;
};

}  // namespace alhazen
