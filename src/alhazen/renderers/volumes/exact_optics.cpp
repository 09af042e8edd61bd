#include "alhazen/renderers/volumes/exact_optics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/renderers/volumes/sheet_layer.h"
#include "alhazen/renderers/volumes/volume_bounds.h"
#include "alhazen/shading/bsdf/dispersing.h"
#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shading/materials/turn_to_view.h"
#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

using RefractionTint = ShadingConventions::RefractionTint;

/// The solution a of exp(-a) = kt. That of kt = 0 is finite, so that its product with a distance of
/// 0 is 0, and so large that no other distance transmits anything.
Rgb absorption_of_unit_length(const Rgb& kt) {
    const auto of = [](double k) { return k > 0.0 ? -std::log(std::min(k, 1.0)) : 1e300; };
    return {of(kt.r), of(kt.g), of(kt.b)};
}

bool bounds_a_volume(const MaterialSample& m) {
    return !m.transmissive.is_black() && !m.thin && m.index > 0.0;
}

/// Inputs of the materials of a surface that a ray of unit `direction` meets, where its cone is
/// `width` wide.
SurfaceLookup lookup_at(const Scene& scene, const Surface& surface, const Vec3& direction,
                        double width) {
    SurfaceLookup lookup{{surface.uv, surface.uv2}, {}, surface.color, {}};
    if (scene.has_mipmaps && width > 0.0) {
        lookup.footprint = footprint_at(surface, direction, width);
    }
    if (scene.has_solid_textures) lookup.aperture = aperture_at(surface, direction, width);
    return lookup;
}

/// Share of the dielectric in the reflection of a physical material.
double dielectric_share(const Scene& scene, const Material& material, const SurfaceLookup& lookup) {
    if (!material.metallic_roughness) return material.conductor ? 0.0 : 1.0;
    const double metallic = value_at(material.metallic_roughness->metallic, scene.textures, lookup);
    return 1.0 - std::clamp(metallic, 0.0, 1.0);
}

/// Multiplies the reflection of a metal by its reflectance at `cosine` in a medium of index `here`
/// over that at normal incidence in air.
void turn_conductor(const Conductor& metal, double cosine, double here, MaterialSample& sample) {
    for (int i = 0; i < 3; ++i) {
        const double n = metal.index[i], k = metal.extinction[i];
        const double normal = conductor_reflectance(1.0, n, k);
        if (!(normal > 0.0)) continue;
        sample.reflective[i] *= conductor_reflectance(cosine, n / here, k / here) / normal;
    }
    keep_below_reflection(sample);
}

/// True if a thin sheet does not spread the light that passes it, as BSDFs have it.
bool is_smooth(const MaterialSample& sheet) {
    return sheet.roughness * sheet.roughness < kSmoothAlpha;
}

}  // namespace

ExactOptics::ExactOptics(const Scene& scene, const Optics& optics)
    : scene_(scene),
      optics_(optics),
      tints_events_(!optics.beer &&
                    scene.conventions.shading.refraction_tint == RefractionTint::PerEvent),
      media_(1),
      faces_(scene) {
    media_[kOutside].index = scene.conventions.shading.air_index;
}

/// Completes the point of a surface that is met instead of another.
class ExactOptics::MetInstead final : public SurfaceOptics {
  public:
    MetInstead(ExactOptics& optics, const ShadingPoint& other, const Arrival& arrival)
        : optics_(optics) {
        if (other.material->thin) sheets_ = optics.sheets_at(other, arrival);
    }
    void set_media(const Arrival& arrival, ShadingPoint& point) override {
        optics_.set_media(arrival, point, this);
    }
    /// The other surface and further sheets at its place; none: it was no sheet.
    [[nodiscard]] const std::vector<Sheet>& sheets() const { return sheets_; }

  private:
    ExactOptics& optics_;
    std::vector<Sheet> sheets_;
};

void ExactOptics::set_media(const Arrival& arrival, ShadingPoint& point) {
    set_media(arrival, point, nullptr);
}

