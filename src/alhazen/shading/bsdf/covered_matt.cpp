#include "alhazen/shading/bsdf/covered_matt.h"

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

CoveredMatt::CoveredMatt(const Spectrum& color, const Cover& cover)
    : color_(color), cover_(cover), mean_(cover.mean_transmittance()) {}

Spectrum CoveredMatt::value(const Vec3& view, const Vec3& direction, Transport) const {
    if (!(direction.z > 0.0)) return {};
    return matt_rest(cover_.transmittance(view), cover_.transmittance(direction), mean_) * color_;
}

double CoveredMatt::density(const Vec3&, const Vec3& direction) const {
    return cosine_density(direction);
}

std::optional<BsdfSample> CoveredMatt::sample(const Vec3& view, double, const Vec2& u,
                                              Transport transport) const {
    const Vec3 direction = cosine_direction(u);
    return BsdfSample{direction, kPi * value(view, direction, transport),
                      cosine_density(direction)};
}

Spectrum CoveredMatt::albedo(const Vec3& view) const {
    return cover_.transmittance(view) * color_;
}

}  // namespace alhazen
