#include "alhazen/renderers/light_transport/scatter_point.h"

#include <algorithm>
#include <cmath>

#include "alhazen/renderers/volumes/volume_bounds.h"
#include "alhazen/shading/bsdf/dispersing.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

SurfaceLookup lookup_at(const Surface& surface) {
    return {{surface.uv, surface.uv2}, {}, surface.color, {surface.point, {}, {}}};
}

/// Sets the BSDF at the point; for blended materials the weighted sum.
void make_bsdf(const Scene& scene, const Surface& surface, const BsdfPlace& place, Bsdf& bsdf) {
    const SurfaceLookup lookup = lookup_at(surface);
    const auto of = [&](std::size_t i) {
        return bsdf_of(scene.material_of(surface, i), scene.textures, lookup, place);
    };
    if (surface.material_count == 1) {
        bsdf = of(0);
        return;
    }
    bsdf = {};
    for (std::size_t i = 0; i < 3; ++i) bsdf.add(of(i), surface.weights[i]);
}

Spectrum over(const Spectrum& x, const Spectrum& y) {
    return {x.a / y.a, x.b / y.b, x.c / y.c, x.d / y.d};
}

/// True if boundaries between volumes of the same index are passed straight at the surface: in
/// scenes with scattering volumes, or if its materials may have the index of the air.
bool may_be_null_boundary(const Scene& scene, const Surface& surface) {
    if (scene.has_scattering) return true;
    for (std::size_t i = 0; i < std::size_t(surface.material_count); ++i) {
        if (!may_be_null_boundary(scene.material_of(surface, i),
                                  scene.conventions.shading.air_index)) {
            return false;
        }
    }
    return true;
}

/// BsdfPlace::mirrored, for materials that depend on it. By the sides of the interpolated normal: a
/// path from the other direction then sees the same grooves, whichever normals a map gives.
bool is_mirrored(const Scene& scene, const Surface& surface, const Vec3& view) {
    bool turned = false;
    for (int i = 0; i < surface.material_count; ++i) {
        const auto id = static_cast<std::size_t>(surface.materials[static_cast<std::size_t>(i)]);
        turned = turned || has_turned_grooves(scene.materials[id]);
    }
    if (!turned) return false;
    const auto [u, v] = groove_directions(scene, surface);
    const bool left_handed = dot(cross(surface.shading_normal, u), v) < 0.0;
    return left_handed != (dot(view, surface.shading_normal) < 0.0);
}

}  // namespace

void ScatterPoint::set_bsdf(const Scene& scene, const Surface& surface, const BsdfPlace& place,
                            BsdfCache* known) {
    shared_ = nullptr;
    if (known != nullptr && !surface.has_extras) {
        if (const Bsdf* const shared = known->find(surface.materials[0], place)) {
            if (known->keeps()) {
                shared_ = shared;
            } else {
                own_ = *shared;
            }
            return;
        }
    }
    make_bsdf(scene, surface, place, own_);
}