void ExactOptics::set_media(const Arrival& arrival, ShadingPoint& point,
                            const MetInstead* instead) {
    faces_.find(point, -point.view, arrival, arrival.mask);
    if (faces_.opaque()) {
        // Its material bounds no volume: no further faces are looked for.
        std::vector<Sheet> sheets = sheets_at(point, arrival);
        set_shading_point(scene_, Ray(faces_.ray()), Hit(*faces_.opaque()), arrival,
                          {.optics = this}, point);
        if (!hides_sheets(scene_, point)) lay_below(std::move(sheets), false, arrival, {}, point);
        return;
    }
    const MaterialSample& met = *point.material;
    const Sides sides =
        sides_of(point.surface, met, point.entering, arrival.medium, faces_.others());
    if (instead == nullptr && faces_.instead() && yields(point, arrival.medium, sides)) {
        MetInstead other(*this, point, arrival);
        return set_shading_point(scene_, Ray(faces_.ray()), Hit(*faces_.instead()), arrival,
                                 {.optics = &other}, point);
    }
    const bool known = instead != nullptr && !met.thin;
    std::vector<Sheet> sheets = known ? instead->sheets() : other_sheets(point, arrival);
    const double cosine = dot(point.view, point.normal);
    point.medium = met.transmissive;
    point.medium_is_physical = met.physical || !tints_events_;
    if (const SurfaceMedia& media = point.surface.media; media.known && media.before) {
        point.medium = medium_at(scene_, point.surface, *media.before).transmissive;
    } else if (point.surface.volume) {
        point.medium = medium_at(scene_, point.surface, *point.surface.volume).transmissive;
    }
    point.behind = {true, sides.behind != kOutside, sides.here / sides.beyond,
                    media_[sides.behind].absorption, sides.behind};
    point.behind.joined = sides.joined;
    if (met.physical) {
        turn(point.surface, lookup_at(scene_, point.surface, -point.view, arrival.width), cosine,
             sides.here, sides.beyond, point.own_material());
        point.passing = tint_of(*point.material) * sides.before;
    } else if (optics_.fresnel && !met.transmissive.is_black()) {
        const double reflected = dielectric_reflectance(cosine, point.behind.eta);
        MaterialSample& own = point.own_material();
        own.reflective = {reflected, reflected, reflected};
        point.passing = (1.0 - reflected) * (tint_of(own) * sides.before);
    } else {
        point.passing = tint_of(*point.material) * sides.before;
    }
    if (!point.material->thin) {
        std::erase_if(sheets, [](const Sheet& sheet) { return !is_smooth(sheet.sample); });
    }
    bool is_first = point.material->thin;
    if (is_first && std::ranges::any_of(faces_.others(), [](const OtherFace& face) {
            return !face.entering && !face.wall;
        })) {
        // From inside the sheet that is named first is the last one.
        is_first = false;
        std::reverse(sheets.begin(), sheets.end());
    }
    lay_below(std::move(sheets), is_first, arrival, sides, point);
}

bool ExactOptics::yields(const ShadingPoint& point, std::uint32_t around, const Sides& sides) {
    if (point.material->thin) {
        const Sides all = sides_of_all(nullptr, around, faces_.others());
        return all.here != all.beyond && is_smooth(*point.material);
    }
    const auto id = static_cast<std::size_t>(point.surface.materials[0]);
    return sides.here == sides.beyond && may_only_bound_volume(scene_.materials[id]);
}

std::vector<ExactOptics::Sheet> ExactOptics::sheets_at(const ShadingPoint& point,
                                                       const Arrival& arrival) const {
    std::vector<Sheet> sheets;
    if (point.material->thin) sheets.push_back({point.surface, *point.material});
    for (Sheet& other : other_sheets(point, arrival)) sheets.push_back(std::move(other));
    return sheets;
}

