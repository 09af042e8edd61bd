#include "alhazen/renderers/whitted.h"

#include <cmath>
#include <vector>

#include "alhazen/renderers/local_shading.h"
#include "alhazen/renderers/pixel_loop.h"
#include "alhazen/renderers/refraction.h"

namespace alhazen {

namespace {

Rgb power(const Rgb& base, double exponent) {
    return {std::pow(base.r, exponent), std::pow(base.g, exponent), std::pow(base.b, exponent)};
}

/// Traces the rays of one tile; holds what would be allocated per ray otherwise.
class Tracer {
  public:
    Tracer(const RenderJob& job, RayCounters& counters)
        : scene_(job.scene),
          conventions_(job.scene.conventions),
          counters_(counters),
          stats_(job.count_tests ? &counters.tests : nullptr) {}

    /// Radiance along a ray of unit direction. `depth` is 0 for eye rays; `contribution` is the
    /// product of the coefficients on the way; `inside` says that the ray starts inside something
    /// transparent.
    Rgb trace(const Ray& ray, RayKind kind, int depth, const Rgb& contribution, bool inside) {
        RayCount& count = counters_[kind];
        ++count.cast;
        Hit hit;
        if (!scene_.aggregate->closest(ray, hit, stats_)) return scene_.background;
        ++count.hit;
        const ShadingPoint point = shading_point(scene_, ray, hit, inside);
        Rgb color = unshadowed_terms(scene_, point) + direct_light(point);
        if (depth < conventions_.max_depth) {
            if (conventions_.trace_reflections) color += reflected(point, ray, depth, contribution);
            if (conventions_.trace_refractions)
                color += transmitted(point, ray, depth, contribution);
        }
        if (conventions_.refraction_tint == ShadingConventions::RefractionTint::PerDistance &&
            inside) {
            color = color * power(point.material.transmissive, hit.t);
        }
        return color;
    }

  private:
    Rgb direct_light(const ShadingPoint& point) {
        Rgb sum;
        for (const Light& light : scene_.lights) {
            if (!illuminates(light)) continue;
            const LightSample l =
                sample(light, point.surface.point, conventions_.clamp_attenuation);
            const double cosine = dot(point.normal, l.to_light);
            if (!(cosine > 0.0)) continue;
            const Rgb shadow = light_let_through(point, l);
            if (shadow.is_black()) continue;
            sum +=
                shadow * l.intensity * reflected_fraction(conventions_, point, l.to_light, cosine);
        }
        return sum;
    }

    /// What is left of a light on its way to the point: A_shadow.
    Rgb light_let_through(const ShadingPoint& point, const LightSample& light) {
        if (conventions_.shadow_tint == ShadingConventions::ShadowTint::None) return {1, 1, 1};
        const Ray ray = leaving_ray(point.surface, light.to_light, light.distance);
        RayCount& count = counters_[RayKind::Shadow];
        ++count.cast;
        if (scene_.all_opaque ||
            conventions_.shadow_tint == ShadingConventions::ShadowTint::Opaque) {
            const bool blocked = scene_.aggregate->occluded(ray, stats_);
            count.hit += blocked;
            return blocked ? Rgb{0, 0, 0} : Rgb{1, 1, 1};
        }
        crossings_.clear();
        if (scene_.aggregate->shadowed(ray, crossings_, stats_)) {
            ++count.hit;
            return {0, 0, 0};
        }
        count.hit += !crossings_.empty();
        return tint_of_crossings(ray);
    }

    [[nodiscard]] Rgb tint_of_crossings(const Ray& ray) const {
        Rgb tint{1, 1, 1};
        double inside_since = 0.0;
        for (const Hit& crossing : crossings_) {
            const Surface surface = surface_at(*scene_.aggregate, ray, crossing);
            const Rgb kt = material_at(scene_, surface).transmissive;
            if (conventions_.shadow_tint == ShadingConventions::ShadowTint::PerCrossing) {
                tint = tint * kt;
            } else if (kt.is_black()) {
                return {0, 0, 0};
            } else if (dot(ray.direction, surface.normal) >= 0.0) {
                tint = tint * power(kt, crossing.t - inside_since);
            }
            inside_since = crossing.t;
        }
        return tint;
    }

    Rgb reflected(const ShadingPoint& point, const Ray& ray, int depth, const Rgb& contribution) {
        const Rgb& kr = point.material.reflective;
        const bool cast = !kr.is_black() || (conventions_.transmitting_surfaces_reflect &&
                                             !point.material.transmissive.is_black());
        const Rgb onward = contribution * kr;
        if (!cast || onward.max() < conventions_.min_contribution) return {};
        Vec3 direction = mirror(ray.direction, point.normal);
        // An interpolated normal may send the ray into the surface: then the true one decides.
        if (conventions_.correct_interpolated_normals && dot(direction, point.geometric) < 0.0) {
            direction = mirror(ray.direction, point.geometric);
        }
        const Ray next = leaving_ray(point.surface, direction);
        return kr * trace(next, RayKind::Reflection, depth + 1, onward, point.inside);
    }

    Rgb transmitted(const ShadingPoint& point, const Ray& ray, int depth, const Rgb& contribution) {
        const Rgb& kt = point.material.transmissive;
        const Rgb onward = contribution * kt;
        if (kt.is_black() || onward.max() < conventions_.min_contribution) return {};
        const double air = conventions_.air_index;
        const double eta = point.entering ? air / point.material.index : point.material.index / air;
        Vec3 direction;
        if (!refract(ray.direction, point.normal, eta, direction)) {
            ++counters_.total_internal;
            return {};
        }
        if (conventions_.correct_interpolated_normals && dot(direction, point.geometric) > 0.0 &&
            !refract(ray.direction, point.geometric, eta, direction)) {
            ++counters_.total_internal;
            return {};
        }
        const Ray next = leaving_ray(point.surface, direction);
        const Rgb beyond = trace(next, RayKind::Refraction, depth + 1, onward, point.entering);
        return conventions_.refraction_tint == ShadingConventions::RefractionTint::PerEvent
                   ? kt * beyond
                   : beyond;
    }

    const Scene& scene_;
    const ShadingConventions& conventions_;
    RayCounters& counters_;
    TraversalStats* stats_;
    std::vector<Hit> crossings_;
};

}  // namespace

void Whitted::render_tile(const RenderJob& job, const PixelBox& tile, Film& film,
                          RayCounters& counters) const {
    Tracer tracer(job, counters);
    render_pixels(job, tile, film, counters, [&](const Ray& ray) {
        return tracer.trace(ray, RayKind::Eye, 0, {1, 1, 1}, false);
    });
}

}  // namespace alhazen
