#pragma once
/// Fills the irradiance cache of a picture before rendering.
///
/// Conventions: eye paths through the middle of pixels, first of every 16th, then of every 8th and
/// so on. A new record is made where the records of earlier rounds do not suffice; those of a round
/// are added in the order of the pixels: the same cache for any number of threads. The whole frame
/// is covered, regardless of the crop.

#include "alhazen/renderers/photon_mapping/irradiance_cache.h"
#include "alhazen/renderers/photon_mapping/photon_maps.h"

namespace alhazen {

/// Adds to `counters`. Incomplete after a stop.
[[nodiscard]] IrradianceCache filled_cache(const RenderJob& job, const Film& film,
                                           const Illumination& lights, const PhotonMaps& maps,
                                           const PhotonMappingSettings& settings,
                                           RayCounters& counters);

}  // namespace alhazen
