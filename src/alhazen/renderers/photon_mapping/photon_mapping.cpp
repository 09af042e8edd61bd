#include "alhazen/renderers/photon_mapping/photon_mapping.h"

#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/photon_mapping/gathering_eye.h"

namespace alhazen {

namespace {

constexpr std::size_t kSeenAtOnce = 256;

class PhotonTiles final : public TiledRenderer {
  public:
    PhotonTiles(const Illumination& lights, const PhotonMaps& maps,
                const PhotonMappingSettings& settings)
        : lights_(lights), maps_(maps), settings_(settings) {}

    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override {
        return std::make_unique<RoundRenderer<GatheringEye>>(job, kSeenAtOnce, lights_, maps_,
                                                             settings_);
    }

  private:
    const Illumination& lights_;
    const PhotonMaps& maps_;
    const PhotonMappingSettings& settings_;
};

}  // namespace

RenderReport PhotonMapping::render(const RenderJob& job, Film& film) const {
    const Illumination lights(job.scene);
    const PhotonMaps maps = make_photon_maps(job, lights, settings_);
    RenderReport report;
    if (maps.complete) {
        report = render_in_rounds(PhotonTiles(lights, maps, settings_), with_plan(job), film);
    } else {
        report.parts = 1;
    }
    report.counters += maps.counters;
    return report;
}

}  // namespace alhazen
