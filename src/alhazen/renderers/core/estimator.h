#pragma once
/// Estimators: the radiance along eye rays.
///
/// An estimator is made for a job and belongs to one thread; it keeps its memory from batch to
/// batch. PixelLoop calls it with batches of rays, never with one ray at a time, so that it can
/// trace generations together (wavefront.h).

#include <concepts>
#include <cstddef>
#include <span>

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// `E(job, rays_at_once, counters)`: for batches of at most `rays_at_once` eye rays; counts into
/// `counters`. `trace(rays, radiance)`: writes the radiance along each ray of unit direction, which
/// must not depend on the other rays. `radiance` is black before. After a stop the values are
/// undefined.
template <class E>
concept RadianceEstimator =
    std::constructible_from<E, const RenderJob&, std::size_t, RayCounters&> &&
    requires(E& estimator, std::span<const Ray> rays, std::span<Rgb> radiance) {
    estimator.trace(rays, radiance);
};

}  // namespace alhazen
