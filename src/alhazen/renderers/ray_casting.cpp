#include "alhazen/renderers/ray_casting.h"

#include <vector>

#include "alhazen/renderers/local_shading.h"
#include "alhazen/renderers/pixel_loop.h"
#include "alhazen/renderers/visible_batch.h"

namespace alhazen {

namespace {

constexpr std::size_t kRaysAtOnce = 256;

Rgb shade(const Scene& scene, const ShadingPoint& point) {
    Rgb sum = unshadowed_terms(scene, point);
    for (const Light& light : scene.lights) {
        if (!illuminates(light)) continue;
        const LightSample l =
            sample(light, point.surface.point, scene.conventions.clamp_attenuation);
        const double cosine = dot(point.normal, l.to_light);
        if (cosine > 0.0) {
            sum += l.intensity * reflected_fraction(scene.conventions, point, l.to_light, cosine);
        }
    }
    return sum;
}

/// Casts the rays of one tile.
class Caster {
  public:
    Caster(const RenderJob& job, RayCounters& counters)
        : job_(job),
          count_(counters[RayKind::Eye]),
          visible_(job.scene, job.count_tests ? &counters.tests : nullptr) {}

    void cast(std::span<const Ray> eye_rays, std::span<Rgb> radiance) {
        count_.cast += eye_rays.size();
        on_way_.clear();
        rays_.assign(eye_rays.begin(), eye_rays.end());
        for (std::size_t i = 0; i < eye_rays.size(); ++i) on_way_.push_back({i, 1.0, job_.cone});
        for (int met = 0; met < kMaxPassedSurfaces && !rays_.empty(); ++met) {
            if (job_.stop_requested()) return;
            pass(radiance, met == 0);
        }
        for (const OnWay& o : on_way_) end(o, radiance);
    }

  private:
    /// A ray, as far as surfaces that are partly there let it through.
    struct OnWay {
        std::size_t sample;
        double left;
        RayCone cone;
        bool inside = false;
        RayKind kind = RayKind::Eye;
    };

    void end(const OnWay& o, std::span<Rgb> radiance) const {
        radiance[o.sample] = radiance[o.sample] + o.left * job_.scene.background;
    }

    void pass(std::span<Rgb> radiance, bool first) {
        behind_.clear();
        rays_behind_.clear();
        const auto path = [&](std::size_t k) -> const OnWay& { return on_way_[k]; };
        const Coherence coherence = first ? Coherence::Coherent : Coherence::Any;
        visible_.find(rays_, coherence, path,
                      [&](std::size_t k, const ShadingPoint* point, double t) {
                          OnWay& o = on_way_[k];
                          if (point == nullptr) return end(o, radiance);
                          count_.hit += first;
                          const double coverage = point->material.coverage;
                          radiance[o.sample] += (o.left * coverage) * shade(job_.scene, *point);
                          o.left *= 1.0 - coverage;
                          if (!(o.left >= kLeastTransmittance)) return;
                          behind_.push_back({o.sample, o.left, o.cone.from(t)});
                          rays_behind_.push_back(leaving_ray(point->surface, rays_[k].direction));
                      });
        on_way_.swap(behind_);
        rays_.swap(rays_behind_);
    }

    const RenderJob& job_;
    RayCount& count_;
    VisibleBatch visible_;
    std::vector<OnWay> on_way_, behind_;
    std::vector<Ray> rays_, rays_behind_;
};

}  // namespace

void RayCasting::render_tile(const RenderJob& job, const PixelBox& tile, Film& film,
                             RayCounters& counters) const {
    Caster caster(job, counters);
    render_pixels(job, tile, film, counters, kRaysAtOnce,
                  [&](std::span<const Ray> rays, std::span<Rgb> c) { caster.cast(rays, c); });
}

}  // namespace alhazen
