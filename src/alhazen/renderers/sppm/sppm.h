#pragma once
/// Stochastic progressive photon mapping: passes of photons and eye rays, around which the radius
/// of the estimate shrinks, so that the mean over the passes becomes right.
///
/// Source: Hachisuka and Jensen, "Stochastic Progressive Photon Mapping", SIGGRAPH Asia 2009;
/// Knaus and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach", ACM TOG 30(3), 2011
/// (radii of the passes without statistics of the pixels).
/// Differs: the photons of a pass are kept in the grid, not the visible points: the same sum for
/// each pixel, without writes to shared places. Direct light by shadow rays
/// (photons/photon_eye.h). In volumes balls shrink as discs do on surfaces, by their content.
/// Conventions: a pass for each sample of a pixel, with wavelengths of its own (waves_of_pass).
/// Pixels depend neither on the threads nor on
/// tiles nor on the crop. Memory: the photons of one pass.
/// Errors: photons that do not fit into the memory, lights that send none (photon_shooting.h).

#include <cstdint>

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

struct SppmSettings {
    std::uint64_t photons = 100000;  ///< of a pass that leave the lights
    double radius = 0;               ///< of the first pass; 0: of three pixels
    double alpha = 2.0 / 3.0;        ///< share of the photons of further passes that is kept
    double memory = 512;             ///< of a pass, in megabytes
    PathSettings paths;
};

class Sppm final : public LightTransportRenderer {
  public:
    explicit Sppm(const SppmSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool has_photons() const override { return true; }
    [[nodiscard]] bool scatters_in_volumes() const override { return true; }
    [[nodiscard]] bool takes_wavelengths() const override { return true; }

  private:
    SppmSettings settings_;
};

}  // namespace alhazen
