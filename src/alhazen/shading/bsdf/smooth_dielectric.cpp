#include "alhazen/shading/bsdf/smooth_dielectric.h"

#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

double reflected_share(const SmoothDielectric& d, const Vec3& view, double& cosine_behind) {
    const double r = dielectric_reflectance(view.z, d.eta, cosine_behind);
    return d.fresnel || r == 1.0 ? r : 0.0;
}

}  // namespace

std::optional<BsdfSample> SmoothDielectric::sample(const Vec3& view, double choice, const Vec2&,
                                                   Transport transport) const {
    double cosine_behind = 0;
    const double r = reflected_share(*this, view, cosine_behind);
    // Chosen by what each gives: no ray is spent on a side whose tint is black.
    const double reflected = r * reflection_tint.max();
    const double transmitted = (1.0 - r) * transmission_tint.max();
    const double sum = reflected + transmitted;
    if (!(sum > 0.0)) return std::nullopt;
    const double share = reflected / sum;
    if (choice < share) {
        return BsdfSample{mirrored(view), (r / share) * reflection_tint, share, true};
    }
    const double radiance = transport == Transport::Radiance ? eta * eta : 1.0;
    return BsdfSample{refracted(view, {0, 0, 1}, cosine_behind, eta),
                      (radiance * (1.0 - r) / (1.0 - share)) * transmission_tint, 1.0 - share, true,
                      1.0 / eta};
}

SmoothDielectric::Shares SmoothDielectric::shares(const Vec3& view, Transport transport) const {
    Shares result;
    const double r = reflected_share(*this, view, result.cosine_behind);
    const double radiance = transport == Transport::Radiance ? eta * eta : 1.0;
    result.reflected = r * reflection_tint;
    result.transmitted = (radiance * (1.0 - r)) * transmission_tint;
    return result;
}

Spectrum SmoothDielectric::albedo(const Vec3& view) const {
    double cosine_behind = 0;
    const double r = reflected_share(*this, view, cosine_behind);
    return r * reflection_tint + (1.0 - r) * transmission_tint;
}

std::optional<BsdfSample> ThinSheet::sample(const Vec3& view, double, const Vec2&,
                                            Transport) const {
    return BsdfSample{-view, tint, 1.0, true};
}
Spectrum ThinSheet::albedo(const Vec3&) const {
    return tint;
}

}  // namespace alhazen
