#include "alhazen/renderers/ray_casting/ray_casting.h"

#include <vector>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/pixel_loop.h"
#include "alhazen/renderers/core/unlit_cache.h"
#include "alhazen/renderers/core/visible_batch.h"
#include "alhazen/renderers/direct_light/lit_batch.h"

namespace alhazen {

namespace {

constexpr std::size_t kRaysAtOnce = 256;

/// The estimator of ray casting.
class Caster {
  public:
    Caster(const RenderJob& job, std::size_t /*rays_at_once*/, RayCounters& counters)
        : job_(job),
          count_(counters[RayKind::Eye]),
          eye_{0, 1.0, job.cone},
          ambient_(ambient_terms(job.scene.lights)),
          unlit_(job.scene, ambient_),
          lit_(job.scene, ambient_),
          visible_(job.scene, job.count_tests ? &counters.tests : nullptr) {}

    void trace(std::span<const Ray> eye_rays, std::span<Rgb> radiance) {
        count_.cast += eye_rays.size();
        on_way_.clear();
        behind_.clear();
        rays_behind_.clear();
        const auto path = [&](std::size_t) -> const OnWay& { return eye_; };
        const auto tell = [&](std::size_t k, const ShadingPoint* point, double t) {
            if (point == nullptr) return end(k, 1.0, radiance);
            ++count_.hit;
            meet({k, 1.0, job_.cone}, eye_rays[k], *point, t, radiance);
        };
        const auto take = [&](std::size_t k, const Hit& hit) {
            if (!eye_hits_.empty()) eye_hits_[k] = hit;
            if (const Rgb* color = unlit_.find(hit)) {
                radiance[k] += *color;
            } else if (!lit_.take(k, eye_rays[k], hit, radiance)) {
                return false;
            }
            ++count_.hit;
            return true;
        };
        if (known_hits_.empty()) {
            visible_.find(eye_rays, Coherence::Coherent, path, tell, take);
        } else {
            visible_.go_on(known_hits_, eye_rays, path, tell, take);
        }
        lit_.finish(radiance);
        for (int met = 1; met < kMaxPassedSurfaces && !behind_.empty(); ++met) {
            if (job_.stop_requested()) return;
            go_on(radiance);
        }
        for (const OnWay& o : behind_) end(o.sample, o.left, radiance);
    }

    /// Sets where `trace` stores the first hit of each eye ray; empty: nowhere.
    void keep_hits(std::span<Hit> hits) { eye_hits_ = hits; }
    /// Sets the known first hits of the eye rays; empty: they are found.
    void start_from(std::span<const Hit> hits) { known_hits_ = hits; }

  private:
    /// The remainder of a ray behind partly covering surfaces.
    struct OnWay {
        std::size_t sample;
        double left;
        RayCone cone;
        bool inside = false;
        RayKind kind = RayKind::Eye;
        float time = 0;  ///< 0: shutter open
    };

    void end(std::size_t sample, double left, std::span<Rgb> radiance) const {
        radiance[sample] = radiance[sample] + left * job_.scene.background;
    }

    /// Shades the surfaces at the place of the point and queues the remainder of the ray.
    void meet(const OnWay& o, const Ray& ray, const ShadingPoint& point, double t,
              std::span<Rgb> radiance) {
        OnWay behind{o.sample, o.left, o.cone.from(t)};
        for (const ShadingPoint* p = &point; p != nullptr; p = visible_.next_here(behind)) {
            const double coverage = p->material->coverage;
            radiance[o.sample] +=
                (behind.left * coverage) * unhindered_light(job_.scene, ambient_, *p);
            behind.left *= 1.0 - coverage;
            if (!(behind.left >= kLeastTransmittance)) return;
        }
        behind_.push_back(behind);
        rays_behind_.push_back(visible_.beyond(ray.direction));
    }

    /// Finds the next surface along the queued rays.
    void go_on(std::span<Rgb> radiance) {
        on_way_.swap(behind_);
        rays_.swap(rays_behind_);
        behind_.clear();
        rays_behind_.clear();
        visible_.find(
            rays_, Coherence::Any, [&](std::size_t k) -> const OnWay& { return on_way_[k]; },
            [&](std::size_t k, const ShadingPoint* point, double t) {
                const OnWay& o = on_way_[k];
                if (point == nullptr) return end(o.sample, o.left, radiance);
                meet(o, rays_[k], *point, t, radiance);
            });
    }

    const RenderJob& job_;
    RayCount& count_;
    const OnWay eye_;  ///< the state of every eye ray at its start
    const std::vector<Rgb> ambient_;
    UnlitCache unlit_;
    LitBatch lit_;
    VisibleBatch visible_;
    std::span<Hit> eye_hits_;          ///< see keep_hits
    std::span<const Hit> known_hits_;  ///< see start_from
    std::vector<OnWay> on_way_, behind_;
    std::vector<Ray> rays_, rays_behind_;
};

}  // namespace

std::unique_ptr<TileRenderer> RayCasting::begin(const RenderJob& job) const {
    return make_pixel_renderer<Caster>(job, kRaysAtOnce);
}

std::unique_ptr<RayAnswers> RayCasting::answers(const RenderJob& job) const {
    return std::make_unique<EstimatorAnswers<Caster>>(job);
}

}  // namespace alhazen
