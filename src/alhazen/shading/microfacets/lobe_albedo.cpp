#include "alhazen/shading/microfacets/lobe_albedo.h"

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/cubic_table.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

namespace {

double exponent_of_alpha(double alpha) {
    return 2.0 / (alpha * alpha) - 2.0;
}
Vec3 view_at(double mu) {
    return {std::sqrt(std::max(0.0, 1.0 - mu * mu)), 0, mu};
}

/// Mean of f(cosine to the pole, angle around it, their weight) where the cosines have a density in
/// proportion to cosine^(power - 1): substitutes u = cosine^power, and covers half the turn, by
/// symmetry.
template <class F>
double mean_around_pole(double power, const F& f) {
    static const GaussLegendre<48> cosines;
    static const GaussLegendre<96> turns;
    double sum = 0;
    for (std::size_t i = 0; i < cosines.points.size(); ++i) {
        // Denser where the cosine is small: u = t^2.
        const double t = cosines.points[i], c = std::pow(t, 2.0 / power);
        for (std::size_t j = 0; j < turns.points.size(); ++j) {
            sum += 2.0 * t * cosines.weights[i] * turns.weights[j] * f(c, kPi * turns.points[j]);
        }
    }
    return sum;
}

double integrate_phong(double mu, double alpha) {
    const double n = exponent_of_alpha(alpha);
    const Vec3 r = mirrored(view_at(mu));
    const Vec3 across{-r.z, 0, r.x};  // in the plane of incidence; y is the other
    return mean_around_pole(n + 1.0, [&](double c, double turn) {
        const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
        const Vec3 l = c * r + s * std::cos(turn) * across + Vec3{0, s * std::sin(turn), 0};
        return l.z > 0.0 ? l.z / std::max(l.z, mu) : 0.0;
    });
}

double integrate_blinn(double mu, double alpha) {
    const double n = exponent_of_alpha(alpha);
    const Vec3 v = view_at(mu);
    return mean_around_pole(n + 2.0, [&](double c, double turn) {
        const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
        const Vec3 h{s * std::cos(turn), s * std::sin(turn), c};
        const double vh = dot(v, h), lz = mirrored(v, h).z;
        if (!(vh > 0.0 && lz > 0.0)) return 0.0;
        return std::min({vh / (mu * c), 2.0, 2.0 * lz / mu});
    });
}

/// Below this roughness fibres are so thin that the lobe is invisible.
double usable_sheen(double roughness) {
    return std::clamp(roughness, 0.05, 1.0);
}
/// Tables begin below it, so that they are smooth there.
constexpr double kLeastTabled = 0.02;

/// Charlie's lobe as the source has it.
double charlie_lobe(double mu_view, double mu_light, double half, double roughness);

/// The albedo of the lobe `f` of cosines of the view, the light and the half vector.
template <class F>
double integrate_sheen(double mu, const F& lobe) {
    static const GaussLegendre<48> heights;
    static const GaussLegendre<32> turns;
    const Vec3 v = view_at(mu);
    double sum = 0;
    for (std::size_t i = 0; i < heights.points.size(); ++i) {
        const double t = heights.points[i], z = t * t, s = std::sqrt(1.0 - z * z);
        for (std::size_t j = 0; j < turns.points.size(); ++j) {
            const double turn = kPi * turns.points[j];
            const Vec3 l{s * std::cos(turn), s * std::sin(turn), z};
            const double f = lobe(mu, z, normalize(v + l).z);
            sum += 4.0 * kPi * t * z * heights.weights[i] * turns.weights[j] * f;
        }
    }
    return sum;
}

/// The part of the angles and roughnesses in which Charlie's lobe may have an albedo above 1.
constexpr double kGrazing = 0.08, kThinFibres = 0.3;

/// The factor by which Charlie's albedo exceeds 1 there; 1 where it does not.
double charlie_excess(double mu, double roughness) {
    if (mu >= kGrazing || roughness >= kThinFibres) return 1.0;
    // A / (1 + A) of the albedo A is bounded.
    static const CubicTable<2> table({24, 16}, [](const std::array<double, 2>& p) {
        const double r = kLeastTabled + p[1] * (kThinFibres - kLeastTabled);
        const double a = integrate_sheen(
            std::max(kGrazing * p[0] * p[0], AlbedoAxes::kLeastMu),
            [&](double v, double l, double half) { return charlie_lobe(v, l, half, r); });
        return a / (1.0 + a);
    });
    const double share = table.at(
        {std::sqrt(mu / kGrazing), (roughness - kLeastTabled) / (kThinFibres - kLeastTabled)});
    return std::max(1.0, share / (1.0 - share));
}

/// Shadowing among the fibres, for one direction.
double fibre_shadow(double mu, double roughness) {
    const double t = (1.0 - roughness) * (1.0 - roughness);
    const auto mix = [&](double smooth, double rough) { return rough + t * (smooth - rough); };
    const double a = mix(25.3245, 21.5473), b = mix(3.32435, 3.82987), c = mix(0.16801, 0.19823);
    const double d = mix(-1.27393, -1.97760), e = mix(-4.85967, -4.32054);
    const auto l = [&](double x) { return a / (1.0 + b * std::pow(x, c)) + d * x + e; };
    return std::exp(mu < 0.5 ? l(mu) : 2.0 * l(0.5) - l(1.0 - mu));
}

double charlie_lobe(double mu_view, double mu_light, double half, double r) {
    const double power = 1.0 / (r * r);
    const double sine_squared = std::max(0.0, 1.0 - half * half);
    const double normals = (2.0 + power) / (2.0 * kPi) * std::pow(sine_squared, 0.5 * power);
    const double visible =
        1.0 / (1.0 + fibre_shadow(mu_view, r * r) + fibre_shadow(mu_light, r * r));
    return normals * visible / (4.0 * mu_view * mu_light);
}

const AlbedoTable& phong_table() {
    static const AlbedoTable made(integrate_phong);
    return made;
}
const AlbedoTable& blinn_table() {
    static const AlbedoTable made(integrate_blinn);
    return made;
}
/// Albedo of the lobe divided by the excess at the light only, which is smooth in `mu`, times
/// kSheenScale: it may exceed 1.
constexpr double kSheenScale = 0.25;
const AlbedoTable& sheen_table() {
    static const AlbedoTable made([](double mu, double roughness) {
        const double r = std::max(roughness, kLeastTabled);
        return kSheenScale * integrate_sheen(mu, [&](double v, double l, double half) {
                   return charlie_lobe(v, l, half, r) / charlie_excess(l, r);
               });
    });
    return made;
}

}  // namespace

