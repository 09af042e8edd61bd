#pragma once
/// Estimators: the radiance along eye rays.
///
/// An estimator is created for a job and used by one thread; its memory is reused from batch to
/// batch. PixelLoop calls it with batches of rays, which permits tracing by generations
/// (wavefront.h).

#include <concepts>
#include <cstddef>
#include <span>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

/// `E(job, rays_at_once, counters)`: an estimator for batches of at most `rays_at_once` eye rays,
/// which adds to `counters`. `trace(rays, radiance)`: writes the radiance along each ray (unit
/// direction), independent of the other rays. `radiance` is initially black. After a stop the
/// values are undefined.
template <class E>
concept RadianceEstimator =
    std::constructible_from<E, const RenderJob&, std::size_t, RayCounters&> &&
    requires(E& estimator, std::span<const Ray> rays, std::span<Rgb> radiance) {
    estimator.trace(rays, radiance);
};

/// The sample that an eye ray belongs to.
struct SampleId {
    SamplePixel pixel;
    std::uint32_t number = 0;  ///< of the sampler
    double sign = 1;           ///< of the filter at the sample
};

/// An estimator that draws further random numbers of each sample: `trace_samples(ids, rays,
/// radiance)` is `trace` with the sample of each ray.
template <class E>
concept SampleEstimator = requires(E& estimator, std::span<const SampleId> ids,
                                   std::span<const Ray> rays, std::span<Rgb> radiance) {
    estimator.trace_samples(ids, rays, radiance);
};

}  // namespace alhazen
