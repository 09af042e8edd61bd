#include "alhazen/renderers/light_transport/scatter_point.h"

#include <cmath>

namespace alhazen {

namespace {

std::uint64_t part_of(const Surface& surface) {
    return std::uint64_t{surface.instance} << 32 | surface.part;
}

/// The BSDF at the point; of blended materials their weighted sum.
Bsdf bsdf_at(const Scene& scene, const Surface& surface, const BsdfPlace& place) {
    const SurfaceLookup lookup{
        {surface.uv, surface.uv2}, {}, surface.color, {surface.point, {}, {}}};
    const auto of = [&](std::size_t i) {
        return bsdf_of(scene.materials[static_cast<std::size_t>(surface.materials[i])],
                       scene.textures, lookup, place);
    };
    if (surface.material_count == 1) return of(0);
    Bsdf sum;
    for (std::size_t i = 0; i < 3; ++i) sum.add(of(i), surface.weights[i]);
    return sum;
}

}  // namespace

void ScatterPoint::set(const Scene& scene, const ShadingPoint& point, const MediumStack& media,
                       const Wavelengths& waves, bool both_ways) {
    const Surface& surface = point.surface;
    const MaterialSample& material = *point.material;
    geometric_ = point.geometric;
    view_ = point.view;
    entering_ = point.entering;
    thin_ = material.thin;
    one_sided_ = is_unseen_from_behind(material);
    const bool has_tangent = surface.tangent != Vec3{};
    frame_ = ShadingFrame::of(point.normal, has_tangent ? surface.tangent : surface.dpdu);
    local_view_ = frame_.to_local(view_);
    inside_ = {part_of(surface), material.index, material.absorption,
               static_cast<std::uint32_t>(surface.materials[0])};
    media_known_ = point.behind.known;
    BsdfPlace place{.from_inside = !entering_, .waves = waves};
    if (media_known_) {
        behind_inside_ = point.behind.inside;
        inside_.absorption = point.behind.absorption;
        if (const auto& after = surface.media.after) {
            inside_.material = static_cast<std::uint32_t>(*after);
        }
        place.eta = point.behind.eta;
    } else if (!thin_ && material.index > 0.0) {
        const double air = scene.conventions.shading.air_index;
        const Medium* const around = entering_ ? media.here() : media.without(inside_);
        const double outside = around != nullptr ? around->index : air;
        place.eta = entering_ ? outside / material.index : material.index / outside;
    }
    bsdf_ = bsdf_at(scene, surface, place);
    from_behind_.reset();
    if (!both_ways || !bsdf_.has_density() || !bsdf_.transmits()) return;
    place.from_inside = entering_;
    if (place.eta > 0.0) place.eta = 1.0 / place.eta;
    from_behind_ = bsdf_at(scene, surface, place);
}

Spectrum ScatterPoint::value(const Vec3& direction, Transport transport) const {
    const Vec3 local = frame_.to_local(direction);
    if (!sides_agree(direction, local)) return {};
    return std::abs(local.z) * bsdf_.value(local_view_, local, transport);
}

double ScatterPoint::density(const Vec3& direction) const {
    const Vec3 local = frame_.to_local(direction);
    return sides_agree(direction, local) ? bsdf_.density(local_view_, local) : 0.0;
}

double ScatterPoint::reverse_density(const Vec3& direction) const {
    const Vec3 local = frame_.to_local(direction);
    if (!sides_agree(direction, local)) return 0.0;
    if (local.z > 0.0) return bsdf_.density(local, local_view_);
    const auto turned = [](const Vec3& v) { return Vec3{v.x, v.y, -v.z}; };
    return from_behind_ ? from_behind_->density(turned(local), turned(local_view_)) : 0.0;
}

std::optional<Scattered> ScatterPoint::sample(double choice, const Vec2& u,
                                              Transport transport) const {
    const std::optional<BsdfSample> drawn = bsdf_.sample(local_view_, choice, u, transport);
    if (!drawn) return std::nullopt;
    Scattered s{frame_.to_world(drawn->direction), drawn->weight, drawn->density, drawn->singular,
                drawn->direction.z < 0.0,          drawn->eta,    false};
    s.straight = s.singular && s.transmitted && thin_;
    if (s.straight) {
        s.direction = -view_;
    } else if (!sides_agree(s.direction, drawn->direction)) {
        return std::nullopt;
    }
    return s;
}

double ScatterPoint::importance_correction(const Vec3& direction) const {
    const double shading = std::abs(local_view_.z * dot(direction, geometric_));
    const double geometric = std::abs(dot(view_, geometric_) * dot(direction, frame_.z));
    return geometric > 0.0 ? shading / geometric : 0.0;
}

void ScatterPoint::cross(MediumStack& media) const {
    if (thin_) return;
    if (media_known_) {
        media = {};
        if (behind_inside_) media.enter(inside_);
    } else if (entering_) {
        media.enter(inside_);
    } else {
        media.leave(inside_);
    }
}

}  // namespace alhazen
