#include "alhazen/renderers/path_tracing/path_tracing.h"

#include <chrono>
#include <optional>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/path_tracing/path_tracer.h"

namespace alhazen {

namespace {

/// Paths per batch: enough for efficient casts while paths end, and few enough for the cache.
constexpr std::size_t kPathsAtOnce = 256;

class PathTiles final : public TiledRenderer {
  public:
    PathTiles(const Illumination& lights, const PathSettings& settings, LightLayers* layers,
              const ManifoldScene* manifold)
        : lights_(lights), settings_(settings), layers_(layers), manifold_(manifold) {}

    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override {
        return std::make_unique<RoundRenderer<PathTracer>>(job, kPathsAtOnce, lights_, settings_,
                                                           layers_, manifold_);
    }

  private:
    const Illumination& lights_;
    PathSettings settings_;
    LightLayers* layers_;
    const ManifoldScene* manifold_;
};

/// Adds warnings about light that is left out or too dark.
void add_notes(const ManifoldScene& manifold, std::vector<std::string>& notes) {
    if (const std::uint64_t cut = manifold.cut) {
        notes.push_back(std::to_string(cut) +
                        " estimates of light by way of mirrors and glass ended"
                        " after " +
                        std::to_string(kMostTrials) + " trials: there the picture is too dark");
    }
    if (manifold.parts.leaves_some_out()) {
        notes.push_back("more than " + std::to_string(kMostSpecularParts) +
                        " parts are mirrors or glass: the others are left to paths");
    }
}

}  // namespace

RenderReport PathTracing::render(const RenderJob& job, Film& film) const {
    const auto begin = std::chrono::steady_clock::now();
    return trace_paths(job, Illumination(job.scene), settings_, film, begin);
}

RenderReport trace_paths(const RenderJob& job, const Illumination& lights,
                         const PathSettings& settings, Film& film,
                         std::chrono::steady_clock::time_point begin) {
    const RenderJob planned = with_plan(job);
    std::optional<LightLayers> layers;
    if (job.aovs != nullptr && LightLayers::has_any(job.aovs->wanted())) {
        const SamplingPlan& plan = *planned.sampling;
        layers.emplace(film.crop(), job.aovs->wanted(),
                       // Shared samples are uniform in their pixels.
                       plan.shared ? 1.0 : FilterKernel(*plan.filter, plan.radius).mean_sign());
    }
    std::optional<ManifoldScene> manifold;
    if (settings.manifold) {
        manifold.emplace(job.scene, lights);
        if (!manifold->finds_any()) manifold.reset();
    }
    const PathTiles tiles(lights, settings, layers ? &*layers : nullptr,
                          manifold ? &*manifold : nullptr);
    RenderReport report = render_in_rounds(tiles, planned, film, begin);
    if (manifold) add_notes(*manifold, report.notes);
    if (layers) layers->write(*job.aovs);
    return report;
}

}  // namespace alhazen
