#pragma once
/// Vertex connection and merging: the paths of `bidirectional`, and those whose eye vertex lies
/// near a vertex of a light path, with common weights. Like photon mapping it finds mirrored
/// caustics.
///
/// Source: Georgiev, Krivanek, Davidovic and Slusallek, "Light Transport Simulation with Vertex
/// Connection and Merging", SIGGRAPH Asia 2012; Hachisuka, Pantaleoni and Jensen, "A Path Space
/// Extension for Robust Light Transport Simulation", SIGGRAPH Asia 2012; Knaus and Zwicker,
/// "Progressive Photon Mapping: A Probabilistic Approach", ACM TOG 30(3), 2011 (radii).
/// Differs: merging and connection use separate light paths (light_paths.h), so that the number of
/// the former is free; direct light is never merged; a pilot run determines whether merging pays
/// (pilot.h).
/// Conventions: one pass per sample of a pixel. Same bits for any threads and tiles. For a crop
/// fewer light paths reach the lens, as in `bidirectional`. Memory: the vertices of one pass.
/// Errors: vertices that do not fit into the memory.

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/vcm/vcm_passes.h"

namespace alhazen {

class Vcm final : public LightTransportRenderer {
  public:
    explicit Vcm(const VcmSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool renders_in_rounds() const override { return !settings_.merge; }
    [[nodiscard]] bool takes_wavelengths() const override { return true; }
    [[nodiscard]] bool scatters_in_volumes() const override { return true; }
    [[nodiscard]] bool has_photons() const override { return settings_.merge; }

  private:
    VcmSettings settings_;
};

}  // namespace alhazen
