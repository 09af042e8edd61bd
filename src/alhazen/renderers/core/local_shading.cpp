#include "alhazen/renderers/core/local_shading.h"

#include <cmath>
#include <new>

#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shading/materials/turn_to_view.h"
#include "alhazen/shading/textures/normal_map.h"

namespace alhazen {

namespace {

/// The texture coordinates of the vector `v` in the plane of `dpdu` and `dpdv` (least squares).
/// Zero if these do not span a plane.
Vec2 in_coordinates(const Vec3& v, const Vec3& dpdu, const Vec3& dpdv) {
    const double uu = length_squared(dpdu);
    const double vv = length_squared(dpdv);
    const double uv = dot(dpdu, dpdv);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * uu * vv)) return {};
    const double u = dot(dpdu, v), w = dot(dpdv, v);
    return {(vv * u - uv * w) / determinant, (uu * w - uv * u) / determinant};
}

/// The interpolated normal, modified by a normal map (an image: see `validate`).
Vec3 mapped_normal(const Scene& scene, const Surface& surface, const NormalMap& map,
                   const std::array<UvFootprint, 2>& footprint) {
    const auto& texture =
        std::get<ImageTexture>(scene.textures[static_cast<std::size_t>(map.texture)]);
    const Vec3& n = surface.shading_normal;
    TangentFrame frame;
    if (surface.tangent != Vec3{}) {
        frame = frame_from_tangents(n, surface.tangent, surface.bitangent);
    } else {
        const SurfaceDirections directions = directions_of(surface, texture);
        frame = frame_from_derivatives(n, directions.u, directions.v);
    }
    const SurfaceLookup lookup{{surface.uv, surface.uv2}, footprint, {1, 1, 1, 1}, {}};
    return bent_normal(texel_at(map.texture, scene.textures, lookup).rgb(), map.scale, n, frame);
}

/// Sets the normal of a clear coat where it is not that of the layers below. Blended materials have
/// one normal.
void set_coat_normal(const Scene& scene, const Material& material,
                     const std::array<UvFootprint, 2>& footprint, ShadingPoint& point) {
    if (!material.metallic_roughness || point.surface.material_count != 1) return;
    const ClearCoat& coat = material.metallic_roughness->coat;
    const NormalMap& own = coat.normal_map;
    const NormalMap& base = material.normal_map;
    const bool is_shared = own.texture == base.texture && own.scale == base.scale;
    const bool has_any = own.texture != kNoTexture || base.texture != kNoTexture;
    if (!(coat.strength.value > 0.0) || is_shared || !has_any) return;
    point.coat_is_tilted = true;
    point.coat_mapped = own.texture != kNoTexture
                            ? mapped_normal(scene, point.surface, own, footprint)
                            : point.surface.shading_normal;
}

}  // namespace

SurfaceDirections directions_of(const Surface& surface, const ImageTexture& picture) {
    const bool second = picture.uv_set == 1;
    SurfaceDirections directions{second ? surface.dpdu2 : surface.dpdu,
                                 second ? surface.dpdv2 : surface.dpdv};
    apply_uv_transform(picture.uv_transform, directions.u, directions.v);
    return directions;
}

SurfaceDirections groove_directions(const Scene& scene, const Surface& surface) {
    if (surface.tangent != Vec3{}) return {surface.tangent, surface.bitangent};
    const Material& material = scene.materials[static_cast<std::size_t>(surface.materials[0])];
    if (has_grooves(material) && material.normal_map.texture != kNoTexture) {
        const auto map = static_cast<std::size_t>(material.normal_map.texture);
        return directions_of(surface, std::get<ImageTexture>(scene.textures[map]));
    }
    return {surface.dpdu, surface.dpdv};
}

Vec3 mapped_normal_seen(const Vec3& mapped, const Vec3& shading, const Vec3& view) {
    constexpr double kLeastCosine = 1e-3;
    const Vec3 n = dot(view, shading) < 0.0 ? -mapped : mapped;
    const double cosine = dot(n, view);
    if (cosine >= kLeastCosine) return n;
    const Vec3 turned = n + (kLeastCosine - cosine) * view;
    return length_squared(turned) > 0.0 ? normalize(turned) : view;
}