double alpha_of_exponent(double exponent) {
    return std::sqrt(2.0 / (std::max(exponent, 0.0) + 2.0));
}

double phong_albedo(double mu, double alpha) {
    return phong_table().at(mu, alpha);
}
double mean_phong_albedo(double alpha) {
    return phong_table().mean(alpha);
}
double blinn_albedo(double mu, double alpha) {
    return blinn_table().at(mu, alpha);
}
double mean_blinn_albedo(double alpha) {
    return blinn_table().mean(alpha);
}
double sheen_albedo(double mu, double roughness) {
    const double r = usable_sheen(roughness);
    return sheen_table().at(mu, r) / (kSheenScale * charlie_excess(mu, r));
}

double phong_lobe(double mu_view, double mu_light, double between, double exponent) {
    if (!(between > 0.0)) return 0.0;
    return (exponent + 1.0) / (2.0 * kPi) * std::pow(between, exponent) /
           std::max(mu_view, mu_light);
}

double blinn_lobe(double mu_view, double mu_light, double half, double view_half, double exponent) {
    if (!(half > 0.0 && view_half > 0.0)) return 0.0;
    // The factor G / (mu mu) of D G / (4 mu mu).
    const double cavities = std::min(1.0 / (mu_view * mu_light),
                                     2.0 * half / (view_half * std::max(mu_view, mu_light)));
    return (exponent + 2.0) / (8.0 * kPi) * std::pow(half, exponent) * cavities;
}

double sheen_lobe(double mu_view, double mu_light, double half, double roughness) {
    const double r = usable_sheen(roughness);
    return charlie_lobe(mu_view, mu_light, half, r) /
           (charlie_excess(mu_view, r) * charlie_excess(mu_light, r));
}

}  // namespace alhazen
