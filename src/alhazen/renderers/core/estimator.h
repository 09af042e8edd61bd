#pragma once
/// Estimators: the radiance along eye rays.
///
/// An estimator is created for a job and belongs to one thread; it keeps its memory from batch to
/// batch. PixelLoop calls it with batches of rays, so that it can trace whole generations
/// (wavefront.h).

#include <concepts>
#include <cstddef>
#include <span>

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// `E(job, rays_at_once, counters)`: for batches of at most `rays_at_once` eye rays; counts into
/// `counters`. `trace(rays, radiance)`: writes the radiance along each ray of unit direction,
/// independent of the other rays. `radiance` is initially black. After a stop the values are
/// undefined.
template <class E>
concept RadianceEstimator =
    std::constructible_from<E, const RenderJob&, std::size_t, RayCounters&> &&
    requires(E& estimator, std::span<const Ray> rays, std::span<Rgb> radiance) {
    estimator.trace(rays, radiance);
};

}  // namespace alhazen
