#pragma once
/// The irradiance cache of a picture, filled before it is rendered.
///
/// Conventions: eye paths through the middle of pixels, first of every 16th, then of every 8th and
/// so on. Where the records of the rounds before do not serve, a new one is made; those of a round
/// are added in the order of the pixels: the same cache for any number of threads. The whole frame
/// is seen, whatever the crop.

#include "alhazen/renderers/photon_mapping/irradiance_cache.h"
#include "alhazen/renderers/photon_mapping/photon_maps.h"

namespace alhazen {

/// `counters` is added to. Incomplete after a stop.
[[nodiscard]] IrradianceCache filled_cache(const RenderJob& job, const Film& film,
                                           const Illumination& lights, const PhotonMaps& maps,
                                           const PhotonMappingSettings& settings,
                                           RayCounters& counters);

}  // namespace alhazen
