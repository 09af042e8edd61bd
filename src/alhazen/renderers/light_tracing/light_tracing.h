#pragma once
/// Light tracing: paths from the lights, each of whose vertices, on surfaces and in volumes, is
/// connected to the lens.
///
/// Source: Arvo, "Backward Ray Tracing", SIGGRAPH 1986 course notes; Dutre, Lafortune and Willems,
/// "Monte Carlo Light Tracing with Direct Computation of Pixel Intensities", Compugraphics 1993.
/// Differs: directly visible lights and environment, not in mirrors nor through glass, are found by
/// eye rays. Singular surfaces are black.
/// Conventions: as many paths as samples of the whole frame, so that a pixel is independent of the
/// crop. The sum of each pixel is exact except for one rounding of each term: same bits for any
/// threads.

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

class LightTracing final : public LightTransportRenderer {
  public:
    explicit LightTracing(const PathSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool renders_in_rounds() const override { return false; }
    [[nodiscard]] bool takes_wavelengths() const override { return true; }
    [[nodiscard]] bool scatters_in_volumes() const override { return true; }

  private:
    PathSettings settings_;
};

}  // namespace alhazen
