#pragma once
/// The eye of photon mapping: caustics from their map, other indirect light by final gathering or
/// from the global map.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 5.
/// Differs: gathering rays are drawn from the whole BSDF, at points of a shifted Hammersley set.
/// Those that meet mirrors or glass go on behind them; lights that they meet are direct light or a
/// caustic, which are found elsewhere.

#include "alhazen/renderers/photon_mapping/photon_maps.h"
#include "alhazen/renderers/photons/photon_eye.h"

namespace alhazen {

class GatheringEye final : public PhotonEye {
  public:
    GatheringEye(const RenderJob& job, std::size_t, RayCounters& counters,
                 const Illumination& lights, const PhotonMaps& maps,
                 const PhotonMappingSettings& settings)
        : PhotonEye(job, counters, lights, settings.paths),
          maps_(maps),
          gather_(settings.gather),
          next_(job.scene, counters, job.count_tests ? &counters.tests : nullptr) {}

  private:
    [[nodiscard]] Rgb photon_light(const SeenPoint& at) override;
    [[nodiscard]] Rgb gathered(const SeenPoint& at);
    /// The light that a gathering ray brings.
    [[nodiscard]] Rgb arriving(PathEnd& path, const PathNumbers& numbers);

    const PhotonMaps& maps_;
    int gather_;
    NextSurface next_;
    ScatterPoint met_;
    PhotonDensity density_;
};

}  // namespace alhazen