void ScatterPoint::set(const Scene& scene, const ShadingPoint& point, const MediumStack& media,
                       const Wavelengths& waves, bool both_ways, BsdfCache* known,
                       const OtherFaces* others, const ScatterPoint* sheet) {
    const Surface& surface = point.surface;
    const MaterialSample& material = *point.material;
    geometric_ = point.geometric;
    view_ = point.view;
    entering_ = point.entering;
    thin_ = material.thin;
    one_sided_ = is_unseen_from_behind(material);
    const Vec3 tangent = groove_directions(scene, surface).u;
    frame_ = ShadingFrame::of(point.normal, tangent);
    map_.reset();
    if (point.has_map) {
        const bool turned = point.normal != point.mapped && point.normal != -point.mapped;
        map_ = Map{point.mapped, surface.shading_normal, tangent, turned};
    }
    local_view_ = frame_.to_local(view_);
    inside_ = volume_of(scene, point);
    others_.clear();
    if (others != nullptr) others_ = *others;
    enters_volume_ = enters_volume(point);
    is_wall_ = is_wall(surface);
    media_known_ = point.behind.known;
    const bool refracts_at_sheet =
        thin_ && !others_.empty() && !(eta_of_faces(scene, media, waves) == Spectrum::all(1));
    if (refracts_at_sheet) others_.clear();
    const Spectrum all = etas(scene, point, media, waves);
    if (point.coat_is_tilted || sheet != nullptr || (thin_ && !others_.empty())) known = nullptr;
    const bool disperses = !(all == Spectrum::all(all.a));
    BsdfPlace place{.eta = all.a,
                    .from_inside = !entering_,
                    .mirrored = is_mirrored(scene, surface, view_),
                    .without_coat = point.coat_is_tilted,
                    .etas = disperses ? &all : nullptr,
                    .waves = waves};
    set_bsdf(scene, surface, place, known);
    needs_hero_ = disperses && bsdf().has_rough_boundary();
    if (needs_hero_) {
        place.etas = nullptr;
        set_bsdf(scene, surface, place, known);
    }
    tint_by_faces(waves, own_);
    if (sheet != nullptr) lay_below(*sheet, all.a, own_);
    set_coat(scene, point, tangent);
    only_changes_media_ = bsdf().lets_through() && !coat_ && all == Spectrum::all(1) && !thin_ &&
                          material.coverage >= 1.0 && material.emission.is_black() &&
                          !material.unlit && bsdf().refracts_alone();
    null_ = only_changes_media_ && may_be_null_boundary(scene, surface);
    yields_ = only_changes_media_ || (refracts_at_sheet && !bsdf().has_density() && !coat_ &&
                                      material.emission.is_black() && !material.unlit);
    from_behind_.reset();
    if (!both_ways || !bsdf().has_density() || !bsdf().transmits()) return;
    place.etas = nullptr;
    place.from_inside = entering_;
    if (place.eta > 0.0) place.eta = 1.0 / place.eta;
    if (const Bsdf* const shared = known != nullptr && !surface.has_extras
                                       ? known->find(surface.materials[0], place)
                                       : nullptr) {
        from_behind_ = *shared;
    } else {
        make_bsdf(scene, surface, place, from_behind_.emplace());
        tint_by_faces(waves, *from_behind_);
        if (sheet != nullptr) lay_below(*sheet, place.eta, *from_behind_);
    }
}

void ScatterPoint::tint_by_faces(const Wavelengths& waves, Bsdf& bsdf) const {
    for (const OtherFace& other : others_) {
        if (other.tints) bsdf.tint(Spectrum::all(1), waves.reflectance(other.kt));
    }
}

void ScatterPoint::lay_below(const ScatterPoint& sheet, double eta, Bsdf& bsdf) const {
    // Densities of rough surfaces must not depend on the view.
    const bool rough = bsdf.has_density(), from_dense = eta > 1.0 && !rough;
    Vec3 view = rough ? Vec3{0, 0, 1} : local_view_;
    if (from_dense) {
        view.x *= eta;
        view.y *= eta;
        const double cosine_squared = 1.0 - view.x * view.x - view.y * view.y;
        if (!(cosine_squared > 0.0)) return;
        view.z = std::sqrt(cosine_squared);
    }
    const Spectrum on_top = sheet.bsdf().singular(view, Transport::Radiance).reflected;
    const Spectrum through = sheet.bsdf().straight(view);
    if (rough && (thin_ || !bsdf.transmits())) {
        bsdf.tint(through * through, through);
        return bsdf.add(on_top, Mirror{ConstantTerm{on_top}});
    }
    const SingularLight below = bsdf.singular(local_view_, Transport::Importance);
    Spectrum reflected = Spectrum::all(1), transmitted, added;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const double once = rough ? 1.0 - on_top[i] : 1.0 - on_top[i] * below.reflected[i];
        if (!(once > 0.0)) {
            added[i] = 1.0;
            reflected[i] = 0.0;
            continue;
        }
        transmitted[i] = through[i] / once;
        if (from_dense) {
            added[i] = on_top[i] * below.transmitted[i] * below.transmitted[i] / once;
        } else {
            added[i] = on_top[i];
            reflected[i] = through[i] * transmitted[i];
        }
    }
    if (rough) return bsdf.tint(transmitted, transmitted);
    bsdf.tint(reflected, transmitted);
    bsdf.add(added, Mirror{ConstantTerm{added}});
}

Spectrum ScatterPoint::eta_of_faces(const Scene& scene, const MediumStack& media,
                                    const Wavelengths& waves) const {
    MediumStack behind = media;
    cross(behind);
    const auto index = [&](const Medium* m) {
        return m == nullptr ? Spectrum::all(scene.conventions.shading.air_index)
                            : index_of(scene.materials[m->material], m->index, waves);
    };
    return over(index(media.here()), index(behind.here()));
}