MaterialSample material_at(const Scene& scene, const Surface& surface,
                           const std::array<UvFootprint, 2>& footprint,
                           const SolidAperture& aperture) {
    const SurfaceLookup lookup{{surface.uv, surface.uv2}, footprint, surface.color, aperture};
    const auto sample = [&](std::size_t i) {
        return evaluate(scene.material_of(surface, i), scene.textures, lookup);
    };
    if (surface.material_count == 1) return sample(0);
    return weighted_sum(surface.weights[0], sample(0), surface.weights[1], sample(1),
                        surface.weights[2], sample(2));
}

MaterialSample medium_at(const Scene& scene, const Surface& surface, MaterialId id) {
    const SurfaceLookup lookup{
        {surface.uv, surface.uv2}, {}, surface.color, {surface.point, {}, {}}};
    return evaluate(scene.materials[static_cast<std::size_t>(id)], scene.textures, lookup);
}

SolidAperture aperture_at(const Surface& surface, const Vec3& direction, double width) {
    constexpr double kRadiusOfSquare = 0.56418958354775629;  // of a disc of area 1
    const Vec3& n = surface.normal;
    const double cosine = std::fmax(std::abs(dot(direction, n)), 1e-6);
    const Vec3 in_plane = direction - dot(direction, n) * n;
    const double sine = length(in_plane);
    const Vec3 along = sine > 1e-9 ? in_plane / sine : perpendicular(n);
    const double radius = kRadiusOfSquare * width;
    return {surface.point, (radius / cosine) * along, radius * cross(n, along)};
}

std::array<UvFootprint, 2> footprint_at(const Surface& surface, const Vec3& direction,
                                        double width) {
    // The circle perpendicular to the ray, projected along it onto the plane: its radius is
    // unchanged perpendicular to the plane of incidence and grows by 1 / cosine along it.
    const Vec3& n = surface.normal;
    const double cosine = std::fmax(std::abs(dot(direction, n)), 1e-6);
    const Vec3 in_plane = direction - dot(direction, n) * n;
    const double sine = length(in_plane);
    const Vec3 along = sine > 1e-9 ? in_plane / sine : perpendicular(n);
    const Vec3 a = (width / cosine) * along;
    const Vec3 b = width * cross(n, along);
    const auto in_set = [&](const Vec3& dpdu, const Vec3& dpdv) {
        return UvFootprint{in_coordinates(a, dpdu, dpdv), in_coordinates(b, dpdu, dpdv)};
    };
    return {in_set(surface.dpdu, surface.dpdv), in_set(surface.dpdu2, surface.dpdv2)};
}

namespace {

/// Evaluates the material. False if its sample is shared by many points.
bool set_material(const Scene& scene, const Vec3& direction, double width, MaterialCache* constant,
                  std::array<UvFootprint, 2>& footprint, ShadingPoint& point) {
    const Surface& surface = point.surface;
    if (constant != nullptr && !surface.has_extras) {
        point.material = constant->find(surface.materials[0]);
        if (point.material != nullptr) return false;
    }
    if (scene.has_mipmaps && width > 0.0) footprint = footprint_at(surface, direction, width);
    const SolidAperture aperture =
        scene.has_solid_textures ? aperture_at(surface, direction, width) : SolidAperture{};
    // Constructed in place because it is large.
    ::new (&point.own) MaterialSample(material_at(scene, surface, footprint, aperture));
    point.material = &point.own;
    return true;
}

}  // namespace

void set_media_of_material(const Scene& scene, ShadingPoint& point) {
    const SurfaceMedia& media = point.surface.media;
    const double cosine = dot(point.view, point.normal);
    point.behind = {};
    point.medium = point.material->transmissive;
    point.medium_is_physical = point.material->physical;
    if (!media.known) {
        const bool from_inside = point.inside && !point.entering && !point.medium.is_black();
        if (point.material->physical) turn_to_view(point.own_material(), cosine, from_inside);
        point.passing = point.material->transmissive;
        if (point.surface.volume) {
            const MaterialSample inside = medium_at(scene, point.surface, *point.surface.volume);
            point.medium = inside.transmissive;
            point.medium_is_physical = inside.physical;
        }
        return;
    }
    MaterialSample& material = point.own_material();
    point.behind.known = true;
    double here = scene.conventions.shading.air_index, beyond = here;
    Rgb before_passes{1, 1, 1};
    if (media.before) {
        const MaterialSample before = medium_at(scene, point.surface, *media.before);
        here = before.index;
        point.medium = before.transmissive;
        point.medium_is_physical = before.physical;
        // The material of a wall is that of the medium entered.
        if (media.after) before_passes = before.transmissive;
    }
    if (media.after) {
        const MaterialSample after = medium_at(scene, point.surface, *media.after);
        beyond = after.index;
        point.behind.inside = true;
        point.behind.absorption = after.absorption;
        if (!after.physical) point.behind.kt = after.transmissive;
    }
    point.behind.eta = here / beyond;
    turn_to_view_between(material, cosine, point.behind.eta, media.before && media.after);
    point.passing = material.transmissive * before_passes;
}

