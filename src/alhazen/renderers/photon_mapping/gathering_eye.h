#pragma once
/// The eye pass of photon mapping: caustics from their map, other indirect light by final gathering
/// or from the global map.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 5.
/// Differs: gathering rays are sampled from the whole BSDF, by a shifted Hammersley set. Rays that
/// hit mirrors or glass continue; emission that they hit is ignored, as it is direct light or a
/// caustic. Matt surfaces use the irradiance cache where possible.

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

    /// Sets the list to which records missing in the cache are appended.
    void keep_records(std::vector<IrradianceRecord>* records) { records_ = records; }

  private:
    [[nodiscard]] Spectrum photon_light(const SeenPoint& at) override;
    [[nodiscard]] Spectrum photon_light(const SeenVolume& at) override;
    /// Light scattered before, or by way of mirrors and glass.
    [[nodiscard]] Spectrum volume_light(const VolumePoint& at, std::size_t waves, bool hero_only);
    [[nodiscard]] Spectrum gathered(const SeenPoint& at);
    /// Indirect light of a matt surface, by the cache.
    [[nodiscard]] Spectrum matt_light(const SeenPoint& at, const Spectrum& reflectance);
    [[nodiscard]] IrradianceRecord record_at(const SeenPoint& at);
    /// Radiance along a gathering ray from `at`. Sets the distance to its first hit.
    [[nodiscard]] Spectrum arriving(PathEnd& path, const SeenPoint& at, const PathNumbers& numbers,
                                    double& distance);

    const PhotonMaps& maps_;
    const IrradianceCache* cache_;  ///< may be null
    std::vector<IrradianceRecord>* records_ = nullptr;
    int gather_;
    NextSurface next_;
    ScatterPoint met_;
    Wavelengths along_;  ///< wavelengths of the gathering ray
    PhotonDensity density_;
};

}  // namespace alhazen
