#pragma once
/// Renderers that answer single rays: in tiles, or with adaptive supersampling where the job asks
/// for it.
///
/// Conventions: those of RadianceEstimator (estimator.h); such an estimator also has
/// `keep_hits(hits)`, which makes `trace` store the first hit of each eye ray.

#include <algorithm>
#include <memory>
#include <span>

#include "alhazen/geometry/hit.h"
#include "alhazen/renderers/core/estimator.h"
#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

/// The radiance along single rays. Threads: used by one at a time.
class RayAnswers {
  public:
    static constexpr std::size_t kRaysAtOnce = 256;

    virtual ~RayAnswers() = default;
    /// At most kRaysAtOnce eye rays. `hits`: as long as `rays`, or empty where no hits are wanted.
    /// Adds to `counters`.
    virtual void trace(std::span<const Ray> rays, std::span<Rgb> radiance, std::span<Hit> hits,
                       RayCounters& counters) = 0;
};

/// RayAnswers of an estimator.
template <RadianceEstimator Estimator>
class EstimatorAnswers final : public RayAnswers {
  public:
    /// `more`: further arguments of the estimator.
    template <class... More>
    explicit EstimatorAnswers(const RenderJob& job, const More&... more)
        : estimator_(job, kRaysAtOnce, counters_, more...) {}

    void trace(std::span<const Ray> rays, std::span<Rgb> radiance, std::span<Hit> hits,
               RayCounters& counters) override {
        std::fill(radiance.begin(), radiance.end(), Rgb{});
        std::fill(hits.begin(), hits.end(), Hit{});
        estimator_.keep_hits(hits);
        estimator_.trace(rays, radiance);
        counters += counters_;
        counters_ = {};
    }

  private:
    RayCounters counters_;
    Estimator estimator_;
};

class SingleRayRenderer : public TiledRenderer {
  public:
    /// `job` must outlive the result. Called from many threads.
    [[nodiscard]] virtual std::unique_ptr<RayAnswers> answers(const RenderJob& job) const = 0;

    [[nodiscard]] bool answers_single_rays() const final { return true; }
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const final;
};

}  // namespace alhazen
