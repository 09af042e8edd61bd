#include "alhazen/shading/bsdf/fresnel_term.h"

#include <algorithm>

#include "alhazen/base/overloaded.h"
#include "alhazen/shading/optics/fresnel.h"
#include "alhazen/shading/optics/thin_film.h"

namespace alhazen {

namespace {

Spectrum at(const SchlickTerm& t, double cosine) {
    return t.f0 + schlick_weight(cosine) * (t.f90 - t.f0);
}
Spectrum at(const ConstantTerm&, double) {
    return Spectrum::all(1);
}
Spectrum at(const ConductorTerm& t, double cosine) {
    Spectrum result;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const bool again =
            i > 0 && t.index[i] == t.index[i - 1] && t.extinction[i] == t.extinction[i - 1];
        result[i] =
            again ? result[i - 1] : conductor_reflectance(cosine, t.index[i], t.extinction[i]);
    }
    return result;
}
Spectrum at(const DielectricTerm& t, double cosine) {
    const double r = dielectric_reflectance(cosine, t.eta);
    return Spectrum::all(r);
}
Spectrum at(const FilmTerm& t, double cosine) {
    const Spectrum& f0 = t.base.f0;
    if (t.nm.a > 0.0) {
        Spectrum film;
        for (int i = 0; i < Spectrum::kCount; ++i) {
            film[i] = thin_film_reflectance_at(t.nm[i], cosine, t.index, t.thickness_nm, f0[i]);
        }
        return (1.0 - t.share) * at(t.base, cosine) + t.share * film;
    }
    const Rgb c = thin_film_reflectance(cosine, t.index, t.thickness_nm, {f0.a, f0.b, f0.c});
    const Spectrum film{c.r, c.g, c.b, c.b};
    return (1.0 - t.share) * at(t.base, cosine) + t.share * film;
}

/// f90 with which Schlick's formula equals `value` at this cosine; blends to the usual 1 where the
/// formula hardly depends on it.
Spectrum f90_through(const Spectrum& f0, const Spectrum& value, double cosine) {
    const double w = schlick_weight(cosine);
    Spectrum result;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const double exact = w > 0.0 ? f0[i] + (value[i] - f0[i]) / w : 1.0;
        const double trust = std::min(1.0, 20.0 * w);
        result[i] = std::clamp(1.0 + trust * (exact - 1.0), 0.0, 1.0);
    }
    return result;
}

}  // namespace

Spectrum reflectance(const FresnelTerm& term, double cosine) {
    return std::visit([&](const auto& t) { return at(t, cosine); }, term);
}

SchlickTerm schlick_fit(const FresnelTerm& term, double cosine) {
    return std::visit(Overloaded{[](const SchlickTerm& t) { return t; },
                                 [](const ConstantTerm&) { return SchlickTerm{}; },
                                 [&](const FilmTerm& t) {
                                     // A film's colour depends on the angle: fitted at the view,
                                     // not at normal incidence.
                                     const Spectrum now = at(t, cosine);
                                     const double w = std::min(schlick_weight(cosine), 0.5);
                                     SchlickTerm fit{{}, {1, 1, 1, 1}};
                                     for (int i = 0; i < Spectrum::kCount; ++i) {
                                         fit.f0[i] = std::clamp((now[i] - w) / (1.0 - w), 0.0, 1.0);
                                     }
                                     return fit;
                                 },
                                 [&](const auto& t) {
                                     const Spectrum f0 = at(t, 1.0);
                                     return SchlickTerm{f0, f90_through(f0, at(t, cosine), cosine)};
                                 }},
                      term);
}

Spectrum mean_reflectance(const FresnelTerm& term) {
    const auto of_schlick = [](const SchlickTerm& t) {
        return t.f0 + (1.0 / 21.0) * (t.f90 - t.f0);
    };
    // Three-point Gauss-Legendre quadrature of the integral of 2 R(c) c.
    const auto by_quadrature = [](const auto& t) {
        constexpr double kPoints[] = {0.11270166537925831, 0.5, 0.88729833462074169};
        constexpr double kWeights[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
        Spectrum sum;
        for (int i = 0; i < 3; ++i) sum += 2.0 * kPoints[i] * kWeights[i] * at(t, kPoints[i]);
        return sum;
    };
    const auto of_constant = [](const ConstantTerm&) { return Spectrum::all(1); };
    return std::visit(Overloaded{of_schlick, of_constant, by_quadrature}, term);
}

}  // namespace alhazen
