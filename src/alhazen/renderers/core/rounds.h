#pragma once
/// Renders a film in rounds of samples: one, or as many as the stop rules of the plan ask for.
///
/// Source: Painter and Sloan, "Antialiased Ray Tracing by Adaptive Progressive Refinement",
/// SIGGRAPH 1989 (rounds); Zwicker et al., "Recent Advances in Adaptive Sampling and Reconstruction
/// for Monte Carlo Rendering", Eurographics 2015, section 2 (two halves as an estimate of the
/// error).
/// Differs: the halves are the samples before and after a doubling, which are whole sets of each
/// sampler. A pixel ends when the noise of all nine pixels around it is below the limit, and for
/// good. Few samples may all miss what is small: then a pixel ends too early.
/// Conventions: noise is the standard error of a pixel's brightest channel over the root of its
/// value, which is about even to the eye. All decisions are made between rounds from the whole
/// film: the picture after a round depends neither on threads nor on tiles. How many rounds there
/// are depends on the clock where the plan limits the time.

#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

/// The job with the usual sampler and filter (SamplingPlan) where it names none.
[[nodiscard]] RenderJob with_plan(const RenderJob& job);

/// RenderJob::sampling must be set. Layers are those of the first round. After a stop finished
/// pixels have the round in hand, the others the ones before.
[[nodiscard]] RenderReport render_in_rounds(const TiledRenderer& renderer, const RenderJob& job,
                                            Film& film);

}  // namespace alhazen
