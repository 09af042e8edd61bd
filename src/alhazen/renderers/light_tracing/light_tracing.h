#pragma once
/// Light tracing: paths from the lights, each of their surfaces joined to the lens.
///
/// Source: Arvo, "Backward Ray Tracing", SIGGRAPH 1986 course notes; Dutre, Lafortune and Willems,
/// "Monte Carlo Light Tracing with Direct Computation of Pixel Intensities", Compugraphics 1993.
/// Differs: what the eye sees of lights and of the environment themselves, not in mirrors nor
/// through glass, is found by eye rays. Singular surfaces are black.
/// Conventions: as many paths as samples of the whole frame, so that a pixel does not depend on the
/// crop. The sum of each pixel is exact but for one rounding of each term: same bits for any
/// threads.

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/path_tracing/path_settings.h"

namespace alhazen {

class LightTracing final : public Renderer {
  public:
    explicit LightTracing(const PathSettings& settings) : settings_(settings) {}

    /// Without RenderJob::sampling: `sobol` and `box`.
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool takes_samplers() const override { return true; }
    [[nodiscard]] bool distributes() const override { return true; }
    [[nodiscard]] bool follows_light() const override { return true; }
    [[nodiscard]] int usual_samples() const override { return 64; }

  private:
    PathSettings settings_;
};

}  // namespace alhazen
