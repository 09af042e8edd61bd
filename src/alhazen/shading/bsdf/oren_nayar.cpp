#include "alhazen/shading/bsdf/oren_nayar.h"

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

namespace {

/// A of Fujii's form.
double flatness(double roughness) {
    return 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * kPi)) * roughness);
}
/// Albedo of the single-scattering lobe of colour 1.
double single_bounce(double mu, double roughness) {
    const double c = std::clamp(mu, 0.0, 1.0), s = std::sqrt(1.0 - c * c);
    // (s / c) (1 - s^3), rearranged to avoid 0 / 0.
    const double tangent = s * c * (1.0 + s + s * s) / (1.0 + s);
    const double g = s * (std::acos(c) - s * c) + (2.0 / 3.0) * (tangent - s);
    return flatness(roughness) * (1.0 + roughness / kPi * g);
}
double mean_single_bounce(double roughness) {
    return flatness(roughness) * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * kPi)) * roughness);
}
/// Colour of the multiple scattering.
Spectrum several_bounces(const Spectrum& color, double mean) {
    Spectrum result;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const double c = color[i];
        result[i] = c * c * mean / (1.0 - c * (1.0 - mean));
    }
    return result;
}

}  // namespace

Spectrum OrenNayar::value(const Vec3& view, const Vec3& direction, Transport) const {
    if (!(direction.z > 0.0)) return {};
    const double s = dot(view, direction) - view.z * direction.z;
    const double over = s > 0.0 ? s / std::max(view.z, direction.z) : s;
    const double mean = mean_single_bounce(roughness);
    const double rest = matt_rest(1.0 - single_bounce(view.z, roughness),
                                  1.0 - single_bounce(direction.z, roughness), 1.0 - mean);
    return flatness(roughness) / kPi * (1.0 + roughness * over) * color +
           rest * several_bounces(color, mean);
}

double OrenNayar::density(const Vec3&, const Vec3& direction) const {
    return cosine_density(direction);
}

std::optional<BsdfSample> OrenNayar::sample(const Vec3& view, double, const Vec2& u,
                                            Transport transport) const {
    const Vec3 direction = cosine_direction(u);
    return BsdfSample{direction, kPi * value(view, direction, transport),
                      cosine_density(direction)};
}

Spectrum OrenNayar::albedo(const Vec3& view) const {
    const double one = single_bounce(view.z, roughness);
    return one * color + (1.0 - one) * several_bounces(color, mean_single_bounce(roughness));
}

}  // namespace alhazen
