#include "alhazen/shading/bsdf/phong.h"

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/lobe_albedo.h"
#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

namespace {

constexpr double kLargestExponent = 1e6;

/// Samples the density (power + 1) cosine^power / 2 pi around z.
Vec3 power_direction(const Vec2& u, double power) {
    const double z = std::pow(1.0 - u.x, 1.0 / (power + 1.0));
    const double s = std::sqrt(std::max(0.0, 1.0 - z * z)), angle = 2.0 * kPi * u.y;
    return {s * std::cos(angle), s * std::sin(angle), z};
}
Spectrum grey_spectrum(double x) {
    return Spectrum::all(x);
}

}  // namespace

Phong::Phong(double exponent)
    : exponent_(exponent > 0.0 ? std::min(exponent, kLargestExponent) : 0.0),
      alpha_(alpha_of_exponent(exponent_)),
      mean_missing_(1.0 - mean_phong_albedo(alpha_)) {}

Spectrum Phong::value(const Vec3& view, const Vec3& direction, Transport) const {
    if (!(direction.z > 0.0)) return {};
    return grey_spectrum(
        phong_lobe(view.z, direction.z, dot(mirrored(view), direction), exponent_) +
        matt_rest(1.0 - phong_albedo(view.z, alpha_), 1.0 - phong_albedo(direction.z, alpha_),
                  mean_missing_));
}

double Phong::density(const Vec3& view, const Vec3& direction) const {
    if (!(direction.z > 0.0)) return 0.0;
    const double between = dot(mirrored(view), direction);
    const double share = phong_albedo(view.z, alpha_);
    const double one =
        between > 0.0 ? (exponent_ + 1.0) / (2.0 * kPi) * std::pow(between, exponent_) : 0.0;
    return share * one + (1.0 - share) * cosine_density(direction);
}

std::optional<BsdfSample> Phong::sample(const Vec3& view, double choice, const Vec2& u,
                                        Transport transport) const {
    Vec3 direction;
    if (choice < phong_albedo(view.z, alpha_)) {
        const Vec3 r = mirrored(view), t = perpendicular(r), b = cross(r, t);
        const Vec3 local = power_direction(u, exponent_);
        direction = normalize(local.x * t + local.y * b + local.z * r);
    } else {
        direction = cosine_direction(u);
    }
    if (!(direction.z > 0.0)) return std::nullopt;
    const double p = density(view, direction);
    return BsdfSample{direction, (direction.z / p) * value(view, direction, transport), p};
}

Spectrum Phong::albedo(const Vec3&) const {
    return {1, 1, 1, 1};
}

BlinnPhong::BlinnPhong(double exponent)
    : exponent_(exponent > 0.0 ? std::min(exponent, kLargestExponent) : 0.0),
      alpha_(alpha_of_exponent(exponent_)),
      mean_missing_(1.0 - mean_blinn_albedo(alpha_)) {}

Spectrum BlinnPhong::value(const Vec3& view, const Vec3& direction, Transport) const {
    if (!(direction.z > 0.0)) return {};
    const Vec3 h = normalize(view + direction);
    return grey_spectrum(blinn_lobe(view.z, direction.z, h.z, dot(view, h), exponent_) +
                         matt_rest(1.0 - blinn_albedo(view.z, alpha_),
                                   1.0 - blinn_albedo(direction.z, alpha_), mean_missing_));
}

double BlinnPhong::density(const Vec3& view, const Vec3& direction) const {
    if (!(direction.z > 0.0)) return 0.0;
    const Vec3 h = normalize(view + direction);
    const double share = blinn_albedo(view.z, alpha_);
    const double one =
        (exponent_ + 2.0) / (8.0 * kPi) * std::pow(h.z, exponent_ + 1.0) / dot(view, h);
    return share * one + (1.0 - share) * cosine_density(direction);
}

std::optional<BsdfSample> BlinnPhong::sample(const Vec3& view, double choice, const Vec2& u,
                                             Transport transport) const {
    Vec3 direction;
    if (choice < blinn_albedo(view.z, alpha_)) {
        const Vec3 h = power_direction(u, exponent_ + 1.0);
        if (!(dot(view, h) > 0.0)) return std::nullopt;
        direction = mirrored(view, h);
    } else {
        direction = cosine_direction(u);
    }
    if (!(direction.z > 0.0)) return std::nullopt;
    const double p = density(view, direction);
    return BsdfSample{direction, (direction.z / p) * value(view, direction, transport), p};
}

Spectrum BlinnPhong::albedo(const Vec3&) const {
    return {1, 1, 1, 1};
}

}  // namespace alhazen
