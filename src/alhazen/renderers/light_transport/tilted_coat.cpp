#include "alhazen/renderers/light_transport/tilted_coat.h"

#include <algorithm>

#include "alhazen/renderers/core/local_shading.h"

namespace alhazen {

namespace {

/// As in Bsdf: a coat that is opaque to the view hides the layers below from radiance only.
constexpr double kLeastBelow = 0.02;

double share_of(double coat, double through, double below) {
    const double rest = std::max(kLeastBelow, through) * below;
    const double sum = coat + rest;
    return coat > 0.0 ? (rest > 0.0 ? coat / sum : 1.0) : 0.0;
}

}  // namespace

TiltedCoat::TiltedCoat(const CoatLayer& layer, const Normals& normals, const Vec3& tangent,
                       const Vec3& view)
    : layer_(layer), normals_(normals), tangent_(tangent), view_(view) {
    const Vec3 seen = mapped_normal_seen(normals_.mapped, normals_.shading, view);
    turned_ = seen != normals_.mapped && seen != -normals_.mapped;
    frame_ = ShadingFrame::of(seen, tangent);
    local_view_ = frame_.to_local(view);
}

LocalDirections TiltedCoat::seen_from(const Vec3& direction) const {
    const Vec3 seen = mapped_normal_seen(normals_.mapped, normals_.shading, direction);
    const ShadingFrame frame = ShadingFrame::of(seen, tangent_);
    return {frame.to_local(view_), frame.to_local(direction)};
}

Spectrum TiltedCoat::value(const Vec3& direction) const {
    const Vec3 local = frame_.to_local(direction);
    if (!(local.z > 0.0) || !is_above(direction)) return {};
    return local.z * layer_.bsdf.value(local_view_, local, Transport::Radiance);
}

Spectrum TiltedCoat::value_seen_from(const Vec3& direction) const {
    if (!is_above(direction)) return {};
    const LocalDirections local = seen_from(direction);
    if (!(local.view.z > 0.0)) return {};
    return local.view.z * layer_.bsdf.value(local.direction, local.view, Transport::Radiance);
}

double TiltedCoat::density(const Vec3& direction) const {
    const Vec3 local = frame_.to_local(direction);
    if (!(local.z > 0.0) || !is_above(direction)) return 0.0;
    return layer_.bsdf.density(local_view_, local);
}

double TiltedCoat::reverse_density(const Vec3& direction) const {
    if (!is_above(direction)) return 0.0;
    const LocalDirections local = seen_from(direction);
    return local.view.z > 0.0 ? layer_.bsdf.density(local.direction, local.view) : 0.0;
}

double TiltedCoat::share(double below) const {
    return share_of(layer_.bsdf.albedo(local_view_).max(), through(), below);
}

double TiltedCoat::share_seen_from(const Vec3& direction, double below) const {
    const Vec3 local = seen_from(direction).direction;
    return share_of(layer_.bsdf.albedo(local).max(), layer_.cover.transmittance(local), below);
}

std::optional<TiltedCoat::Sample> TiltedCoat::sample(double choice, const Vec2& u) const {
    const auto drawn = layer_.bsdf.sample(local_view_, choice, u, Transport::Radiance);
    if (!drawn) return std::nullopt;
    const Vec3 direction = frame_.to_world(drawn->direction);
    if (!(drawn->direction.z > 0.0) || !is_above(direction)) return std::nullopt;
    return Sample{direction, *drawn};
}

bool TiltedCoat::mirrors_to(const Vec3& direction) const {
    if (!layer_.bsdf.has_singular()) return false;
    const Vec3 local = frame_.to_local(direction);
    const Vec3 mirrored{-local_view_.x, -local_view_.y, local_view_.z};
    return length_squared(local - mirrored) < 1e-18;
}

}  // namespace alhazen
