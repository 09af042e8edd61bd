#include "alhazen/explain/tree/ray_tree_recorder.h"

#include <array>
#include <utility>

namespace alhazen {

RayTreeRecorder::RayTreeRecorder(const RenderJob& job)
    : NoRandomness(job),
      scene_(job.scene),
      conventions_(job.scene.conventions.shading),
      shadows_(job.scene, counters_, nullptr),
      ambient_(ambient_terms(job.scene.lights)) {}

RayTreeRecorder::Level& RayTreeRecorder::level(int depth) {
    const auto index = static_cast<std::size_t>(depth);
    if (levels_.size() <= index) levels_.resize(index + 1);
    return levels_[index];
}

void RayTreeRecorder::count_rays(std::size_t more) {
    count_ += more;
    if (enough_ == nullptr) return;
    if (count_ > most_ || (stop_ != nullptr && stop_->requested())) enough_->request();
}

void RayTreeRecorder::begin_rays(const GenerationPart& part, int depth) {
    count_rays(part.size());
    Level& here = level(depth);
    here.base = here.rays.size();
    for (std::size_t i = 0; i < part.size(); ++i) {
        RayNode& node = here.rays.emplace_back();
        node.kind = part.paths[i].kind;
        node.ray = part.rays[i];
        node.depth = depth;
        node.inside = part.paths[i].inside;
    }
}

void RayTreeRecorder::see_light(std::size_t number, const LightSample& light, double cosine,
                                const Path& path) {
    seen_.push_back({number, light, cosine, &path});
}

void RayTreeRecorder::meet(const ShadingPoint& point, double t, const Path& path, int depth,
                           const MetSurface& met) {
    SurfaceNode node;
    const MaterialSample& m = *point.material;
    node.point = point.surface.point;
    const Level& here = level(depth);
    const RayNode& ray = here.rays[here.base + met.ray];
    // Behind a surface that covers in part, `t` counts from that surface.
    const Vec3& along = ray.ray.direction;
    node.t =
        ray.surfaces.empty() ? t : dot(node.point - ray.ray.origin, along) / length_squared(along);
    node.normal = point.normal;
    node.part = point.surface.part;
    node.material = static_cast<std::uint32_t>(point.surface.materials[0]);
    node.entering = point.entering;
    node.lit = met.lit;
    node.share = met.share;
    node.emission = m.emission;
    node.kd = m.diffuse;
    node.ks = m.specular;
    node.kr = m.reflective;
    node.kt = point.passing;
    node.shininess = m.shininess;
    node.index = m.index;
    node.reflected_factor = met.kr;
    node.refracted_factor = met.kt;
    node.filtered = met.filtered;
    if (met.filtered) node.filter = met.filter;
    if (met.lit) {
        set_ambient(point, node);
        for (const SeenLight& seen : seen_) node.lights.push_back(term_of(seen, point));
        set_reasons(point, path, depth, met, node);
    }
    count_rays(seen_.size());
    seen_.clear();
    level(depth).met.push_back(std::move(node));
}

/// The factor of `unshadowed_terms` for no emission and an ambient term of 1.
void RayTreeRecorder::set_ambient(const ShadingPoint& point, SurfaceNode& node) {
    static constexpr std::array<Rgb, 1> kOne{Rgb{1, 1, 1}};
    bare_.own = *point.material;
    bare_.own.emission = Rgb{};
    bare_.material = &bare_.own;
    bare_.inside = point.inside;
    bare_.medium = point.medium;
    bare_.normal = point.normal;
    bare_.view = point.view;
    bare_.highlights = point.highlights;
    node.ambient_factor = unshadowed_terms(conventions_, kOne, bare_);
    node.ambient = ambient_;
}

LightTerm RayTreeRecorder::term_of(const SeenLight& seen, const ShadingPoint& point) {
    LightTerm term;
    term.light = seen.number;
    term.cosine = seen.cosine;
    term.intensity = seen.light.intensity;
    term.diffuse = seen.cosine * point.material->diffuse;
    bare_.own.diffuse = Rgb{};  // the rest of `bare_` is set by `set_ambient`
    term.highlight = reflected_fraction(conventions_, bare_, seen.light, seen.cosine);
    term.cast = conventions_.shadow_tint != ShadingConventions::ShadowTint::None &&
                !seen.light.intensity.is_black();
    term.shadow = onward_ray(conventions_, point.surface, seen.light.to_light, seen.light.distance);
    LightSample white = seen.light;
    white.intensity = {1, 1, 1};
    term.through = Rgb{};
    shadows_.add(point.surface, white, {1, 1, 1}, *seen.path, term.through);
    shadows_.finish();
    if (term.cast) list_crossings(term);
    return term;
}

void RayTreeRecorder::list_crossings(LightTerm& term) const {
    constexpr std::size_t kMost = 32;
    std::vector<Hit> hits;
    scene_.aggregate->all_hits(term.shadow, hits, {nullptr, mask_of(RayKind::Shadow)});
    for (const Hit& hit : hits) {
        const Surface surface = surface_at(*scene_.aggregate, term.shadow, hit);
        term.crossings.push_back({hit.t, surface.part});
        const Material& material = scene_.materials[static_cast<std::size_t>(surface.materials[0])];
        if (material.transmissive.color.is_black() || term.crossings.size() == kMost) return;
    }
}

void RayTreeRecorder::set_reasons(const ShadingPoint& point, const Path& path, int depth,
                                  const MetSurface& met, SurfaceNode& node) const {
    const auto reason = [&](std::uint32_t ray, bool traced, const Rgb& k, bool wanted) {
        if (ray != MetSurface::kNotSent) return NotSent::Sent;
        if (!wanted) return NotSent::NoCoefficient;
        if (depth >= conventions_.max_depth) return NotSent::Deepest;
        if (!traced) return NotSent::NotTraced;
        const Rgb weight = path.contribution * met.share * k;
        return weight.max() < conventions_.min_contribution ? NotSent::TooWeak
                                                            : NotSent::TotalReflection;
    };
    const bool transmits = !point.material->transmissive.is_black();
    node.no_reflected =
        reason(met.reflected, conventions_.trace_reflections, node.kr,
               !node.kr.is_black() || (conventions_.transmitting_surfaces_reflect && transmits));
    node.no_refracted =
        reason(met.refracted, conventions_.trace_refractions, node.kt, !node.kt.is_black());
}

void RayTreeRecorder::miss(std::uint32_t ray, const Rgb& left, int depth) {
    Level& here = level(depth);
    RayNode& node = here.rays[here.base + ray];
    node.escaped = true;
    node.left = left;
}

void RayTreeRecorder::gather(const Wavefront& front, int depth) {
    std::vector<RayNode> beyond = std::move(level(depth + 1).rays);
    level(depth + 1).rays.clear();
    Level& here = level(depth);
    for (std::size_t i = 0; i < front.met.size(); ++i) {
        const MetSurface& met = front.met[i];
        SurfaceNode& node = here.met[i];
        node.direct = met.direct;
        const auto take_ray = [&](std::uint32_t ray, std::vector<RayNode>& to) {
            if (ray != MetSurface::kNotSent) to.push_back(std::move(beyond[ray]));
        };
        take_ray(met.reflected, node.reflected);
        take_ray(met.refracted, node.refracted);
        here.rays[here.base + met.ray].surfaces.push_back(std::move(node));
    }
    here.met.clear();
}

void RayTreeRecorder::give_up(const Wavefront& front, int depth) {
    Level& here = level(depth);
    for (const std::uint32_t ray : front.active) {
        RayNode& node = here.rays[here.base + ray];
        node.given_up = true;
        node.left = front.left[ray];
    }
}

void RayTreeRecorder::end_rays(const GenerationPart& part, int depth) {
    Level& here = level(depth);
    for (std::size_t i = 0; i < part.size(); ++i) {
        here.rays[here.base + i].radiance = part.radiance[i];
    }
}

std::vector<RayNode> RayTreeRecorder::take() {
    return levels_.empty() ? std::vector<RayNode>{} : std::exchange(levels_.front().rays, {});
}

}  // namespace alhazen
