#include "alhazen/shading/bsdf/sheen.h"

#include "alhazen/shading/microfacets/lobe_albedo.h"
#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

// Directions are sampled uniformly over the hemisphere: the lobe is wide, and a cosine density
// would undersample grazing directions, where it is brightest.

Spectrum Sheen::value(const Vec3& view, const Vec3& direction, Transport) const {
    if (!(direction.z > 0.0)) return {};
    return sheen_lobe(view.z, direction.z, normalize(view + direction).z, roughness) * color;
}

double Sheen::density(const Vec3&, const Vec3& direction) const {
    return direction.z > 0.0 ? 1.0 / (2.0 * kPi) : 0.0;
}

std::optional<BsdfSample> Sheen::sample(const Vec3& view, double, const Vec2& u,
                                        Transport transport) const {
    const double z = 1.0 - u.x, s = std::sqrt(std::max(0.0, 1.0 - z * z));
    const Vec3 direction{s * std::cos(2.0 * kPi * u.y), s * std::sin(2.0 * kPi * u.y), z};
    return BsdfSample{direction, 2.0 * kPi * z * value(view, direction, transport),
                      1.0 / (2.0 * kPi)};
}

Spectrum Sheen::albedo(const Vec3& view) const {
    return sheen_albedo(view.z, roughness) * color;
}

}  // namespace alhazen
