#include "alhazen/renderers/volumes/touching_faces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/renderers/volumes/sheet_layer.h"
#include "alhazen/renderers/volumes/volume_bounds.h"
#include "alhazen/shading/bsdf/dispersing.h"
#include "alhazen/shading/materials/turn_to_view.h"
#include "alhazen/shading/optics/dispersion.h"

namespace alhazen {

namespace {

/// Leaves the material of a point as it is evaluated.
class KeptAsEvaluated final : public SurfaceOptics {
  public:
    void set_media(const Arrival& /*arrival*/, ShadingPoint& /*point*/) override {}
};

}  // namespace

TouchingFaces::TouchingFaces(const Scene& scene, TintedMedia& media)
    : scene_(scene),
      media_(media),
      tints_events_(scene.conventions.shading.refraction_tint ==
                    ShadingConventions::RefractionTint::PerEvent),
      faces_(scene) {}

/// Completes the point of a boundary at the place of the sheets that a ray has hit.
class TouchingFaces::BelowSheets final : public SurfaceOptics {
  public:
    BelowSheets(TouchingFaces& touching, std::vector<MaterialSample> sheets)
        : touching_(touching), sheets_(std::move(sheets)) {}
    void set_media(const Arrival& arrival, ShadingPoint& point) override {
        CoincidentFaces& faces = touching_.faces_;
        faces.find(point, -point.view, arrival, arrival.mask);
        touching_.join(point.surface.media.known ? OtherFaces{} : faces.others(), arrival, point);
        touching_.lay_below(sheets_, false, point);
    }

  private:
    TouchingFaces& touching_;
    std::vector<MaterialSample> sheets_;
};

void TouchingFaces::set_media(const Arrival& arrival, ShadingPoint& point) {
    if (point.surface.media.known) return join({}, arrival, point);
    faces_.find(point, -point.view, arrival, arrival.mask);
    if (faces_.opaque()) {
        // Its material bounds no volume: no further faces are looked for.
        std::vector<MaterialSample> sheets = sheets_at(point, arrival, true);
        set_shading_point(scene_, Ray(faces_.ray()), Hit(*faces_.opaque()), arrival, {}, point);
        if (!hides_sheets(scene_, point)) lay_below(std::move(sheets), false, point);
        return;
    }
    if (point.material->thin && faces_.instead()) {
        BelowSheets below(*this, sheets_at(point, arrival, true));
        return set_shading_point(scene_, Ray(faces_.ray()), Hit(*faces_.instead()), arrival,
                                 {.optics = &below}, point);
    }
    join(point.material->thin ? OtherFaces{} : faces_.others(), arrival, point);
    if (faces_.sheets().empty()) return;
    lay_below(sheets_at(point, arrival, false), point.material->thin, point);
}

std::vector<MaterialSample> TouchingFaces::sheets_at(const ShadingPoint& point,
                                                     const Arrival& arrival, bool own) const {
    std::vector<MaterialSample> sheets;
    if (own && point.material->thin) sheets.push_back(*point.material);
    if (faces_.sheets().empty()) return sheets;
    ShadingPoint other;
    for (const Hit& hit : faces_.sheets()) {
        KeptAsEvaluated as_evaluated;
        set_shading_point(scene_, faces_.ray(), hit, arrival, {.optics = &as_evaluated}, other);
        sheets.push_back(*other.material);
    }
    return sheets;
}

void TouchingFaces::lay_below(std::vector<MaterialSample> sheets, bool is_first,
                              ShadingPoint& point) const {
    if (sheets.empty()) return;
    double cosine = dot(point.view, point.normal);
    bool is_behind = is_first;
    if (!is_first && !point.passing.is_black()) {
        // The sheets are on the side of the lower index, or outside.
        const double air = scene_.conventions.shading.air_index;
        const double eta = point.behind.known ? point.behind.eta
                           : point.entering   ? air / point.material->index
                                              : point.material->index / air;
        is_behind = eta > 1.0 || (eta == 1.0 && !point.entering);
        if (is_behind) {
            const double squared = 1.0 - eta * eta * (1.0 - cosine * cosine);
            if (!(squared > 0.0)) return;
            cosine = std::sqrt(squared);
        }
    }
    if (!is_first) std::reverse(sheets.begin(), sheets.end());
    for (MaterialSample& sheet : sheets) {
        turn_to_view(sheet, cosine, false);
        alhazen::lay_below(sheet, is_behind, point);
    }
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
