#pragma once
/// A smooth surface that reflects into one direction: an ideal mirror, a smooth metal, the smooth
/// face of an opaque body.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, section 1.5 (for the exact
/// terms of optics/fresnel.h).

#include <optional>

#include "alhazen/shading/bsdf/fresnel_term.h"
#include "alhazen/shading/bsdf/transport.h"

namespace alhazen {

struct Mirror {
    static constexpr bool kSingular = true, kTransmits = false;
    FresnelTerm fresnel;

    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
};

}  // namespace alhazen