void set_shading_point(const Scene& scene, const Ray& ray, const Hit& hit, const Arrival& arrival,
                       const PointNeeds& needs, ShadingPoint& point) {
    set_surface(*scene.aggregate, ray, hit, needs.coordinates, point.surface, arrival.time);
    if (scene.has_masks) point.seen_by = mask_at(*scene.aggregate, hit);
    complete_shading_point(scene, ray, arrival, needs, point);
}

void complete_shading_point(const Scene& scene, const Ray& ray, const Arrival& arrival,
                            const PointNeeds& needs, ShadingPoint& point) {
    point.inside = arrival.inside;
    point.sheets = {1, 1, 1};
    point.highlights.clear();
    std::array<UvFootprint, 2> footprint;
    const bool varies =
        set_material(scene, ray.direction, arrival.width, needs.constant, footprint, point);
    point.view = -ray.direction;
    point.way = dot(point.surface.point - ray.origin, ray.direction) - ray.t_min;
    point.entering = dot(ray.direction, point.surface.normal) < 0.0;
    point.geometric = point.entering ? point.surface.normal : -point.surface.normal;
    // The interpolated normal is turned by its own cosine: near silhouettes, and in meshes wound
    // against their normals, its side differs from that of the geometric normal.
    const Vec3& shading = point.surface.shading_normal;
    const Material& material =
        scene.materials[static_cast<std::size_t>(point.surface.materials[0])];
    point.has_map = varies && material.normal_map.texture != kNoTexture;
    point.coat_is_tilted = false;
    if (varies) set_coat_normal(scene, material, footprint, point);
    if (point.has_map) {
        point.mapped = mapped_normal(scene, point.surface, material.normal_map, footprint);
        point.normal = mapped_normal_seen(point.mapped, shading, point.view);
    } else {
        point.normal = dot(ray.direction, shading) > 0.0 ? -shading : shading;
    }
    if (!point.entering && !arrival.meets_backs && is_unseen_from_behind(*point.material)) {
        point.own_material().coverage = 0.0;
    }
    if (needs.optics != nullptr) {
        needs.optics->set_media(arrival, point);
    } else {
        set_media_of_material(scene, point);
    }
}

bool first_visible_hit(const Scene& scene, const Ray& ray, const RayCone& cone, bool inside,
                       TraversalStats* stats, VisibleHit& found) {
    Ray rest = ray;
    double passed = 0.0;
    const RayQuery query{stats, mask_of(RayKind::Eye)};
    CoincidentSurfaces here(scene);
    for (int i = 0; i <= kMaxPassedSurfaces; ++i) {
        found.hit = Hit();
        if (!scene.aggregate->closest(rest, found.hit, query)) return false;
        found.t = passed + found.hit.t;
        set_shading_point(scene, rest, found.hit, {inside, cone.width_at(found.t)}, {},
                          found.point);
        if (found.point.material->coverage > 0.0) return true;
        passed = found.t;
        here.find(found.point.surface, found.hit, rest, query);
        rest = leaving_ray(found.point.surface, ray.direction, ray.t_max - passed);
        while (const Hit* hit = here.next()) {
            found.hit = *hit;
            set_shading_point(scene, here.ray(), *hit, {inside, cone.width_at(found.t)}, {},
                              found.point);
            if (found.point.material->coverage > 0.0) return true;
        }
    }
    return false;
}

std::vector<Rgb> ambient_terms(std::span<const Light> lights) {
    std::vector<Rgb> terms;
    for (const Light& light : lights) terms.push_back(ambient_of(light));
    return terms;
}

