#pragma once
/// Bidirectional path tracing: a path from the eye and one from a light, each vertex of one joined
/// to each of the other, all weighed by their densities.
///
/// Source: Lafortune and Willems, "Bi-directional Path Tracing", Compugraphics 1993; Veach and
/// Guibas, "Bidirectional Estimators for Light Transport", EGWR 1994; Veach, "Robust Monte Carlo
/// Methods for Light Transport Simulation", 1997, chapter 10.
/// Differs: lights are chosen for the point that they light (path_weight.h).
/// Conventions: as many light paths as samples; with a crop fewer reach the lens from outside of
/// it, which changes the noise alone. Paths from a light to the lens are summed exactly but for one
/// rounding of each: same bits for any threads and tiles.

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/path_tracing/path_settings.h"

namespace alhazen {

class Bidirectional final : public Renderer {
  public:
    explicit Bidirectional(const PathSettings& settings) : settings_(settings) {}

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
