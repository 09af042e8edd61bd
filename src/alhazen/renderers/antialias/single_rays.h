#pragma once
/// Renderers that compute the radiance of single rays: in tiles, or with adaptive supersampling if
/// the job requests it.
///
/// Conventions: those of RadianceEstimator (estimator.h). The estimator also has `keep_hits(hits)`,
/// after which `trace` stores the first hit of each eye ray, and `start_from(hits)`, after which it
/// starts from known first hits.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include "alhazen/geometry/hit.h"
#include "alhazen/renderers/core/estimator.h"
#include "alhazen/renderers/core/tiles.h"
#include "alhazen/renderers/core/visible_batch.h"

namespace alhazen {

/// Radiance along single rays. Threads: used by one thread at a time.
class RayAnswers {
  public:
    static constexpr std::size_t kRaysAtOnce = 256;

    virtual ~RayAnswers() = default;
    /// Traces at most kRaysAtOnce eye rays. `hits` has the length of `rays`, or is empty if no hits
    /// are needed. Adds to `counters`.
    virtual void trace(std::span<const Ray> rays, std::span<Rgb> radiance, std::span<Hit> hits,
                       RayCounters& counters) = 0;
    /// Finds the first hits of at most kRaysAtOnce eye rays, without shading.
    virtual void find(std::span<const Ray> rays, std::span<Hit> hits, RayCounters& counters) = 0;
    /// The radiance along rays traced by `find`, from their hits; they are not counted again.
    virtual void shade(std::span<const Ray> rays, std::span<const Hit> hits,
                       std::span<Rgb> radiance, RayCounters& counters) = 0;
};

/// RayAnswers of an estimator.
template <RadianceEstimator Estimator>
class EstimatorAnswers final : public RayAnswers {
  public:
    /// `more`: additional arguments of the estimator.
    template <class... More>
    explicit EstimatorAnswers(const RenderJob& job, const More&... more)
        : job_(job), estimator_(job, kRaysAtOnce, counters_, more...) {}

    void trace(std::span<const Ray> rays, std::span<Rgb> radiance, std::span<Hit> hits,
               RayCounters& counters) override {
        std::fill(radiance.begin(), radiance.end(), Rgb{});
        std::fill(hits.begin(), hits.end(), Hit{});
        estimator_.keep_hits(hits);
        estimator_.trace(rays, radiance);
        counters += counters_;
        counters_ = {};
    }
    void find(std::span<const Ray> rays, std::span<Hit> hits, RayCounters& counters) override {
        if (!finder_) finder_.emplace(job_.scene, job_.count_tests ? &counters_.tests : nullptr);
        std::fill(hits.begin(), hits.end(), Hit{});
        RayCount& count = counters_[RayKind::Eye];
        count.cast += rays.size();
        finder_->find(
            rays, Coherence::Any, [&](std::size_t) -> const Path& { return eye_; },
            [](std::size_t, const ShadingPoint*, double) {},
            [&](std::size_t k, const Hit& hit) {
                hits[k] = hit;
                ++count.hit;
                return true;
            });
        counters += counters_;
        counters_ = {};
    }
    void shade(std::span<const Ray> rays, std::span<const Hit> hits, std::span<Rgb> radiance,
               RayCounters& counters) override {
        std::fill(radiance.begin(), radiance.end(), Rgb{});
        estimator_.keep_hits({});
        estimator_.start_from(hits);
        estimator_.trace(rays, radiance);
        estimator_.start_from({});
        counters_[RayKind::Eye] = {};
        counters += counters_;
        counters_ = {};
    }

  private:
    const RenderJob& job_;
    RayCounters counters_;
    Estimator estimator_;
    std::optional<VisibleBatch> finder_;  ///< created on first use
    const Path eye_{};
};

class SingleRayRenderer : public TiledRenderer {
  public:
    /// `job` must outlive the result. Called from many threads.
    [[nodiscard]] virtual std::unique_ptr<RayAnswers> answers(const RenderJob& job) const = 0;

    [[nodiscard]] bool answers_single_rays() const final { return true; }
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const final;
};

}  // namespace alhazen
