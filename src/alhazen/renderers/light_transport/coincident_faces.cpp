#include "alhazen/renderers/light_transport/coincident_faces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/light_transport/scattering_media.h"

namespace alhazen {

CoincidentFaces::CoincidentFaces(const Scene& scene) : scene_(scene) {
    if (std::none_of(scene.materials.begin(), scene.materials.end(), may_bound_volume)) return;
    std::vector<Kind> kinds;
    for (const Material& m : scene.materials) {
        kinds.push_back(may_bound_volume(m) ? Kind::BoundsVolume
                         : m.is_opaque()     ? Kind::Opaque
                                             : Kind::Neither);
    }
    kinds_ = std::make_shared<const std::vector<Kind>>(std::move(kinds));
}

void CoincidentFaces::find(const ShadingPoint& point, const Vec3& direction,
                           const Arrival& arrival, RayMask mask) {
    others_.clear();
    opaque_.reset();
    const Surface& surface = point.surface;
    const auto material = static_cast<std::size_t>(surface.materials[0]);
    if (!kinds_ || (*kinds_)[material] != Kind::BoundsVolume) return;
    if (point.behind.known || point.material->thin || point.material->coverage < 1.0) return;
    // Rays leave the surface 32 error bounds away from it (leaving_ray): what lies within meets
    // none of them.
    constexpr double kLeastCosine = 1e-3, kLeast = 0x1p-500;
    const double cosine = std::max(std::abs(dot(direction, surface.normal)), kLeastCosine);
    const double away = 32.0 * dot(abs(surface.normal), surface.error) / cosine;
    ray_ = {surface.point - away * direction, direction, 0.0, std::max(2.0 * away, kLeast)};
    hits_.clear();
    scene_.aggregate->all_hits(ray_, hits_, {nullptr, mask, arrival.time});
    const HitParts own{surface.part, surface.instance};
    for (const Hit& hit : hits_) {
        if (!(parts_of(*scene_.aggregate, hit) == own)) look_at(hit, arrival);
    }
}

void CoincidentFaces::look_at(const Hit& hit, const Arrival& arrival) {
    set_shading_point(scene_, ray_, hit, arrival, {}, other_);
    if (other_.behind.known || other_.material->thin || other_.material->coverage < 1.0) return;
    const auto material = static_cast<std::size_t>(other_.surface.materials[0]);
    if ((*kinds_)[material] == Kind::Opaque) {
        if (!opaque_) opaque_ = hit;
    } else if ((*kinds_)[material] == Kind::BoundsVolume && !others_.full()) {
        others_.push_back(OtherFace{ScatterPoint::volume_of(other_), other_.entering});
    }
}

}  // namespace alhazen
