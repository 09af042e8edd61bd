#pragma once
/// The eye of photon mapping: caustics from their map, other indirect light by final gathering or
/// from the global map.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 5.
/// Differs: gathering rays are drawn from the whole BSDF, at points of a shifted Hammersley set.
/// Those that meet mirrors or glass go on behind them; lights that they meet are direct light or a
/// caustic, which are found elsewhere. Of matt surfaces the cache tells the light where it can.

#include "alhazen/renderers/photon_mapping/irradiance_cache.h"
#include "alhazen/renderers/photon_mapping/photon_maps.h"
#include "alhazen/renderers/photons/photon_eye.h"

namespace alhazen {

class GatheringEye final : public PhotonEye {
  public:
    GatheringEye(const RenderJob& job, std::size_t, RayCounters& counters,
                 const Illumination& lights, const PhotonMaps& maps,
                 const PhotonMappingSettings& settings, const IrradianceCache* cache)
        : PhotonEye(job, counters, lights, settings.paths, maps.waves),
          maps_(maps),
          cache_(cache),
          gather_(settings.gather),
          next_(job.scene, counters, job.count_tests ? &counters.tests : nullptr) {}

    /// What the cache does not know is appended there from now on.
    void keep_records(std::vector<IrradianceRecord>* records) { records_ = records; }

  private:
    [[nodiscard]] Spectrum photon_light(const SeenPoint& at) override;
    [[nodiscard]] Spectrum photon_light(const SeenVolume& at) override;
    /// Light that has been scattered before, or came by way of mirrors and glass.
    [[nodiscard]] Spectrum volume_light(const VolumePoint& at, std::size_t waves, bool hero_only);
    [[nodiscard]] Spectrum gathered(const SeenPoint& at);
    /// The same for a matt surface, by way of the cache.
    [[nodiscard]] Spectrum matt_light(const SeenPoint& at, const Spectrum& reflectance);
    [[nodiscard]] IrradianceRecord record_at(const SeenPoint& at);
    /// The light that a gathering ray from `at` brings. Sets the distance to what it meets first.
    [[nodiscard]] Spectrum arriving(PathEnd& path, const SeenPoint& at, const PathNumbers& numbers,
                                    double& distance);

    const PhotonMaps& maps_;
    const IrradianceCache* cache_;  ///< may be null
    std::vector<IrradianceRecord>* records_ = nullptr;
    int gather_;
    NextSurface next_;
    ScatterPoint met_;
    Wavelengths along_;  ///< of the gathering ray
    PhotonDensity density_;
};

}  // namespace alhazen
