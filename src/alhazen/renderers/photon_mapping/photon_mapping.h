#pragma once
/// Photon mapping: photons are shot from the lights and kept, then looked at from the eye.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996; Jensen, "Realistic Image
/// Synthesis Using Photon Mapping", 2001.
/// Differs: photons/photon_walk.h, photons/photon_density.h, photons/photon_eye.h. With `gather` 0
/// the light that the global map shows is only what neither shadow rays nor the caustic map find.
/// Light by wavelengths: kWaveSets pairs of maps, each for four wavelengths, share the photons, and
/// the samples of a pixel look at them in turn, for that share of `nearest` photons.
/// Conventions: maps depend on the scene and the seed alone, pixels on those and their own
/// coordinates.
/// Errors: an irradiance cache, irradiance at photons or looks in turn with wavelengths (Usage),
/// photons that do not fit into the memory,
/// lights that send none (photon_shooting.h).

#include <cstdint>

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/photons/photon_density.h"

namespace alhazen {

struct PhotonMappingSettings {
    std::uint64_t photons = 100000;   ///< of the global map that leave the lights
    std::uint64_t caustics = 100000;  ///< the same of the caustic map; 0: none
    int nearest = 80;                 ///< photons of an estimate
    double radius = 0;                ///< largest of an estimate; 0: by the map
    DensityFilter filter = DensityFilter::Cone;
    int gather = 0;       ///< rays of the final gathering; 0: the global map is looked at directly
    double cache = 0;     ///< error of the irradiance cache of the final gathering; 0: none
    double memory = 512;  ///< of the maps, in megabytes
    bool irradiance = false;  ///< of the global map is computed at its photons, before the picture
    bool projection = true;   ///< caustic photons are sent towards mirrors and glass
    PathSettings paths;
};

class PhotonMapping final : public LightTransportRenderer {
  public:
    explicit PhotonMapping(const PhotonMappingSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool has_photons() const override { return true; }
    [[nodiscard]] bool scatters_in_volumes() const override { return true; }
    [[nodiscard]] bool takes_wavelengths() const override { return true; }
    [[nodiscard]] int usual_samples() const override { return 16; }

  private:
    PhotonMappingSettings settings_;
};

}  // namespace alhazen