Rgb unshadowed_terms(const ShadingConventions& conventions, std::span<const Rgb> ambient,
                     const ShadingPoint& point) {
    const MaterialSample& m = *point.material;
    Rgb ambient_factor = conventions.ambient_factor == ShadingConventions::AmbientFactor::Diffuse
                             ? m.diffuse
                             : m.ambient;
    if (conventions.ambient_inside_times_kt && point.inside) {
        ambient_factor = ambient_factor * point.medium;
    }
    if (conventions.ambient_from_eye) {
        ambient_factor = std::fmax(0.0, dot(point.normal, point.view)) * ambient_factor;
    }
    Rgb sum = m.emission;
    for (const Rgb& term : ambient) sum += ambient_factor * term;
    return sum;
}

namespace {

/// True if cosine^shininess times `specular` is less than half an ulp of each channel of `sum`, by
/// c^n <= exp(-n (1 - c)).
bool is_lost(double cosine, double shininess, const Rgb& specular, const Rgb& sum) {
    constexpr double kExponent = 64.0;   // exp(-64) < 2^-92
    constexpr double kFactor = 0x1p-36;  // 2^-92 / 2^-36 = 2^-56
    return shininess * (1.0 - cosine) > kExponent && kFactor * specular.r <= sum.r &&
           kFactor * specular.g <= sum.g && kFactor * specular.b <= sum.b;
}

double schlick_highlight(double cosine, double shininess) {
    const double c = std::fmin(cosine, 1.0);
    return c / (shininess - shininess * c + c);
}

inline Rgb with_lobe(const ShadingConventions& conventions, const Rgb& specular, double shininess,
                     bool by_cosine, double highlight_cosine, double cosine, const Rgb& matt) {
    // Only on the lit side: 0^0 would light every point of a material of shininess 0 from behind.
    if (!(highlight_cosine > 0.0)) return matt;
    const double falloff = by_cosine ? cosine : 1.0;
    const bool schlick = conventions.highlight == ShadingConventions::Highlight::Schlick;
    if (!schlick && is_lost(highlight_cosine, shininess, specular, matt)) return matt;
    const double highlight = schlick ? schlick_highlight(highlight_cosine, shininess)
                                     : std::pow(highlight_cosine, shininess);
    return matt + (falloff * highlight) * specular;
}

}  // namespace

Rgb with_highlight(const ShadingConventions& conventions, const MaterialSample& m,
                   double highlight_cosine, double cosine, const Rgb& matt) {
    return with_lobe(conventions, m.specular, m.shininess, m.physical, highlight_cosine, cosine,
                     matt);
}

Rgb reflected_fraction(const ShadingConventions& conventions, const ShadingPoint& point,
                       const LightSample& light, double cosine) {
    const MaterialSample& m = *point.material;
    const Vec3& to_light = light.to_light;
    const Rgb fraction = cosine * m.diffuse;
    if (m.specular.is_black() && point.highlights.empty()) return fraction;
    if (!light.glints && !m.transmissive.is_black()) return fraction;
    double highlight_cosine;
    if (conventions.highlight == ShadingConventions::Highlight::BlinnPhong) {
        highlight_cosine = dot(point.normal, normalize(to_light + point.view));
    } else {
        const Vec3 mirrored = 2.0 * cosine * point.normal - to_light;
        highlight_cosine = dot(mirrored, point.view);
    }
    Rgb whole = with_highlight(conventions, m, highlight_cosine, cosine, fraction);
    for (std::size_t k = 0; k < point.highlights.size(); ++k) {
        const SheetHighlight& sheet = point.highlights[k];
        whole = with_lobe(conventions, sheet.specular, sheet.shininess, sheet.by_cosine,
                          highlight_cosine, cosine, whole);
    }
    return whole;
}

Rgb unhindered_light(const Scene& scene, std::span<const Rgb> ambient, const ShadingPoint& point) {
    Rgb sum = unshadowed_terms(scene.conventions.shading, ambient, point);
    for (const Light& light : scene.lights) {
        if (!illuminates(light)) continue;
        const LightSample l =
            sample(light, point.surface.point, scene.conventions.shading.clamp_attenuation);
        const double cosine = dot(point.normal, l.to_light);
        if (cosine > 0.0) {
            sum += l.intensity * reflected_fraction(scene.conventions.shading, point, l, cosine);
        }
    }
    return sum;
}

}  // namespace alhazen