std::vector<ExactOptics::Sheet> ExactOptics::other_sheets(const ShadingPoint& point,
                                                          const Arrival& arrival) const {
    std::vector<Sheet> sheets;
    for (const Hit& hit : faces_.sheets()) {
        Sheet& sheet = sheets.emplace_back();
        set_surface(*scene_.aggregate, faces_.ray(), hit, CoordinateNeed::all(), sheet.surface,
                    arrival.time);
        const SurfaceLookup lookup = lookup_at(scene_, sheet.surface, -point.view, arrival.width);
        sheet.sample = material_at(scene_, sheet.surface, lookup.footprint, lookup.aperture);
    }
    return sheets;
}

void ExactOptics::lay_below(std::vector<Sheet> sheets, bool is_first, const Arrival& arrival,
                            const Sides& sides, ShadingPoint& point) const {
    if (!is_first) std::reverse(sheets.begin(), sheets.end());
    for (const Sheet& sheet : sheets) lay_below(sheet, is_first, arrival, sides, point);
}

void ExactOptics::lay_below(const Sheet& sheet, bool is_first, const Arrival& arrival,
                            const Sides& sides, ShadingPoint& point) const {
    // The sheet is on the side of the lower index, or outside.
    const bool is_outside = sides.here == sides.beyond && !point.entering &&
                            !point.material->thin && !point.passing.is_black();
    const bool is_behind = is_first || sides.here > sides.beyond || is_outside;
    double cosine = dot(point.view, point.normal);
    if (is_behind && !is_first) {
        const double squared = 1.0 - point.behind.eta * point.behind.eta * (1.0 - cosine * cosine);
        if (!(squared > 0.0)) return;
        cosine = std::sqrt(squared);
    }
    const bool has_index = sheet.sample.index > 0.0;
    const double around = std::min(media_[arrival.medium].index, media_[sides.behind].index);
    MaterialSample turned = sheet.sample;
    turn(sheet.surface, lookup_at(scene_, sheet.surface, -point.view, arrival.width), cosine,
         has_index ? around : 1.0, has_index ? sheet.sample.index : 1.0, turned);
    alhazen::lay_below(turned, is_behind, point);
}

void ExactOptics::hide(std::uint32_t medium, const Surface& surface) {
    const std::uint64_t part = volume_number(surface);
    for (std::uint32_t m = medium; m != kOutside; m = media_[m].around) {
        if (media_[m].part != part) continue;
        media_[m].hidden = true;
        return;
    }
}

std::uint32_t ExactOptics::seen_by_shadow_rays(std::uint32_t medium) {
    for (std::uint32_t m = medium; m != kOutside; m = media_[m].around) {
        if (media_[m].hidden) return seen_by_shadow_rays(remove(m, medium));
    }
    return medium;
}

double ExactOptics::eta_by_wave(std::uint32_t around, const ShadingPoint& point, double nm) const {
    const Surface& surface = point.surface;
    const auto of_material = [&](std::size_t id, double index_d) {
        return index_at(scene_.materials[id], index_d, nm);
    };
    const auto of_medium = [&](std::uint32_t medium) {
        const Medium& m = media_[medium];
        return medium == kOutside ? m.index : of_material(m.material, m.index);
    };
    const auto own = [&] {
        return of_material(static_cast<std::size_t>(volume_material(surface)),
                           point.material->index);
    };
    double here = 1, beyond = 1;
    if (point.behind.joined) {
        here = of_medium(around);
        beyond = of_medium(point.behind.medium);
    } else if (const SurfaceMedia& media = surface.media; media.known) {
        here = media.before ? of_material(static_cast<std::size_t>(*media.before),
                                          medium_at(scene_, surface, *media.before).index)
                            : of_medium(around);
        beyond = of_medium(point.behind.medium);
    } else {
        here = point.entering || point.behind.medium != around ? of_medium(around) : own();
        beyond = point.entering ? own() : of_medium(point.behind.medium);
    }
    return here > 0.0 && beyond > 0.0 ? here / beyond : 1.0;
}

