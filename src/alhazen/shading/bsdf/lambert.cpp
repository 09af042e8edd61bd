#include "alhazen/shading/bsdf/lambert.h"

#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

Spectrum Lambert::value(const Vec3&, const Vec3& direction, Transport) const {
    return direction.z > 0.0 ? (1.0 / kPi) * color : Spectrum{};
}
double Lambert::density(const Vec3&, const Vec3& direction) const {
    return cosine_density(direction);
}
std::optional<BsdfSample> Lambert::sample(const Vec3&, double, const Vec2& u, Transport) const {
    const Vec3 direction = cosine_direction(u);
    return BsdfSample{direction, color, cosine_density(direction)};
}
Spectrum Lambert::albedo(const Vec3&) const {
    return color;
}

Spectrum LambertTransmission::value(const Vec3&, const Vec3& direction, Transport) const {
    return direction.z < 0.0 ? (1.0 / kPi) * color : Spectrum{};
}
double LambertTransmission::density(const Vec3&, const Vec3& direction) const {
    return cosine_density(flipped(direction));
}
std::optional<BsdfSample> LambertTransmission::sample(const Vec3&, double, const Vec2& u,
                                                      Transport) const {
    const Vec3 direction = cosine_direction(u);
    return BsdfSample{flipped(direction), color, cosine_density(direction)};
}
Spectrum LambertTransmission::albedo(const Vec3&) const {
    return color;
}

}  // namespace alhazen
