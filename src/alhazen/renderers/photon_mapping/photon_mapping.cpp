#include "alhazen/renderers/photon_mapping/photon_mapping.h"

#include <chrono>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/photon_mapping/fill_cache.h"
#include "alhazen/renderers/photon_mapping/gathering_eye.h"
#include "alhazen/renderers/photons/photon_records.h"
#include "alhazen/renderers/photons/photon_shooting.h"

namespace alhazen {

namespace {

constexpr std::size_t kSeenAtOnce = 256;

class PhotonTiles final : public TiledRenderer {
  public:
    PhotonTiles(const Illumination& lights, const PhotonMaps& maps,
                const PhotonMappingSettings& settings, const IrradianceCache* cache)
        : lights_(lights), maps_(maps), settings_(settings), cache_(cache) {}

    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override {
        return std::make_unique<RoundRenderer<GatheringEye>>(job, kSeenAtOnce, lights_, maps_,
                                                             settings_, cache_);
    }

  private:
    const Illumination& lights_;
    const PhotonMaps& maps_;
    const PhotonMappingSettings& settings_;
    const IrradianceCache* cache_;
};

/// Throws for settings without effect in spectral rendering.
void refuse_wavelengths(const PhotonMappingSettings& settings) {
    const auto refuse = [](const char* why) {
        throw Error(ErrorKind::Usage, std::string("photon_mapping: ") + why);
    };
    if (settings.cache > 0.0) {
        refuse("the irradiance cache keeps colours, not wavelengths: --spectral requires cache=0");
    }
    if (settings.irradiance) {
        refuse(
            "irradiance at photons is of colours, not of wavelengths: --spectral requires "
            "irradiance=off");
    }
    if (settings.paths.every > 1) {
        refuse(
            "each sample must use the photons of its own wavelengths: --spectral requires "
            "every=1");
    }
}

}  // namespace

RenderReport PhotonMapping::render(const RenderJob& job, Film& film) const {
    if (job.spectral) refuse_wavelengths(settings_);
    const auto begin = std::chrono::steady_clock::now();
    const Illumination lights(job.scene);
    const PhotonMaps maps = make_photon_maps(job, lights, settings_);
    RenderReport report;
    if (maps.complete) {
        for (std::size_t k = 0; k < maps.pairs.size(); ++k) {
            const PhotonMapPair& pair = maps.pairs[k];
            add_to_cloud(pair.global.tree.photons(), false, job.photons, maps.waves[k]);
            add_to_cloud(pair.caustic.tree.photons(), true, job.photons, maps.waves[k]);
            add_to_cloud(pair.global_in_volumes.tree.photons(), false, job.photons, maps.waves[k]);
            add_to_cloud(pair.caustic_in_volumes.tree.photons(), true, job.photons, maps.waves[k]);
        }
        record_photon_layer(job, film, [&](const Vec3& point, const Vec3& normal) {
            double sum = 0.0;
            for (const PhotonMapPair& pair : maps.pairs) {
                sum += photons_by_area(pair.global, point, normal) +
                       photons_by_area(pair.caustic, point, normal);
            }
            return sum;
        });
        const RenderJob planned = with_plan(job);
        std::optional<IrradianceCache> cache;
        if (settings_.cache > 0.0 && settings_.gather > 0 && lights.emits()) {
            cache = filled_cache(planned, film, lights, maps, settings_, report.counters);
        }
        const RayCounters filling = report.counters;
        report = render_in_rounds(PhotonTiles(lights, maps, settings_, cache ? &*cache : nullptr),
                                  planned, film, begin);
        report.counters += filling;
    } else {
        report.parts = 1;
    }
    report.counters += maps.counters;
    note_silent_lights(lights, "photon_mapping", report);
    return report;
}

}  // namespace alhazen
