#include "alhazen/renderers/beam_tracing/beam_shading.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/primitives/placed_surface.h"
#include "alhazen/renderers/core/refraction.h"

namespace alhazen {

namespace {

/// The weights of the second and third corner at the intersection of a ray with a triangle's plane.
Hit hit_of_triangle(const std::array<Vec3, 3>& corners, const Ray& ray, double t) {
    const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const Vec3 p = cross(ray.direction, e2), s = ray.origin - corners[0], q = cross(s, e1);
    const double share = 1.0 / dot(e1, p);
    Hit hit;
    hit.t = t;
    hit.u = std::fmin(1.0, std::fmax(0.0, share * dot(s, p)));
    hit.v = std::fmin(1.0 - hit.u, std::fmax(0.0, share * dot(ray.direction, q)));
    return hit;
}

}  // namespace

BeamShading::BeamShading(const RenderJob& job, const BeamScene& scene, const BeamTree& tree)
    : job_(job),
      scene_(job.scene),
      conventions_(job.scene.conventions.shading),
      geometry_(scene),
      tree_(tree),
      eye_(job.camera),
      ambient_(ambient_terms(job.scene.lights)),
      constant_(job.scene),
      depth_(job.camera),
      follows_(job.aovs != nullptr && job.aovs->wanted().has(AovKind::RefractionError)) {}

void BeamShading::set_surface_of(std::uint32_t facet, const Ray& ray, double t, Surface& surface) {
    const BeamFacet& f = geometry_.facets[facet];
    const BeamSource& source = geometry_.sources[f.source];
    const Placement* placement = source.placed ? &source.placement : nullptr;
    if (source.shape) {
        set_shape_surface(*source.shape, placement, ray,
                          hit_of_face(*source.shape, placement, ray, t, f.part),
                          !scene_.textures.empty() || job_.aovs != nullptr, surface);
        surface.materials[0] = source.material;
    } else {
        const TriangleMesh& mesh = *source.mesh.mesh;
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] =
                source.placement.outer_from_inner.point(mesh.positions[mesh.triangles[f.part][k]]);
        }
        set_mesh_surface(source.mesh, f.part, placement, hit_of_triangle(corners, ray, t), surface);
    }
    surface.part = source.part;
    surface.instance = source.instance;
}

double BeamShading::meet(std::uint32_t facet, const Ray& ray, const Vec3& from, const Way& way) {
    const FacetPlane& plane = geometry_.plane(facet);
    const double t = -plane.at(ray.origin) / dot(plane.normal, ray.direction);
    const Vec3 at = ray.origin + t * ray.direction;
    set_surface_of(facet, ray, t, point_.surface);
    const PointNeeds needs{.constant = &constant_};
    complete_shading_point(scene_, ray, {way.inside, filter_width_ * job_.cone.width_at(t)}, needs,
                           point_);
    return length(at - from);
}

void BeamShading::attenuate(double distance, Way& way) const {
    if (!way.absorption.is_black()) {
        way.share = way.share * transmittance(way.absorption, distance);
    }
}

void BeamShading::pass(RayKind kind, double distance, Way& way) {
    const MaterialSample& material = *point_.material;
    way.share = way.share * tint_along(conventions_, point_, is_closed(point_.surface), tinted_,
                                       way.medium, distance);
    if (kind == RayKind::Reflection) {
        way.share = way.share * material.reflective;
        return;
    }
    const bool tinted = material.physical || conventions_.refraction_tint ==
                                                 ShadingConventions::RefractionTint::PerEvent;
    if (tinted) way.share = way.share * point_.passing;
    // Beams pass facets: no ray of them is turned by another normal.
    if (!bounds_media(point_)) return;
    static_cast<RayMedium&>(way) = medium_behind(point_, is_closed(point_.surface), &tinted_, way);
}

RayMedium BeamShading::medium_along(const Vec3& direction) {
    if (!goes_behind(point_, direction) || !bounds_media(point_)) return way_;
    return medium_behind(point_, is_closed(point_.surface), &tinted_, way_);
}

void BeamShading::follow(std::uint32_t facet, RayKind kind) {
    const FacetPlane& outer = geometry_.plane(facet);
    true_.at -= (outer.at(true_.at) / dot(outer.normal, true_.direction)) * true_.direction;
    const bool outside = dot(outer.normal, true_.direction) < 0.0;
    const Vec3 normal = outside ? outer.normal : -outer.normal;
    if (kind == RayKind::Reflection) {
        true_.direction = mirror(true_.direction, normal);
        return;
    }
    const MaterialSample& material = *point_.material;
    if (material.thin) return;
    true_.refracted = true;
    const double eta =
        outside ? conventions_.air_index / material.index : material.index / conventions_.air_index;
    if (!refract(true_.direction, normal, eta, true_.direction)) true_.lost = true;
}

