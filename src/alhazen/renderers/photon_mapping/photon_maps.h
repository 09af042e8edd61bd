#pragma once
/// The two maps of photon mapping.

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/photon_mapping/photon_mapping.h"

namespace alhazen {

struct PhotonMaps {
    PhotonMap caustic;  ///< of light by way of mirrors and smooth glass alone
    PhotonMap global;   ///< with final gathering all light, else what is in no other part
    RayCounters counters;
    bool complete = true;  ///< false after a stop
};

[[nodiscard]] PhotonMaps make_photon_maps(const RenderJob& job, const Illumination& lights,
                                          const PhotonMappingSettings& settings);

}  // namespace alhazen
