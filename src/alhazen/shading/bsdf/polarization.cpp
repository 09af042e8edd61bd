#include "alhazen/shading/bsdf/polarization.h"

#include <algorithm>
#include <cmath>

#include "alhazen/base/overloaded.h"
#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

namespace {

constexpr BoundaryMueller kUnchanged{0.0, 1.0, 1.0, 0.0};

/// Matrix of a clear body of this reflectance at normal incidence; of an ideal mirror if it is 1.
BoundaryMueller mueller_by_normal_reflectance(double reflectance, double cosine) {
    const double root = std::sqrt(std::clamp(reflectance, 0.0, 1.0));
    if (root > 0.999999) return {0.0, 1.0, -1.0, 0.0};
    return mueller_of(dielectric_reflection(cosine, (1.0 - root) / (1.0 + root)));
}

PlaneMueller by_normal_reflectance(const Spectrum& reflectance, double cosine) {
    PlaneMueller m;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        m.set(i, mueller_by_normal_reflectance(reflectance[i], cosine));
    }
    return m;
}

PlaneMueller polarization_at(const SchlickTerm& t, double cosine) {
    return by_normal_reflectance(t.f0, cosine);
}
PlaneMueller polarization_at(const ConstantTerm& t, double cosine) {
    return by_normal_reflectance(t.normal, cosine);
}
PlaneMueller polarization_at(const ConductorTerm& t, double cosine) {
    PlaneMueller m;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        m.set(i, mueller_of(conductor_reflection(cosine, t.index[i], t.extinction[i])));
    }
    return m;
}
PlaneMueller polarization_at(const DielectricTerm& t, double cosine) {
    return PlaneMueller::all(mueller_of(dielectric_reflection(cosine, t.eta)));
}
PlaneMueller polarization_at(const FilmTerm& t, double cosine) {
    return polarization_at(t.base, cosine);
}

PolarizedValue boundary_value(const SmoothDielectric& d, const Vec3& view, bool up) {
    PolarizedValue result;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const double eta = d.etas ? (*d.etas)[i] : d.eta;
        SmoothDielectric at = d;
        at.eta = eta;
        const SmoothDielectric::Shares shares = at.shares(view, Transport::Radiance);
        result.all[i] = up ? shares.reflected[i] : shares.transmitted[i];
        if (up) {
            result.matrix.set(i, mueller_of(dielectric_reflection(view.z, eta)));
        } else {
            // Whitted's refraction treats both polarisations alike.
            result.matrix.set(
                i, d.fresnel ? mueller_of(dielectric_refraction(view.z, eta)) : kUnchanged);
        }
    }
    result.part = result.all;
    return result;
}

PolarizedValue rough_boundary_value(const RoughDielectric& d, const Vec3& view,
                                    const Vec3& direction) {
    const RoughDielectric::OneFacet one = d.one_facet(view, direction, Transport::Radiance);
    const FresnelAmplitudes amplitudes = direction.z > 0.0
                                             ? dielectric_reflection(one.cosine, d.eta())
                                             : dielectric_refraction(one.cosine, d.eta());
    return {d.value(view, direction, Transport::Radiance), one.value,
            PlaneMueller::all(mueller_of(amplitudes))};
}

}  // namespace

PlaneMueller polarization_of(const FresnelTerm& term, double cosine) {
    return std::visit([&](const auto& t) { return polarization_at(t, cosine); }, term);
}

PolarizedValue polarized_value(const Lobe& lobe, const Vec3& view, const Vec3& direction) {
    const bool up = direction.z > 0.0;
    return std::visit(
        Overloaded{
            [&](const Mirror& m) {
                if (!up) return PolarizedValue{};
                const Spectrum r = m.albedo(view);
                return PolarizedValue{r, r, polarization_of(m.fresnel, view.z)};
            },
            [&](const SmoothDielectric& d) { return boundary_value(d, view, up); },
            [&](const ThinSheet& s) {
                if (up) return PolarizedValue{};
                return PolarizedValue{s.tint, s.tint, PlaneMueller::all(kUnchanged)};
            },
            [&](const RoughReflection& r) {
                const RoughReflection::OneFacet one = r.one_facet(view, direction);
                return PolarizedValue{r.value(view, direction, Transport::Radiance), one.value,
                                      polarization_of(r.fresnel(), one.cosine)};
            },
            [&](const RoughDielectric& d) { return rough_boundary_value(d, view, direction); },
            [&](const auto& l) {
                return PolarizedValue{l.value(view, direction, Transport::Radiance), {}, {}};
            }},
        lobe);
}

}  // namespace alhazen