Spectrum ScatterPoint::etas(const Scene& scene, const ShadingPoint& point, const MediumStack& media,
                            const Wavelengths& waves) const {
    const double air = scene.conventions.shading.air_index;
    const auto material = [&](std::uint32_t i) -> const Material& { return scene.materials[i]; };
    const double own = point.material->index;
    if (!media_known_ && (thin_ || !(own > 0.0))) return {};
    if (!others_.empty()) return eta_of_faces(scene, media, waves);
    if (media_known_) {
        const SurfaceMedia& stated = point.surface.media;
        // Within another volume, the innermost, nothing changes.
        if (!enters_volume_ && media.within(inside_) != nullptr) return Spectrum::all(1);
        const Medium* const around = is_wall_         ? nullptr
                                     : enters_volume_ ? media.here()
                                                      : media.without(inside_);
        if (!waves.is_spectral() && around == nullptr) return Spectrum::all(point.behind.eta);
        const auto index = [&](const std::optional<MaterialId>& id) {
            if (!id && around == nullptr) return Spectrum::all(air);
            if (!id) return index_of(material(around->material), around->index, waves);
            const Material& m = material(static_cast<std::uint32_t>(*id));
            return index_of(m, value_at(m.index, scene.textures, lookup_at(point.surface)), waves);
        };
        return over(index(stated.before), index(stated.after));
    }
    const Medium* const around = entering_ ? media.here() : media.without(inside_);
    const double outside = around != nullptr ? around->index : air;
    // On the way out of an outer volume the view is in another, the innermost.
    const Medium* const within = entering_ ? nullptr : media.within(inside_);
    const double own_side = within != nullptr ? within->index : own;
    if (!waves.is_spectral()) {
        return Spectrum::all(entering_ ? outside / own : own_side / outside);
    }
    const Spectrum there = around != nullptr ? index_of(material(around->material), outside, waves)
                                             : Spectrum::all(air);
    const Spectrum here = within != nullptr
                              ? index_of(material(within->material), within->index, waves)
                              : index_of(material(inside_.material), own, waves);
    return entering_ ? over(there, here) : over(here, there);
}

void ScatterPoint::set_coat(const Scene& scene, const ShadingPoint& point, const Vec3& tangent) {
    coat_.reset();
    coat_share_ = 0.0;
    if (!point.coat_is_tilted) return;
    const Surface& surface = point.surface;
    const auto layer = coat_of(scene.materials[static_cast<std::size_t>(surface.materials[0])],
                               scene.textures, lookup_at(surface));
    if (!layer) return;
    coat_.emplace(*layer,
                  TiltedCoat::Normals{geometric_, surface.shading_normal, point.coat_mapped},
                  tangent, view_);
    coat_share_ = coat_->share(bsdf().albedo(local_view_).max());
}

ScatterPoint::Directions ScatterPoint::any_seen_from(const Vec3& direction) const {
    if (!map_) return {local_view_, frame_.to_local(direction)};
    const Vec3 seen = mapped_normal_seen(map_->mapped, map_->shading, direction);
    const bool same_side = dot(direction, geometric_) > 0.0;
    const ShadingFrame frame = ShadingFrame::of(same_side ? seen : -seen, map_->tangent);
    return {frame.to_local(view_), frame.to_local(direction)};
}

std::optional<ScatterPoint::Directions> ScatterPoint::seen_from(const Vec3& direction) const {
    const Directions local = any_seen_from(direction);
    if (!(local.view.z > 0.0)) return std::nullopt;
    return local;
}

Spectrum ScatterPoint::value(const Vec3& direction, Transport transport) const {
    if (!coat_) return value_below(direction, transport);
    if (transport == Transport::Radiance) {
        return coat_->value(direction) + coat_->through() * value_below(direction, transport);
    }
    return coat_->value_seen_from(direction) +
           coat_->through_to(direction) * value_below_seen_from(direction);
}

Spectrum ScatterPoint::value_below_seen_from(const Vec3& direction) const {
    const Directions local = any_seen_from(direction);
    if (map_ ? !(local.view.z > 0.0) : !sides_agree(direction, local.direction)) return {};
    return local.view.z * bsdf().value(local.view, local.direction, Transport::Importance);
}

Spectrum ScatterPoint::diffuse_share(const Vec3& direction) const {
    const Spectrum below = bsdf().diffuse_share(local_view_, frame_.to_local(direction));
    if (!coat_) return below;
    const Spectrum all = value(direction, Transport::Radiance);
    const Spectrum part = coat_->through() * (below * value_below(direction, Transport::Radiance));
    Spectrum share;
    for (int i = 0; i < Spectrum::kCount; ++i) share[i] = all[i] > 0.0 ? part[i] / all[i] : 0.0;
    return share;
}

