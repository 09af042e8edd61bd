#pragma once
/// Bidirectional path tracing: every vertex of a path from the eye is connected to every vertex of
/// a path from a light; all strategies are combined by multiple importance sampling.
///
/// Source: Lafortune and Willems, "Bi-directional Path Tracing", Compugraphics 1993; Veach and
/// Guibas, "Bidirectional Estimators for Light Transport", EGWR 1994; Veach, "Robust Monte Carlo
/// Methods for Light Transport Simulation", 1997, chapter 10.
/// Differs: lights are sampled for the point that they light (path_weight.h).
/// Conventions: as many light paths as samples; for a crop fewer light paths reach the lens from
/// outside of it, which affects the noise only. Contributions of light paths to the lens are summed
/// exactly except for one rounding of each: same bits for any threads and tiles.

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

class Bidirectional final : public LightTransportRenderer {
  public:
    explicit Bidirectional(const PathSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool takes_wavelengths() const override { return true; }
    [[nodiscard]] bool scatters_in_volumes() const override { return true; }

  private:
    PathSettings settings_;
};

}  // namespace alhazen
