#include "alhazen/renderers/path_tracing/path_tracing.h"

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/path_tracing/path_tracer.h"

namespace alhazen {

namespace {

/// Enough that the batch stays worth its casts while paths end.
constexpr std::size_t kSamplesAtOnce = 1024;

class PathTiles final : public TiledRenderer {
  public:
    PathTiles(const Illumination& lights, const PathSettings& settings)
        : lights_(lights), settings_(settings) {}

    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override {
        return std::make_unique<RoundRenderer<PathTracer>>(job, kSamplesAtOnce, lights_, settings_);
    }

  private:
    const Illumination& lights_;
    PathSettings settings_;
};

}  // namespace

RenderReport PathTracing::render(const RenderJob& job, Film& film) const {
    return trace_paths(job, Illumination(job.scene), settings_, film);
}

RenderReport trace_paths(const RenderJob& job, const Illumination& lights,
                         const PathSettings& settings, Film& film) {
    return render_in_rounds(PathTiles(lights, settings), with_plan(job), film);
}

}  // namespace alhazen
