#pragma once
/// The two maps of photon mapping, for each set of wavelengths.

#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/photon_mapping/photon_mapping.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// The maps for a set of wavelengths, or for RGB channels.
struct PhotonMapPair {
    PhotonMap caustic;  ///< light by way of mirrors and smooth glass only
    PhotonMap global;   ///< all light with final gathering, else light missing in all other parts
    /// Maps of the light in volumes, without direct light.
    PhotonMap caustic_in_volumes, global_in_volumes;
};

struct PhotonMaps {
    std::vector<Wavelengths> waves;
    std::vector<PhotonMapPair> pairs;  ///< one for each of `waves`
    RayCounters counters;
    bool complete = true;  ///< false after a stop
};

[[nodiscard]] PhotonMaps make_photon_maps(const RenderJob& job, const Illumination& lights,
                                          const PhotonMappingSettings& settings);

}  // namespace alhazen
