#include "alhazen/renderers/volumes/touching_faces.h"

#include "alhazen/renderers/volumes/volume_bounds.h"
#include "alhazen/shading/materials/turn_to_view.h"
#include "alhazen/shading/optics/dispersion.h"

namespace alhazen {

TouchingFaces::TouchingFaces(const Scene& scene, TintedMedia& media)
    : scene_(scene),
      media_(media),
      tints_events_(scene.conventions.shading.refraction_tint ==
                    ShadingConventions::RefractionTint::PerEvent),
      faces_(scene) {}

void TouchingFaces::set_media(const Arrival& arrival, ShadingPoint& point) {
    if (point.material->thin || point.surface.media.known) return join({}, arrival, point);
    faces_.find(point, -point.view, arrival, arrival.mask);
    if (!faces_.opaque()) return join(faces_.others(), arrival, point);
    // Its material bounds no volume: no further faces are looked for.
    set_shading_point(scene_, Ray(faces_.ray()), Hit(*faces_.opaque()), arrival, {}, point);
}

void TouchingFaces::join(const OtherFaces& others, const Arrival& arrival, ShadingPoint& point) {
    joined_.clear();
    for (const OtherFace& other : others) {
        if (is_joined(point, other)) joined_.push_back(other);
    }
    if (joined_.empty()) return set_media_of_material(scene_, point);
    set_sides(point);
    const MaterialSample& met = *point.material;
    const double air = scene_.conventions.shading.air_index;
    const double here = here_ ? here_->index : air, beyond = beyond_ ? beyond_->index : air;
    point.behind = {.known = true,
                    .inside = beyond_.has_value(),
                    .eta = here > 0.0 && beyond > 0.0 ? here / beyond : 1.0,
                    .absorption = beyond_ ? beyond_->absorption : Rgb{},
                    .medium = medium_behind(point, arrival.medium),
                    .joined = true};
    point.medium = met.transmissive;
    point.medium_is_physical = met.physical;
    if (point.surface.volume) {
        const MaterialSample inside = medium_at(scene_, point.surface, *point.surface.volume);
        point.medium = inside.transmissive;
        point.medium_is_physical = inside.physical;
    }
    if (met.physical) {
        turn_to_view_between(point.own_material(), dot(point.view, point.normal), point.behind.eta,
                             true);
    }
    point.passing = point.material->transmissive;
    for (const OtherFace& other : joined_) {
        if (!other.physical && tints_events_) point.passing = point.passing * other.kt;
    }
}

bool TouchingFaces::is_joined(const ShadingPoint& point, const OtherFace& other) const {
    if (other.known || !is_closed(other.physical, part_of(other))) return false;
    return other.entering != point.entering ||
           other.inside.material != static_cast<std::uint32_t>(volume_material(point.surface));
}

void TouchingFaces::set_sides(const ShadingPoint& point) {
    here_.reset();
    beyond_.reset();
    const bool has_inside = is_closed(point.material->physical, point.surface.part);
    const Medium own = volume_of(scene_, point);
    // Of several volumes that are left at once the densest.
    const auto leave = [&](const Medium& volume) {
        if (!here_ || volume.index > here_->index) here_ = volume;
    };
    // New volumes are innermost, the last one of all.
    if (!point.entering) leave(own);
    for (const OtherFace& other : joined_) {
        if (!other.entering) leave(other.inside);
        if (other.entering && other.around) beyond_ = other.inside;
    }
    if (point.entering && (has_inside || !beyond_)) beyond_ = own;
    for (const OtherFace& other : joined_) {
        if (other.entering && !other.around) beyond_ = other.inside;
    }
}

double TouchingFaces::eta_by_wave(double nm) const {
    const auto index = [&](const std::optional<Medium>& medium) {
        return medium ? index_at(scene_.materials[medium->material], medium->index, nm)
                      : scene_.conventions.shading.air_index;
    };
    return index(here_) / index(beyond_);
}

std::uint32_t TouchingFaces::medium_behind(const ShadingPoint& point, std::uint32_t around) {
    const bool is_closed = scene_.is_closed(point.surface.part);
    const auto cross = [&](const OtherFace& face) {
        if (!scene_.is_closed(part_of(face))) return;
        const Body body{face.inside.part, face.inside.material};
        const Rgb kt = face.physical ? Rgb{1, 1, 1} : face.kt;
        around = face.entering ? media_.enter(kt, face.inside.absorption, body, around)
                               : media_.leave(body, around);
    };
    // Volumes are left before others are entered: new ones are innermost.
    if (!point.entering) around = tinted_medium_behind(point, is_closed, media_, around);
    for (const OtherFace& other : joined_) {
        if (!other.entering) cross(other);
    }
    for (const OtherFace& other : joined_) {
        if (other.entering && other.around) cross(other);
    }
    if (point.entering) around = tinted_medium_behind(point, is_closed, media_, around);
    for (const OtherFace& other : joined_) {
        if (other.entering && !other.around) cross(other);
    }
    return around;
}

}  // namespace alhazen
