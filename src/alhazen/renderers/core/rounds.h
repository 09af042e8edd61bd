#pragma once
/// Renders a film in rounds of samples: one, or as many as the stop rules of the plan require.
///
/// Source: Painter and Sloan, "Antialiased Ray Tracing by Adaptive Progressive Refinement",
/// SIGGRAPH 1989 (rounds); Zwicker et al., "Recent Advances in Adaptive Sampling and Reconstruction
/// for Monte Carlo Rendering", Eurographics 2015, section 2 (two halves as an estimate of the
/// error).
/// Differs: the halves are the samples before and after a doubling, which are complete sets of each
/// sampler. A pixel gets no further samples once the noise of the nine pixels around it is below
/// the limit. This may be too early: few samples may all miss a small feature.
/// Conventions: noise is the standard error of a pixel's brightest channel over the square root of
/// its value, which is about uniform to the eye. All decisions are made between rounds from the
/// whole film: the picture after a round depends neither on threads nor on tiles. With a time limit
/// the number of rounds depends on the clock.

#include <chrono>

#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

/// Returns the job, with the default SamplingPlan if it has none.
[[nodiscard]] RenderJob with_plan(const RenderJob& job);

/// Renders by the plan RenderJob::sampling, which must be set. AOVs are those of the first round.
/// After a stop, finished pixels include the current round, others only the rounds before.
/// `begin`: when the work of the picture began; a time limit counts from there. The first round is
/// rendered in any case.
[[nodiscard]] RenderReport render_in_rounds(
    const TiledRenderer& renderer, const RenderJob& job, Film& film,
    std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now());

}  // namespace alhazen
