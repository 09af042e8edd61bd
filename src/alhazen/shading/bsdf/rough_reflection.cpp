#include "alhazen/shading/bsdf/rough_reflection.h"

#include "alhazen/shading/microfacets/anisotropic_albedo.h"
#include "alhazen/shading/microfacets/anisotropic_split.h"
#include "alhazen/shading/microfacets/ggx_albedo.h"
#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

RoughReflection::RoughReflection(const Ggx& ggx, const FresnelTerm& fresnel, const Vec2& axis)
    : ggx_{std::clamp(ggx.x, kSmoothAlpha, 1.0), std::clamp(ggx.y, kSmoothAlpha, 1.0)},
      fresnel_(fresnel),
      axis_(axis),
      mean_alpha_(std::sqrt(ggx_.x * ggx_.y)),
      mean_single_(is_anisotropic() ? mean_anisotropic_albedo(ggx_)
                                    : ggx_mean_albedo(mean_alpha_).sum()) {
    const Spectrum mean = mean_reflectance(fresnel);
    for (int i = 0; i < Spectrum::kCount; ++i) {
        several_[i] = mean[i] * mean[i] * mean_single_ / (1.0 - mean[i] * (1.0 - mean_single_));
    }
}

double RoughReflection::single(const Vec3& turned_view) const {
    return is_anisotropic() ? anisotropic_albedo(turned_view, ggx_)
                            : ggx_albedo_sum(turned_view.z, mean_alpha_);
}

RoughReflection::OneFacet RoughReflection::one_facet(const Vec3& view,
                                                     const Vec3& direction) const {
    if (!(direction.z > 0.0)) return {};
    const Vec3 v = turned(view), l = turned(direction);
    const Vec3 m = normalize(v + l);
    // D G / (4 cos cos), with the cosines of G cancelled.
    const double one =
        0.5 * ggx_.normals(m) / (v.z * ggx_.stretched_length(l) + l.z * ggx_.stretched_length(v));
    const double cosine = dot(v, m);
    return {one * reflectance(fresnel_, cosine), cosine};
}

Spectrum RoughReflection::value(const Vec3& view, const Vec3& direction, Transport) const {
    if (!(direction.z > 0.0)) return {};
    const double lost = 1.0 - mean_single_;
    const double more =
        lost > 0.0 ? (1.0 - single(turned(view))) * (1.0 - single(turned(direction))) / (kPi * lost)
                   : 0.0;
    return one_facet(view, direction).value + more * several_;
}

double RoughReflection::density(const Vec3& view, const Vec3& direction) const {
    if (!(direction.z > 0.0)) return 0.0;
    const Vec3 v = turned(view), l = turned(direction);
    const double one = 0.5 * ggx_.normals(normalize(v + l)) / (v.z + ggx_.stretched_length(v));
    const double share = single(v);
    return share * one + (1.0 - share) * cosine_density(l);
}

std::optional<Vec3> RoughReflection::direction(const Vec3& view, double choice,
                                               const Vec2& u) const {
    const Vec3 v = turned(view);
    const Vec3 l =
        choice < single(v) ? mirrored(v, ggx_.sample_visible(v, u)) : cosine_direction(u);
    if (!(l.z > 0.0)) return std::nullopt;
    return turned_back(l);
}

std::optional<BsdfSample> RoughReflection::sample(const Vec3& view, double choice, const Vec2& u,
                                                  Transport transport) const {
    const std::optional<Vec3> drawn = direction(view, choice, u);
    if (!drawn) return std::nullopt;
    const double p = density(view, *drawn);
    return BsdfSample{*drawn, (drawn->z / p) * value(view, *drawn, transport), p};
}

Spectrum RoughReflection::albedo(const Vec3& view) const {
    const SplitAlbedo one = is_anisotropic() ? anisotropic_split_albedo(turned(view), ggx_)
                                             : ggx_albedo(view.z, mean_alpha_);
    const SchlickTerm fit = schlick_fit(fresnel_, view.z);
    return one.at_f0 * fit.f0 + one.at_f90 * fit.f90 + (1.0 - one.sum()) * several_;
}

Spectrum RoughSheet::value(const Vec3& view, const Vec3& direction, Transport transport) const {
    return reflection_.value(view, flipped(direction), transport);
}
double RoughSheet::density(const Vec3& view, const Vec3& direction) const {
    return reflection_.density(view, flipped(direction));
}
std::optional<BsdfSample> RoughSheet::sample(const Vec3& view, double choice, const Vec2& u,
                                             Transport transport) const {
    auto sample = reflection_.sample(view, choice, u, transport);
    if (sample) sample->direction = flipped(sample->direction);
    return sample;
}
Spectrum RoughSheet::albedo(const Vec3& view) const {
    return reflection_.albedo(view);
}

}  // namespace alhazen
