#include "alhazen/shading/bsdf/smooth_dielectric.h"

#include <algorithm>

#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

double reflected_share(const SmoothDielectric& d, const Vec3& view, double eta,
                       double& cosine_behind) {
    const double r = dielectric_reflectance(view.z, eta, cosine_behind);
    return d.fresnel || r == 1.0 ? r : 0.0;
}

/// Probability of reflection, in proportion to the two contributions: no ray is traced to a side
/// whose tint is black. Below 0: both tints are black.
double reflection_choice(const SmoothDielectric& d, double r) {
    const double reflected = r * d.reflection_tint.max();
    const double transmitted = (1.0 - r) * d.transmission_tint.max();
    const double sum = reflected + transmitted;
    return sum > 0.0 ? reflected / sum : -1.0;
}

/// Contribution of reflection at each wavelength over the mean of its probabilities (the balance
/// heuristic): any of them may be the hero.
Spectrum reflection_of_all(const SmoothDielectric& d, const Vec3& view) {
    Spectrum reflected;
    double mean = 0.0;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        double behind = 0;
        reflected[i] = reflected_share(d, view, (*d.etas)[i], behind);
        mean += std::max(0.0, reflection_choice(d, reflected[i])) / Spectrum::kCount;
    }
    return (1.0 / mean) * (reflected * d.reflection_tint);
}

}  // namespace

std::optional<BsdfSample> SmoothDielectric::sample(const Vec3& view, double choice, const Vec2&,
                                                   Transport transport) const {
    double cosine_behind = 0;
    const double r = reflected_share(*this, view, eta, cosine_behind);
    const double share = reflection_choice(*this, r);
    if (share < 0.0) return std::nullopt;
    if (choice < share) {
        if (etas) return BsdfSample{mirrored(view), reflection_of_all(*this, view), share, true};
        return BsdfSample{mirrored(view), (r / share) * reflection_tint, share, true};
    }
    const double radiance = transport == Transport::Radiance ? eta * eta : 1.0;
    return BsdfSample{refracted(view, {0, 0, 1}, cosine_behind, eta),
                      (radiance * (1.0 - r) / (1.0 - share)) * transmission_tint,
                      1.0 - share,
                      true,
                      1.0 / eta,
                      etas.has_value()};
}

SmoothDielectric::Shares SmoothDielectric::shares(const Vec3& view, Transport transport) const {
    Shares result;
    const double r = reflected_share(*this, view, eta, result.cosine_behind);
    const double radiance = transport == Transport::Radiance ? eta * eta : 1.0;
    result.reflected = r * reflection_tint;
    result.transmitted = (radiance * (1.0 - r)) * transmission_tint;
    return result;
}

Spectrum SmoothDielectric::albedo(const Vec3& view) const {
    Spectrum r;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        double behind = 0;
        if (i == 0 || etas) r[i] = reflected_share(*this, view, etas ? (*etas)[i] : eta, behind);
        if (!etas) r[i] = r.a;
    }
    return r * reflection_tint + (Spectrum::all(1) - r) * transmission_tint;
}

std::optional<BsdfSample> ThinSheet::sample(const Vec3& view, double, const Vec2&,
                                            Transport) const {
    return BsdfSample{-view, tint, 1.0, true};
}
Spectrum ThinSheet::albedo(const Vec3&) const {
    return tint;
}

}  // namespace alhazen