PlaneMueller ScatterPoint::polarization(const Vec3& direction, bool singular) const {
    if (coat_ && singular && coat_->mirrors_to(direction)) {
        return coat_->polarization(direction, true);
    }
    PlaneMueller below = bsdf().polarization(local_view_, frame_.to_local(direction), singular);
    if (!coat_ || singular) return below;
    const PlaneMueller coat = coat_->polarization(direction, false);
    const Spectrum on_top = coat_->value(direction);
    const Spectrum rest = coat_->through() * value_below(direction, Transport::Radiance);
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const double sum = on_top[i] + rest[i];
        const double a = sum > 0.0 ? on_top[i] / sum : 0.0, b = sum > 0.0 ? rest[i] / sum : 0.0;
        below.set(i, {a * coat.q[i] + b * below.q[i], a * coat.d[i] + b * below.d[i],
                      a * coat.c[i] + b * below.c[i], a * coat.e[i] + b * below.e[i]});
    }
    return below;
}

Spectrum ScatterPoint::value_below(const Vec3& direction, Transport transport) const {
    if (map_ && transport == Transport::Importance) {
        const std::optional<Directions> seen = seen_from(direction);
        if (!seen) return {};
        return std::abs(seen->direction.z) * bsdf().value(seen->view, seen->direction, transport);
    }
    const Vec3 local = frame_.to_local(direction);
    if (!sides_agree(direction, local)) return {};
    return std::abs(local.z) * bsdf().value(local_view_, local, transport);
}

double ScatterPoint::density(const Vec3& direction) const {
    const double below = density_below(direction);
    if (!coat_) return below;
    return coat_share_ * coat_->density(direction) + (1.0 - coat_share_) * below;
}

double ScatterPoint::reverse_density(const Vec3& direction) const {
    const double density = reverse_density_below(direction);
    if (!coat_) return density;
    const Vec3 local = any_seen_from(direction).direction;
    double below = 0.0;
    if (local.z > 0.0) {
        below = bsdf().albedo(local).max();
    } else if (from_behind_) {
        below = from_behind_->albedo({local.x, local.y, -local.z}).max();
    }
    const double share = coat_->share_seen_from(direction, below);
    return share * coat_->reverse_density(direction) + (1.0 - share) * density;
}

double ScatterPoint::density_below(const Vec3& direction) const {
    const Vec3 local = frame_.to_local(direction);
    return sides_agree(direction, local) ? bsdf().density(local_view_, local) : 0.0;
}

double ScatterPoint::reverse_density_below(const Vec3& direction) const {
    Directions local{local_view_, frame_.to_local(direction)};
    if (map_) {
        const std::optional<Directions> seen = seen_from(direction);
        if (!seen) return 0.0;
        local = *seen;
    } else if (!sides_agree(direction, local.direction)) {
        return 0.0;
    }
    if (local.direction.z > 0.0) return bsdf().density(local.direction, local.view);
    const auto turned = [](const Vec3& v) { return Vec3{v.x, v.y, -v.z}; };
    return from_behind_ ? from_behind_->density(turned(local.direction), turned(local.view)) : 0.0;
}

std::optional<Scattered> ScatterPoint::sample(double choice, const Vec2& u,
                                              Transport transport) const {
    return coat_ ? sample_coated(choice, u, transport) : sample_below(choice, u, transport);
}

std::optional<Scattered> ScatterPoint::sample_coated(double choice, const Vec2& u,
                                                     Transport transport) const {
    constexpr double kBelowOne = 0x1.fffffffffffffp-1;
    const bool adjoint = transport == Transport::Importance;
    std::optional<Scattered> s;
    if (choice < coat_share_) {
        const auto drawn = coat_->sample(std::min(choice / coat_share_, kBelowOne), u);
        if (!drawn) return std::nullopt;
        const BsdfSample& local = drawn->drawn;
        s = Scattered{.direction = drawn->direction,
                      .weight = (1.0 / coat_share_) * local.weight,
                      .density = coat_share_ * local.density,
                      .singular = local.singular,
                      .mutual = !coat_->turned()};
        if (s->singular && adjoint && coat_->turned()) return std::nullopt;
    } else {
        const double rest = 1.0 - coat_share_;
        s = sample_below(std::min((choice - coat_share_) / rest, kBelowOne), u, transport);
        if (!s) return std::nullopt;
        double factor = (adjoint ? coat_->through_to(s->direction) : coat_->through()) / rest;
        // `value` of importance has the cosine of the view.
        if (adjoint && !s->straight) {
            factor *= std::abs(local_view_.z / dot(s->direction, frame_.z));
        }
        s->weight = factor * s->weight;
        s->density *= rest;
    }
    if (s->singular) return s;
    s->density = density(s->direction);
    if (!(s->density > 0.0)) return std::nullopt;
    s->weight = (1.0 / s->density) * value(s->direction, transport);
    return s;
}

