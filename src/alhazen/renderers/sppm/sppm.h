#pragma once
/// Stochastic progressive photon mapping: passes of photons and eye rays with a shrinking radius of
/// the estimate, so that the mean over the passes converges.
///
/// Source: Hachisuka and Jensen, "Stochastic Progressive Photon Mapping", SIGGRAPH Asia 2009; Knaus
/// and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach", ACM TOG 30(3), 2011 (radii
/// of the passes without statistics of the pixels).
/// Differs: the grid stores the photons of a pass instead of the visible points: the same sum for
/// each pixel, without concurrent writes. Direct light by shadow rays (photons/photon_eye.h). In
/// volumes the volume of the ball shrinks as the area of the disc on surfaces.
/// Conventions: one pass per sample of a pixel, with its own wavelengths (waves_of_pass). Pixels
/// are independent of the threads, the tiles and the crop. Memory: the photons of one pass.
/// Errors: photons that do not fit into the memory, lights that emit none (photon_shooting.h).

#include <cstdint>

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

struct SppmSettings {
    std::uint64_t photons = 100000;  ///< photons emitted per pass
    double radius = 0;               ///< radius of the first pass; 0: three pixels
    double alpha = 2.0 / 3.0;        ///< share of the photons of each further pass that is kept
    double memory = 512;             ///< limit for a pass, in megabytes
    PathSettings paths;
};

class Sppm final : public LightTransportRenderer {
  public:
    explicit Sppm(const SppmSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool renders_in_rounds() const override { return false; }
    [[nodiscard]] bool has_photons() const override { return true; }
    [[nodiscard]] bool scatters_in_volumes() const override { return true; }
    [[nodiscard]] bool takes_wavelengths() const override { return true; }

  private:
    SppmSettings settings_;
};

}  // namespace alhazen
