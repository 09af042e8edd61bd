#pragma once
/// A smooth boundary between two clear media: reflects by Fresnel's equations and refracts the
/// rest; all is reflected beyond the critical angle.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, section 1.5; Veach 1997,
/// section 5.2 (radiance changes by eta^2 where it is refracted, importance does not).

#include <optional>

#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

struct SmoothDielectric {
    static constexpr bool kSingular = true, kTransmits = true;
    double eta = 1;  ///< index on the side of the view over that behind
    Spectrum reflection_tint{1, 1, 1, 1}, transmission_tint{1, 1, 1, 1};
    /// False: Whitted's refraction, of which nothing is reflected but beyond the critical angle.
    bool fresnel = true;

    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
    /// What `sample` gives for either side, times its probability.
    struct Shares {
        Spectrum reflected, transmitted;
        double cosine_behind = 0;
    };
    [[nodiscard]] Shares shares(const Vec3& view, Transport transport) const;
};

/// A sheet so thin that light leaves it in the direction in which it came.
struct ThinSheet {
    static constexpr bool kSingular = true, kTransmits = true;
    Spectrum tint{1, 1, 1, 1};

    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
};

}  // namespace alhazen