std::optional<Scattered> ScatterPoint::sample_below(double choice, const Vec2& u,
                                                    Transport transport) const {
    if (null_) {
        return Scattered{.direction = -view_,
                         .weight = straight(),
                         .density = 1.0,
                         .singular = true,
                         .transmitted = true,
                         .straight = true};
    }
    const std::optional<BsdfSample> drawn = bsdf().sample(local_view_, choice, u, transport);
    std::optional<Scattered> s = drawn ? in_world(*drawn) : std::nullopt;
    if (s && map_ && transport == Transport::Importance && !s->straight) {
        if (!s->singular) {
            s->weight = (1.0 / s->density) * value_below(s->direction, transport);
        } else if (map_->turned) {
            return std::nullopt;
        }
    }
    return s;
}

std::optional<Scattered> ScatterPoint::sample_matt(const Vec3& local) const {
    const std::optional<BsdfSample> drawn = bsdf().sample_matt(local_view_, local);
    return drawn ? in_world(*drawn) : std::nullopt;
}

std::optional<Scattered> ScatterPoint::in_world(const BsdfSample& drawn) const {
    Scattered s{frame_.to_world(drawn.direction), drawn.weight, drawn.density, drawn.singular,
                drawn.direction.z < 0.0,          drawn.eta,    false,         drawn.dispersed};
    s.mutual = !map_ || !map_->turned;
    s.straight = s.singular && s.transmitted && thin_;
    if (s.straight) {
        s.direction = -view_;
    } else if (!sides_agree(s.direction, drawn.direction)) {
        return std::nullopt;
    }
    return s;
}

std::optional<std::array<Scattered, 2>> ScatterPoint::both_ways(Transport transport) const {
    if (coat_) return std::nullopt;
    // The lowest choice gives reflection, the highest refraction.
    const auto reflected = sample(0.0, {}, transport);
    if (!reflected || !reflected->singular || reflected->transmitted) return std::nullopt;
    const auto refracted = sample(0x1.fffffffffffffp-1, {}, transport);
    if (!refracted || !refracted->singular || !refracted->transmitted || refracted->straight ||
        refracted->dispersed) {
        return std::nullopt;
    }
    // A smaller sum means other lobes.
    if (!(reflected->density + refracted->density > 1.0 - 0x1p-40)) return std::nullopt;
    std::array<Scattered, 2> ways{*reflected, *refracted};
    for (Scattered& way : ways) way.weight = way.density * way.weight;
    return ways;
}

double ScatterPoint::importance_correction(const Vec3& direction) const {
    double view_cosine = local_view_.z, cosine = dot(direction, frame_.z);
    if (coat_) {
        // Each layer has its cosines in `value`.
        view_cosine = cosine = 1.0;
    } else if (map_) {
        const std::optional<Directions> seen = seen_from(direction);
        if (!seen) return 0.0;
        view_cosine = seen->view.z;
        cosine = seen->direction.z;
    }
    const double shading = std::abs(view_cosine * dot(direction, geometric_));
    const double geometric = std::abs(dot(view_, geometric_) * cosine);
    return geometric > 0.0 ? shading / geometric : 0.0;
}

void ScatterPoint::cross(MediumStack& media) const {
    const bool bounds = !thin_;
    // Volumes are left before others are entered: new ones are innermost.
    if (bounds && is_wall_) {
        media.change(inside_);
    } else if (bounds && !enters_volume_) {
        media.leave(inside_);
    }
    for (const OtherFace& other : others_) {
        if (other.wall) {
            media.change(other.inside);
        } else if (!other.entering) {
            media.leave(other.inside);
        }
    }
    for (const OtherFace& other : others_) {
        if (other.entering && other.around) media.enter(other.inside);
    }
    if (bounds && enters_volume_) media.enter(inside_);
    for (const OtherFace& other : others_) {
        if (other.entering && !other.around) media.enter(other.inside);
    }
}

}  // namespace alhazen
