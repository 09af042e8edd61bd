#include "alhazen/renderers/bidirectional/bidirectional.h"

#include <chrono>

#include "alhazen/renderers/bidirectional/bidirectional_tracer.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"

namespace alhazen {

namespace {

constexpr std::size_t kPathPairsAtOnce = 256;

class BidirectionalTiles final : public TiledRenderer {
  public:
    BidirectionalTiles(const Illumination& lights, const PathSettings& settings,
                       LensLight& lens_light)
        : lights_(lights), settings_(settings), lens_light_(&lens_light) {}

    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override {
        return std::make_unique<RoundRenderer<BidirectionalTracer>>(job, kPathPairsAtOnce, lights_,
                                                                    settings_, lens_light_);
    }

  private:
    const Illumination& lights_;
    PathSettings settings_;
    LensLight* lens_light_;
};

}  // namespace

RenderReport Bidirectional::render(const RenderJob& job, Film& film) const {
    const auto begin = std::chrono::steady_clock::now();
    const RenderJob planned = with_plan(job);
    const Illumination lights(job.scene);
    LensLight lens_light{SplatFilm(film, *planned.sampling), {}};
    const BidirectionalTiles tiles(lights, settings_, lens_light);
    const RenderReport report = render_in_rounds(tiles, planned, film, begin);
    if (lens_light.paths > 0) {
        lens_light.splats.add_to(film, static_cast<double>(lens_light.paths.load()));
    }
    return report;
}

}  // namespace alhazen
