#pragma once
/// The two maps of photon mapping, for each set of wavelengths.

#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/photon_mapping/photon_mapping.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// The maps for some wavelengths, or for the channels of colours.
struct PhotonMapPair {
    PhotonMap caustic;  ///< of light by way of mirrors and smooth glass alone
    PhotonMap global;   ///< with final gathering all light, else what is in no other part
    /// The same in volumes; neither has direct light.
    PhotonMap caustic_in_volumes, global_in_volumes;
};

struct PhotonMaps {
    std::vector<Wavelengths> waves;
    std::vector<PhotonMapPair> pairs;  ///< [as `waves`]
    RayCounters counters;
    bool complete = true;  ///< false after a stop
};

[[nodiscard]] PhotonMaps make_photon_maps(const RenderJob& job, const Illumination& lights,
                                          const PhotonMappingSettings& settings);

}  // namespace alhazen