ExactOptics::Straight ExactOptics::cross(const Surface& surface, const MaterialSample& material,
                                         const Vec3& direction, std::uint32_t around,
                                         const OtherFaces& others) {
    const double cosine = dot(direction, surface.normal);
    const bool entering = cosine < 0.0;
    const Sides sides = sides_of(surface, material, entering, around, others);
    Rgb through = tint_of(material) * sides.before;
    if (optics_.fresnel) {
        const double thin = std::min(sides.here, sides.beyond);
        const double dense = std::max(sides.here, sides.beyond);
        if (material.physical) {
            const bool blended = surface.material_count > 1;
            MaterialSample turned = material;
            if (!blended) turned.transmissive = {1, 1, 1};
            turn(surface, lookup_at(scene_, surface, direction, 0.0), std::abs(cosine), thin, dense,
                 turned);
            through = (blended ? sides.before : through) * turned.transmissive;
        } else {
            through = (1.0 - dielectric_reflectance(std::abs(cosine), thin / dense)) * through;
        }
    }
    return {through, sides.behind};
}

const OtherFaces& ExactOptics::faces_at(const Ray& ray, const Hit& crossing, float time) {
    const Arrival arrival{.time = time};
    set_shading_point(scene_, ray, crossing, arrival, {}, crossed_);
    faces_.find_next_to_sheets(crossed_, ray.direction, arrival, mask_of(RayKind::Shadow));
    return faces_.others();
}

ExactOptics::Sides ExactOptics::sides_of(const Surface& surface, const MaterialSample& material,
                                         bool entering, std::uint32_t around,
                                         const OtherFaces& others) {
    const bool known = surface.media.known;
    if (known || (!others.empty() && bounds_a_volume(material) &&
                  !is_open(material.physical, surface.part))) {
        const Face own = face_of(surface, material, entering);
        return sides_of_all(&own, around, others);
    }
    Sides sides{media_[around].index, material.index, around};
    if (material.thin && !others.empty()) {
        // The sheet reflects by its own index; its faces change the medium.
        const Sides all = sides_of_all(nullptr, around, others);
        if (all.here == all.beyond) {
            sides.behind = all.behind;
            sides.joined = all.joined;
            sides.before = all.before;
        }
    }
    if (bounds_a_volume(material)) {
        const Medium inside = medium_of(surface, material);
        if (is_open(material.physical, surface.part)) {
            if (!entering) std::swap(sides.here, sides.beyond);
        } else if (entering) {
            sides.behind = enter(inside, around);
        } else {
            sides.behind = without(inside, around);
            // A volume that was not entered is that of the ray; of others the innermost is.
            if (sides.behind == around) sides.here = material.index;
            sides.beyond = media_[sides.behind].index;
        }
    }
    if (!(sides.here > 0.0 && sides.beyond > 0.0)) sides.here = sides.beyond = 1.0;
    return sides;
}

ExactOptics::Face ExactOptics::face_of(const Surface& surface, const MaterialSample& material,
                                       bool entering) const {
    const SurfaceMedia& media = surface.media;
    if (!media.known) {
        return {
            .inside = medium_of(surface, material), .entering = entering, .index = material.index};
    }
    Face face{.entering = media.after && !media.before, .wall = is_wall(surface), .known = true};
    if (media.before) {
        const MaterialSample before = medium_at(scene_, surface, *media.before);
        face.index = before.index;
        // The material of a wall is that of the medium entered.
        if (face.wall) face.tint = tint_of(before);
    }
    if (const auto& id = media.after ? media.after : media.before) {
        face.inside = medium_of(surface, medium_at(scene_, surface, *id));
        face.inside.material = static_cast<std::uint32_t>(*id);
    }
    return face;
}

