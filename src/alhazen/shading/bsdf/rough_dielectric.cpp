#include "alhazen/shading/bsdf/rough_dielectric.h"

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/dielectric_albedo.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

/// The microfacet that refracts `view` to `direction` below; empty if there is none.
struct RefractingFacet {
    Vec3 normal;
    double view_cosine = 0, cosine = 0;  ///< cosine: of the direction, below 0
    double stretch = 0;                  ///< solid angle of normals over that of directions
};

std::optional<RefractingFacet> refracting_facet(const Vec3& view, const Vec3& direction,
                                                double eta) {
    Vec3 h = eta * view + direction;
    const double size = length(h);
    if (!(size > 0.0)) return std::nullopt;
    h = h / (h.z > 0.0 ? size : -size);
    const double v = dot(view, h), l = dot(direction, h);
    if (!(v > 0.0 && l < 0.0 && h.z > 0.0)) return std::nullopt;
    const double sum = l + eta * v;
    return RefractingFacet{h, v, l, -l / (sum * sum)};
}

}  // namespace

RoughDielectric::RoughDielectric(double alpha, double eta, const Spectrum& reflection,
                                 const Spectrum& transmission)
    : ggx_{std::clamp(alpha, kSmoothAlpha, 1.0), std::clamp(alpha, kSmoothAlpha, 1.0)},
      eta_(eta),
      reflection_(reflection),
      transmission_(transmission),
      mean_missing_(1.0 - mean_dielectric_albedo(ggx_.x, eta)),
      mean_missing_behind_(1.0 - mean_dielectric_albedo(ggx_.x, 1.0 / eta)) {
    if (!(mean_missing_ > 0.0) || !(mean_missing_behind_ > 0.0)) return;
    // Ratio of through_ on the two sides, as f / index^2 is symmetric.
    const double ratio = eta * eta * mean_missing_ / mean_missing_behind_;
    const double clear = 1.0 - normal_reflectance_of(eta);
    through_ = clear * std::min(1.0, 1.0 / ratio);
}

double RoughDielectric::reflection_choice(double reflected, double transmitted) const {
    const double r = reflected * reflection_.max(), t = transmitted * transmission_.max();
    return r + t > 0.0 ? r / (r + t) : 1.0;
}
double RoughDielectric::missing(double mu) const {
    return 1.0 - dielectric_albedo(mu, ggx_.x, eta_).sum;
}
double RoughDielectric::missing_behind(double mu) const {
    return 1.0 - dielectric_albedo(mu, ggx_.x, 1.0 / eta_).sum;
}

RoughDielectric::Facet RoughDielectric::facet_value(const Vec3& view, const Vec3& direction) const {
    if (direction.z > 0.0) {
        const Vec3 m = normalize(view + direction);
        const double cosine = dot(view, m);
        const double one =
            0.5 * ggx_.normals(m) * dielectric_reflectance(cosine, eta_) /
            (view.z * ggx_.stretched_length(direction) + direction.z * ggx_.stretched_length(view));
        return {one, cosine};
    }
    const auto facet = refracting_facet(view, direction, eta_);
    if (!facet) return {};
    // D G (1 - F) (v.h) |l.h| / (v.z |l.z| (...)^2), with the cosines of the masking cancelled.
    const double masking = 2.0 / (-direction.z + ggx_.stretched_length(direction));
    return {(1.0 - dielectric_reflectance(facet->view_cosine, eta_)) * facet->stretch * masking *
                ggx_.visible_normals(view, facet->normal, facet->view_cosine),
            facet->view_cosine};
}

RoughDielectric::OneFacet RoughDielectric::one_facet(const Vec3& view, const Vec3& direction,
                                                     Transport transport) const {
    const Facet facet = facet_value(view, direction);
    if (direction.z > 0.0) return {facet.value * reflection_, facet.cosine};
    const double radiance = transport == Transport::Radiance ? eta_ * eta_ : 1.0;
    return {(radiance * facet.value) * transmission_, facet.cosine};
}

Spectrum RoughDielectric::value(const Vec3& view, const Vec3& direction,
                                Transport transport) const {
    const double one = facet_value(view, direction).value;
    if (direction.z > 0.0) {
        const double more =
            matt_rest(missing(view.z), missing(direction.z), mean_missing_) * (1.0 - through_);
        return (one + more) * reflection_;
    }
    double sum =
        through_ * matt_rest(missing(view.z), missing_behind(-direction.z), mean_missing_behind_);
    sum += one;
    if (transport == Transport::Radiance) sum *= eta_ * eta_;
    return sum * transmission_;
}

double RoughDielectric::density(const Vec3& view, const Vec3& direction) const {
    const double share = 1.0 - missing(view.z);
    const double matt = reflection_choice(1.0 - through_, through_);
    if (direction.z > 0.0) {
        const Vec3 m = normalize(view + direction);
        const double r = dielectric_reflectance(dot(view, m), eta_);
        const double one = 0.5 * ggx_.normals(m) / (view.z + ggx_.stretched_length(view));
        return share * reflection_choice(r, 1.0 - r) * one +
               (1.0 - share) * matt * cosine_density(direction);
    }
    double one = 0;
    if (const auto facet = refracting_facet(view, direction, eta_)) {
        const double r = dielectric_reflectance(facet->view_cosine, eta_);
        one = (1.0 - reflection_choice(r, 1.0 - r)) * facet->stretch *
              ggx_.visible_normals(view, facet->normal, facet->view_cosine);
    }
    return share * one + (1.0 - share) * (1.0 - matt) * cosine_density(flipped(direction));
}

std::optional<BsdfSample> RoughDielectric::sample(const Vec3& view, double choice, const Vec2& u,
                                                  Transport transport) const {
    const double share = 1.0 - missing(view.z);
    Vec3 direction;
    if (choice < share) {
        const double rest = remaining_below(choice, share);
        const Vec3 m = ggx_.sample_visible(view, u);
        double behind = 0;
        const double r = dielectric_reflectance(dot(view, m), eta_, behind);
        const bool up = rest < reflection_choice(r, 1.0 - r);
        direction = up ? mirrored(view, m) : refracted(view, m, behind, eta_);
        if (up != (direction.z > 0.0)) return std::nullopt;
    } else {
        const double rest = remaining_above(choice, share);
        direction = cosine_direction(u);
        if (!(rest < reflection_choice(1.0 - through_, through_))) direction = flipped(direction);
    }
    if (direction.z == 0.0) return std::nullopt;
    const double p = density(view, direction);
    return BsdfSample{direction, (std::abs(direction.z) / p) * value(view, direction, transport), p,
                      false, direction.z < 0.0 ? 1.0 / eta_ : 1.0};
}

Spectrum RoughDielectric::albedo(const Vec3& view) const {
    const DielectricAlbedo one = dielectric_albedo(view.z, ggx_.x, eta_);
    const double rest = 1.0 - one.sum;
    return (one.reflected + rest * (1.0 - through_)) * reflection_ +
           (one.sum - one.reflected + rest * through_) * transmission_;
}

}  // namespace alhazen
