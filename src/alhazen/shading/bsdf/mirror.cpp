#include "alhazen/shading/bsdf/mirror.h"

#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

std::optional<BsdfSample> Mirror::sample(const Vec3& view, double, const Vec2&, Transport) const {
    return BsdfSample{mirrored(view), albedo(view), 1.0, true};
}
Spectrum Mirror::albedo(const Vec3& view) const {
    return reflectance(fresnel, view.z);
}

}  // namespace alhazen
