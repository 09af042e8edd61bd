#include "alhazen/renderers/whitted.h"

#include <cmath>
#include <deque>
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
        : job_(job),
          scene_(job.scene),
          conventions_(job.scene.conventions),
          counters_(counters),
          stats_(job.count_tests ? &counters.tests : nullptr) {}

    /// What a ray has behind it.
    struct Path {
        RayKind kind = RayKind::Eye;
        int depth = 0;              ///< 0 for eye rays
        Rgb contribution{1, 1, 1};  ///< product of the coefficients on the way
        bool inside = false;        ///< it starts inside something transparent
        Rgb absorption;             ///< of what it starts inside of
        RayCone cone;
    };

    /// Radiance along a ray of unit direction. Where a surface is only partly there, the ray goes
    /// straight on behind it as the same ray.
    Rgb trace(const Ray& whole, const Path& path) {
        // One eye ray can have millions behind it; the pixel is given up with it.
        if (job_.stop_requested()) return {};
        RayCount& count = counters_[path.kind];
        ++count.cast;
        Ray ray = whole;
        Path rest = path;
        Rgb sum;
        Rgb left{1, 1, 1};
        VisibleHit& found = found_at(path.depth);
        for (int met = 0; met < kMaxPassedSurfaces; ++met) {
            if (!first_visible_hit(scene_, ray, rest.cone, rest.inside, stats_, found)) {
                return sum + left * scene_.background;
            }
            if (met == 0) ++count.hit;
            if (!rest.absorption.is_black()) left = left * transmittance(rest.absorption, found.t);
            const double coverage = found.point.material.coverage;
            const Rgb share = coverage * left;
            sum += share * shade(found, ray, rest, path.contribution * share);
            left = (1.0 - coverage) * left;
            if (!(left.max() >= kLeastTransmittance)) break;
            ray = leaving_ray(found.point.surface, ray.direction);
            rest.cone = rest.cone.from(found.t);
        }
        return sum;
    }

  private:
    /// Room for the hit of one ray at each depth: too large to be made anew for each.
    VisibleHit& found_at(int depth) {
        while (found_.size() <= static_cast<std::size_t>(depth)) found_.emplace_back();
        return found_[static_cast<std::size_t>(depth)];
    }

    static Rgb transmittance(const Rgb& absorption, double distance) {
        return {std::exp(-absorption.r * distance), std::exp(-absorption.g * distance),
                std::exp(-absorption.b * distance)};
    }

    /// The light that leaves a point towards the origin of the ray that met it.
    Rgb shade(const VisibleHit& found, const Ray& ray, const Path& path, const Rgb& contribution) {
        const ShadingPoint& point = found.point;
        if (point.material.unlit) return point.material.emission;
        Rgb color = unshadowed_terms(scene_, point) + direct_light(point, path.absorption);
        if (path.depth < conventions_.max_depth) {
            Path onward = path;
            onward.depth = path.depth + 1;
            onward.contribution = contribution;
            onward.cone = path.cone.from(found.t);
            if (conventions_.trace_reflections) color += reflected(point, ray, onward);
            if (conventions_.trace_refractions) color += transmitted(point, ray, onward);
        }
        if (conventions_.refraction_tint == ShadingConventions::RefractionTint::PerDistance &&
            path.inside && !point.material.physical) {
            color = color * power(point.material.transmissive, found.t);
        }
        return color;
    }

    /// `absorption`: of what the ray came through, if that was inside of something.
    Rgb direct_light(const ShadingPoint& point, const Rgb& absorption) {
        Rgb sum;
        for (const Light& light : scene_.lights) {
            if (!illuminates(light)) continue;
            const LightSample l =
                sample(light, point.surface.point, conventions_.clamp_attenuation);
            const double cosine = dot(point.normal, l.to_light);
            if (!(cosine > 0.0)) continue;
            const Rgb shadow = light_let_through(point, l, absorption);
            if (shadow.is_black()) continue;
            sum +=
                shadow * l.intensity * reflected_fraction(conventions_, point, l.to_light, cosine);
        }
        return sum;
    }

    /// What is left of a light on its way to the point: A_shadow.
    Rgb light_let_through(const ShadingPoint& point, const LightSample& light,
                          const Rgb& absorption) {
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
        return tint_of_crossings(ray, point.inside, absorption);
    }

    /// What the transparent surfaces on the way to a light leave of it.
    Rgb tint_of_crossings(const Ray& ray, bool starts_inside, const Rgb& absorption) {
        Rgb tint{1, 1, 1};
        media_.clear();
        if (starts_inside) media_.push_back(absorption);
        double last = 0.0;
        for (const Hit& crossing : crossings_) {
            const Surface surface = surface_at(*scene_.aggregate, ray, crossing);
            const MaterialSample material = material_at(scene_, surface);
            if (material.coverage == 0.0) continue;
            const bool leaving = dot(ray.direction, surface.normal) >= 0.0;
            // Light that comes to the back of a surface without one passes.
            if (!leaving && is_unseen_from_behind(material)) continue;
            Rgb through = light_through(material, leaving, crossing.t - last);
            if (material.physical && !material.thin) {
                tint = tint * through_medium(crossing.t - last);
                enter_or_leave(leaving, material.absorption);
            }
            if (material.coverage < 1.0) {
                const double open = 1.0 - material.coverage;
                through = Rgb{open, open, open} + material.coverage * through;
            }
            tint = tint * through;
            if (tint.is_black()) return tint;
            if (!material.physical || !material.thin) last = crossing.t;
        }
        if (std::isfinite(ray.t_max)) tint = tint * through_medium(ray.t_max - last);
        return tint;
    }

    /// What one surface lets through; `inside`: the way since the last one.
    [[nodiscard]] Rgb light_through(const MaterialSample& material, bool leaving,
                                    double inside) const {
        const Rgb& kt = material.transmissive;
        if (material.physical || kt.is_black() ||
            conventions_.shadow_tint == ShadingConventions::ShadowTint::PerCrossing) {
            return kt;
        }
        return leaving ? power(kt, inside) : Rgb{1, 1, 1};
    }

    /// What is left after a way through the innermost volume that was entered.
    [[nodiscard]] Rgb through_medium(double distance) const {
        return media_.empty() ? Rgb{1, 1, 1} : transmittance(media_.back(), distance);
    }
    void enter_or_leave(bool leaving, const Rgb& absorption) {
        if (!leaving) {
            media_.push_back(absorption);
        } else if (!media_.empty()) {
            media_.pop_back();
        }
    }

    /// `onward`: the path of the new ray, but for its kind and for what this surface does to it.
    Rgb reflected(const ShadingPoint& point, const Ray& ray, Path onward) {
        const Rgb& kr = point.material.reflective;
        const bool cast = !kr.is_black() || (conventions_.transmitting_surfaces_reflect &&
                                             !point.material.transmissive.is_black());
        onward.kind = RayKind::Reflection;
        onward.contribution = onward.contribution * kr;
        if (!cast || onward.contribution.max() < conventions_.min_contribution) return {};
        Vec3 direction = mirror(ray.direction, point.normal);
        // An interpolated normal may send the ray into the surface: then the true one decides.
        if (conventions_.correct_interpolated_normals && dot(direction, point.geometric) < 0.0) {
            direction = mirror(ray.direction, point.geometric);
        }
        const Ray next = leaving_ray(point.surface, direction);
        return kr * trace(next, onward);
    }

    Rgb transmitted(const ShadingPoint& point, const Ray& ray, Path onward) {
        const Rgb& kt = point.material.transmissive;
        onward.kind = RayKind::Refraction;
        onward.contribution = onward.contribution * kt;
        if (kt.is_black() || onward.contribution.max() < conventions_.min_contribution) return {};
        Vec3 direction = ray.direction;
        if (!point.material.thin) {
            if (!refracted(point, ray, direction)) {
                ++counters_.total_internal;
                return {};
            }
            onward.inside = point.entering;
            onward.absorption = point.entering ? point.material.absorption : Rgb{};
        }
        const Ray next = leaving_ray(point.surface, direction);
        const Rgb beyond = trace(next, onward);
        return point.material.physical ||
                       conventions_.refraction_tint == ShadingConventions::RefractionTint::PerEvent
                   ? kt * beyond
                   : beyond;
    }

    [[nodiscard]] bool refracted(const ShadingPoint& point, const Ray& ray, Vec3& direction) const {
        const double air = conventions_.air_index;
        const double eta = point.entering ? air / point.material.index : point.material.index / air;
        if (!refract(ray.direction, point.normal, eta, direction)) return false;
        return !conventions_.correct_interpolated_normals ||
               !(dot(direction, point.geometric) > 0.0) ||
               refract(ray.direction, point.geometric, eta, direction);
    }

    const RenderJob& job_;
    const Scene& scene_;
    const ShadingConventions& conventions_;
    RayCounters& counters_;
    TraversalStats* stats_;
    std::vector<Hit> crossings_;
    std::vector<Rgb> media_;        ///< absorption of the volumes that a shadow ray is inside of
    std::deque<VisibleHit> found_;  ///< by depth; references stay valid while it grows
};

}  // namespace

void Whitted::render_tile(const RenderJob& job, const PixelBox& tile, Film& film,
                          RayCounters& counters) const {
    Tracer tracer(job, counters);
    Tracer::Path eye;
    eye.cone = job.cone;
    render_pixels(job, tile, film, counters,
                  [&](const Ray& ray) { return tracer.trace(ray, eye); });
}

}  // namespace alhazen
