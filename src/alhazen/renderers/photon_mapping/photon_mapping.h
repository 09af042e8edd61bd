#pragma once
/// Photon mapping: photons are shot from the lights, stored, and gathered from the eye.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996; Jensen, "Realistic Image
/// Synthesis Using Photon Mapping", 2001.
/// Differs: photons/photon_walk.h, photons/photon_density.h, photons/photon_eye.h. With `gather` 0
/// the global map holds only light that neither shadow rays nor the caustic map find. Spectral:
/// kWaveSets pairs of maps, each for four wavelengths, share the photons; the samples of a pixel
/// use them in turn, with that share of `nearest` photons.
/// Conventions: maps depend only on the scene and the seed, pixels on these and their own
/// coordinates.
/// Errors: with wavelengths, an irradiance cache, irradiance at photons or lookups in turn (Usage);
/// photons that do not fit into the memory; lights that emit none (photon_shooting.h).

#include <cstdint>

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/photons/photon_density.h"

namespace alhazen {

struct PhotonMappingSettings {
    std::uint64_t photons = 100000;   ///< photons emitted for the global map
    std::uint64_t caustics = 100000;  ///< photons emitted for the caustic map; 0: none
    int nearest = 80;                 ///< number of photons of an estimate
    double radius = 0;                ///< largest radius of an estimate; 0: determined from the map
    DensityFilter filter = DensityFilter::Cone;
    int gather = 0;           ///< rays of the final gathering; 0: direct lookup in the global map
    double cache = 0;         ///< error of the irradiance cache of the final gathering; 0: none
    double memory = 512;      ///< limit for the maps, in megabytes
    bool irradiance = false;  ///< precompute the irradiance of the global map at its photons
    bool projection = true;   ///< aim caustic photons at mirrors and glass
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