ExactOptics::Sides ExactOptics::sides_of_all(const Face* own, std::uint32_t around,
                                             const OtherFaces& others) {
    Sides sides{.here = media_[around].index, .behind = around, .joined = !others.empty()};
    if (own != nullptr) sides.before = own->tint;
    const auto has_inside = [&](const OtherFace& other) {
        return other.known ||
               !is_open(other.physical, static_cast<std::uint32_t>(other.inside.part));
    };
    const auto enter_those = [&](bool outside) {
        for (const OtherFace& other : others) {
            if (!other.entering || other.around != outside || !has_inside(other)) continue;
            sides.behind = enter(medium_of(other), sides.behind);
        }
    };
    // Volumes are left before others are entered: new ones are innermost.
    if (own != nullptr && !own->entering) {
        const std::uint32_t left =
            own->wall ? of_part(own->inside, around) : place_of(own->inside, around);
        // A volume that was not entered is that of the ray.
        if (left == kOutside || (own->known && left == around)) sides.here = own->index;
        sides.joined = sides.joined || (left != kOutside && left != around);
        sides.behind = own->wall ? changed(own->inside, around) : without(own->inside, around);
    }
    for (const OtherFace& other : others) {
        if (!other.entering && has_inside(other)) {
            sides.behind = other.wall ? changed(medium_of(other), sides.behind)
                                      : without(medium_of(other), sides.behind);
        }
        if (other.physical ? other.tints : tints_events_) sides.before = sides.before * other.kt;
    }
    enter_those(true);
    if (own != nullptr && own->entering) sides.behind = enter(own->inside, sides.behind);
    enter_those(false);
    sides.beyond = media_[sides.behind].index;
    if (!(sides.here > 0.0 && sides.beyond > 0.0)) sides.here = sides.beyond = 1.0;
    return sides;
}

ExactOptics::Medium ExactOptics::medium_of(const Surface& surface,
                                           const MaterialSample& met) const {
    Medium medium;
    medium.part = volume_number(surface);
    medium.material = static_cast<std::uint32_t>(volume_material(surface));
    const MaterialSample sample =
        surface.volume ? medium_at(scene_, surface, *surface.volume) : met;
    medium.index = sample.index;
    if (sample.physical) {
        medium.absorption = sample.absorption;
    } else if (!tints_events_) {
        medium.absorption = absorption_of_unit_length(sample.transmissive);
    }
    return medium;
}

ExactOptics::Medium ExactOptics::medium_of(const OtherFace& face) const {
    Medium medium;
    medium.part = face.inside.part;
    medium.material = face.inside.material;
    medium.index = face.inside.index;
    if (face.physical) {
        medium.absorption = face.inside.absorption;
    } else if (!tints_events_) {
        medium.absorption = absorption_of_unit_length(face.kt);
    }
    return medium;
}

RayMedium ExactOptics::within(const MediumStack& volumes) {
    std::uint32_t around = kOutside;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const alhazen::Medium& volume = volumes[i];
        const MaterialSample sample =
            evaluate(scene_.materials[volume.material], scene_.textures, SurfaceLookup{});
        Medium medium;
        medium.part = volume.part;
        medium.material = volume.material;
        medium.index = volume.index;
        if (sample.physical) {
            medium.absorption = volume.absorption;
        } else if (!tints_events_) {
            medium.absorption = absorption_of_unit_length(sample.transmissive);
        }
        medium.hidden = (volume.seen_by & mask_of(RayKind::Shadow)) == 0;
        around = enter(medium, around);
    }
    const Medium& innermost = media_[around];
    return {.inside = around != kOutside,
            .hidden = innermost.hidden,
            .absorption = innermost.absorption,
            .medium = around};
}

std::uint32_t ExactOptics::enter(Medium medium, std::uint32_t around) {
    medium.around = around;
    media_.push_back(medium);
    return static_cast<std::uint32_t>(media_.size() - 1);
}

std::uint32_t ExactOptics::of_part(const Medium& volume, std::uint32_t around) const {
    std::uint32_t m = around;
    while (m != kOutside && media_[m].part != volume.part) m = media_[m].around;
    return m;
}