double BeamShading::refraction_error() const {
    return off_;
}

void BeamShading::go(const BeamPiece& piece, const Vec2& at) {
    const Ray eye = window_ray(eye_, at);
    chain_.clear();
    for (std::uint32_t p = tree_.beams[piece.beam].piece; p != kNoFacet;
         p = tree_.beams[tree_.pieces[p].beam].piece) {
        chain_.push_back(p);
    }
    way_ = {};
    tinted_.release(1);
    filter_ = {1, 1, 1};
    Vec3 from = eye.origin;
    true_ = {eye.origin, eye.direction};
    off_ = 0.0;
    for (std::size_t k = chain_.size(); k-- > 0;) {
        const BeamPiece& met = tree_.pieces[chain_[k]];
        const Ray ray = space_ray(tree_.beams[met.beam].back, eye);
        const double distance = meet(met.seen.facet, ray, from, way_);
        attenuate(distance, way_);
        const std::uint32_t next = k == 0 ? piece.beam : tree_.pieces[chain_[k - 1]].beam;
        if (follows_) follow(met.seen.facet, tree_.beams[next].view.kind);
        pass(tree_.beams[next].view.kind, distance, way_);
        from = point_.surface.point;
    }
    nothing_ = piece.seen.facet == kNoFacet;
    if (nothing_) {
        way_.share = way_.share * transmittance_to_infinity(way_.absorption);
        return;
    }
    const Ray ray = space_ray(tree_.beams[piece.beam].back, eye);
    const double distance = meet(piece.seen.facet, ray, from, way_);
    attenuate(distance, way_);
    if (true_.refracted) {
        const FacetPlane& plane = geometry_.plane(piece.seen.facet);
        const double t = -plane.at(true_.at) / dot(plane.normal, true_.direction);
        off_ = true_.lost || !(t >= 0.0)
                   ? std::numeric_limits<double>::infinity()
                   : length(true_.at + t * true_.direction - point_.surface.point);
    }
    if (!point_.material->unlit) {
        filter_ = tint_along(conventions_, point_, is_closed(point_.surface), tinted_, way_.medium,
                             distance);
    }
}

Rgb BeamShading::own() const {
    if (nothing_) return way_.share * scene_.background;
    if (point_.material->unlit) return way_.share * point_.material->emission;
    return way_.share * filter_ * unshadowed_terms(conventions_, ambient_, point_);
}

Rgb BeamShading::light(const BeamLight& light) {
    if (nothing_ || point_.material->unlit) return {};
    const LightSample l =
        sample(scene_.lights[light.light], point_.surface.point, conventions_.clamp_attenuation);
    const double cosine = dot(point_.normal, l.to_light);
    if (!(cosine > 0.0)) return {};
    Rgb color = l.intensity * reflected_fraction(conventions_, point_, l, cosine);
    const RayMedium medium = medium_along(l.to_light);
    const bool in_air = !medium.inside && medium.medium == TintedMedia::kOutside;
    if (!light.part.through.empty() || !in_air) color = color * tint(light.part.through, l, medium);
    return way_.share * filter_ * color;
}

Rgb BeamShading::tint(std::span<const std::uint32_t> through, const LightSample& light,
                      const RayMedium& medium) {
    const Ray ray = onward_ray(conventions_, point_.surface, light.to_light, light.distance);
    std::vector<std::pair<double, std::uint32_t>> crossings;
    for (const std::uint32_t facet : through) {
        const FacetPlane& plane = geometry_.plane(facet);
        crossings.push_back({-plane.at(ray.origin) / dot(plane.normal, ray.direction), facet});
    }
    std::sort(crossings.begin(), crossings.end());
    Rgb result{1, 1, 1};
    start_inside(conventions_, tinted_, medium, volumes_);
    double last = 0.0;
    for (const auto& [t, facet] : crossings) {
        set_surface_of(facet, ray, t, between_);
        const MaterialSample material = material_at(scene_, between_, {}, {between_.point, {}, {}});
        const bool leaving = dot(ray.direction, between_.normal) >= 0.0;
        const Crossing crossing = cross(conventions_, between_, material, material, leaving,
                                        is_closed(between_), t - last, volumes_);
        result = result * crossing.way * crossing.body * crossing.surface;
        if (!material.physical || !material.thin) last = t;
    }
    return std::isfinite(ray.t_max) ? result * volumes_.through(ray.t_max - last) : result;
}

void BeamShading::add_to(PixelGeometry& geometry) const {
    if (nothing_) return;
    geometry.add_ids(point_.surface);
    geometry.add(point_, depth_);
}

}  // namespace alhazen
