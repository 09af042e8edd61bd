#pragma once
/// The two maps of photon mapping, for each set of wavelengths, or for parts of the shutter where
/// something moves.

#include <algorithm>
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
    std::size_t moments = 1;           ///< parts of the shutter, of equal length
    std::vector<PhotonMapPair> pairs;  ///< [moment * waves.size() + of `waves`]

    [[nodiscard]] const PhotonMapPair& pair(std::size_t of_waves, float time) const {
        const auto moment = static_cast<std::size_t>(time * static_cast<float>(moments));
        return pairs[std::min(moment, moments - 1) * waves.size() + of_waves];
    }
    RayCounters counters;
    bool complete = true;  ///< false after a stop
};

[[nodiscard]] PhotonMaps make_photon_maps(const RenderJob& job, const Illumination& lights,
                                          const PhotonMappingSettings& settings);

}  // namespace alhazen