std::uint32_t ExactOptics::place_of(const Medium& volume, std::uint32_t around) const {
    if (const std::uint32_t m = of_part(volume, around); m != kOutside) return m;
    std::uint32_t m = around;
    while (m != kOutside && media_[m].material != volume.material) m = media_[m].around;
    return m;
}

std::uint32_t ExactOptics::without(const Medium& volume, std::uint32_t around) {
    const std::uint32_t left = place_of(volume, around);
    return left != kOutside ? remove(left, around) : around;
}

std::uint32_t ExactOptics::changed(const Medium& medium, std::uint32_t around) {
    const std::uint32_t old = of_part(medium, around);
    return old != kOutside ? replace(old, medium, around) : enter(medium, around);
}

/// `around` with `medium` in the place of `old`.
std::uint32_t ExactOptics::replace(std::uint32_t old, const Medium& medium, std::uint32_t around) {
    if (old != around) {
        const Medium kept = media_[around];
        return enter(kept, replace(old, medium, kept.around));
    }
    Medium changed = medium;
    changed.hidden = media_[old].hidden;
    return enter(changed, media_[old].around);
}

/// `around` without `left`; volumes inside `left` are kept.
std::uint32_t ExactOptics::remove(std::uint32_t left, std::uint32_t around) {
    if (left == around) return media_[left].around;
    const Medium kept = media_[around];
    return enter(kept, remove(left, kept.around));
}

Rgb ExactOptics::tint_of(const MaterialSample& sample) const {
    if (sample.physical || tints_events_ || sample.transmissive.is_black()) {
        return sample.transmissive;
    }
    return {1, 1, 1};
}

void ExactOptics::turn(const Surface& surface, const SurfaceLookup& lookup, double cosine,
                       double here, double beyond, MaterialSample& sample) const {
    if (surface.material_count == 1) {
        return turn(scene_.material_of(surface), lookup, cosine, here, beyond, sample);
    }
    if (!optics_.fresnel) {
        // As without these optics, blended terms are turned.
        double dielectric = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Material& material = scene_.material_of(surface, i);
            dielectric = std::max(dielectric, dielectric_share(scene_, material, lookup));
        }
        return turn(dielectric, cosine, here, beyond, sample);
    }
    // Behind an opaque surface is the index of the material itself; volumes have one index.
    const bool is_opaque = !surface.media.known && !bounds_a_volume(sample);
    std::array<MaterialSample, 3> each;
    for (std::size_t i = 0; i < each.size(); ++i) {
        const Material& material = scene_.material_of(surface, i);
        each[i] = evaluate(material, scene_.textures, lookup);
        const double behind = is_opaque ? each[i].index : beyond;
        const bool has_both = here > 0.0 && behind > 0.0;
        turn(material, lookup, cosine, has_both ? here : 1.0, has_both ? behind : 1.0, each[i]);
    }
    const auto& w = surface.weights;
    const MaterialSample sum = weighted_sum(w[0], each[0], w[1], each[1], w[2], each[2]);
    sample.diffuse = sum.diffuse;
    sample.specular = sum.specular;
    sample.reflective = sum.reflective;
    sample.transmissive = sum.transmissive;
}

void ExactOptics::turn(const Material& material, const SurfaceLookup& lookup, double cosine,
                       double here, double beyond, MaterialSample& sample) const {
    if (optics_.fresnel && material.conductor) {
        return turn_conductor(*material.conductor, cosine, here, sample);
    }
    turn(dielectric_share(scene_, material, lookup), cosine, here, beyond, sample);
}

void ExactOptics::turn(double dielectric, double cosine, double here, double beyond,
                       MaterialSample& sample) const {
    // The material's reflectance is that against index 1; an index of 0 has no other.
    const double thin = std::min(here, beyond), dense = std::max(here, beyond);
    const bool as_evaluated = thin == 1.0 && (dense == sample.index || !(sample.index > 0.0));
    turn_to_view_between(sample, cosine, here / beyond, !as_evaluated && dielectric > 0.0,
                         optics_.fresnel ? dielectric : 0.0);
}

}  // namespace alhazen
