#include "alhazen/renderers/light_tracing/light_tracing.h"

#include <memory>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/core/tiles.h"
#include "alhazen/renderers/light_transport/camera_lens.h"
#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/connection_batch.h"
#include "alhazen/renderers/light_transport/lens_ray.h"
#include "alhazen/renderers/light_transport/light_starts.h"
#include "alhazen/renderers/light_transport/random_walk.h"
#include "alhazen/renderers/light_transport/splat_film.h"
#include "alhazen/renderers/path_tracing/path_tracing.h"

namespace alhazen {

namespace {

/// Pairs of dimensions: of the light, of the lens at each vertex, of the walk.
constexpr std::uint32_t kEmissionPairs = 1u << 12, kSplatPairs = 2u << 12, kWalk = 3u << 12;

/// Traces the light paths of tiles: as many for each pixel as it has samples.
class LightTiles final : public TileRenderer {
  public:
    LightTiles(const RenderJob& job, const Illumination& lights, const PathSettings& settings,
               SplatFilm& splats)
        : job_(job),
          lights_(lights),
          settings_(settings),
          random_(job),
          camera_(job),
          lens_(job),
          starts_(job.scene),
          walk_(job.scene, lights, counters_, job.count_tests ? &counters_.tests : nullptr),
          joins_(job.scene, counters_, job.count_tests ? &counters_.tests : nullptr),
          splats_(splats) {}

    void render(const PixelBox& tile, Film&, RayCounters& counters) override {
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                ids_.clear();
                for (std::uint32_t s = 0; s < job_.round->count; ++s) {
                    ids_.push_back({{x, y}, job_.round->first + s});
                }
                random_.begin(ids_);
                for (std::uint32_t s = 0; s < job_.round->count; ++s) {
                    if (job_.stop_requested()) return;
                    trace(ids_[s], random_.waves(s));
                }
            }
        }
        counters += counters_;
        counters_ = {};
    }

  private:
    void trace(const SampleId& id, const Wavelengths& waves) {
        const float time = camera_.time(random_, id);
        const Vec2 choice = random_.draw(id, kEmissionPairs);
        const LightRay light = lights_.emit(choice.x, random_.draw(id, kEmissionPairs + 1),
                                            random_.draw(id, kEmissionPairs + 2), waves);
        const WalkStart start = starts_.of(light, time, waves);
        if (start.throughput.is_black() || !start.throughput.is_finite()) return;
        walk_.walk(Transport::Importance, start,
                   {random_, id, kWalk, settings_.depth, settings_.roulette}, vertices_);
        set_falloff(lights_, light, waves, vertices_);
        for (std::uint32_t i = 0; const PathVertex& v : vertices_) {
            join(v, id, kSplatPairs + i++, time, waves);
        }
    }

    void join(const PathVertex& v, const SampleId& id, std::uint32_t pair, float time,
              const Wavelengths& waves) {
        if (!v.connects()) return;
        const auto joined = lens_.connect(v.point(), random_.draw(id, pair), time);
        if (!joined || !v.is_seen_from(joined->to_lens)) return;
        const Spectrum value = v.value(joined->to_lens, Transport::Importance);
        if (value.is_black()) return;
        Spectrum light =
            v.importance_correction(joined->to_lens) * joined->density * (v.throughput * value);
        const Ray ray = from_lens(v, *joined);
        light =
            light * joins_.seen(ray, time, media_from_lens(camera_, ray, time, v, behind_), waves);
        if (!light.is_black() && !splats_.add(joined->film, waves.color(light))) {
            ++counters_.non_finite;
        }
    }

    const RenderJob& job_;
    const Illumination& lights_;
    const PathSettings settings_;
    RayCounters counters_;
    PathRandomness random_;
    CameraRays camera_;
    CameraLens lens_;
    LightStarts starts_;
    RandomWalk walk_;
    ConnectionBatch joins_;
    SplatFilm& splats_;
    std::vector<SampleId> ids_;  ///< samples of the current pixel
    std::vector<PathVertex> vertices_;
    MediumStack behind_;  ///< at the current surface
};

}  // namespace

RenderReport LightTracing::render(const RenderJob& job, Film& film) const {
    const SamplingPlan& plan = *with_plan(job).sampling;
    if (plan.has_rounds()) {
        throw Error(ErrorKind::Usage,
                    "light_tracing traces a fixed number of paths: it takes --spp, not --noise "
                    "or --time-limit");
    }
    const Illumination lights(job.scene);
    // Adds the directly visible lights.
    RenderReport report = trace_paths(job, lights, {.depth = 0}, film);
    if (lights.has_unsampled_emitters()) {
        report.notes.push_back(
            "light_tracing: some emitting surfaces emit no light paths because they cannot be "
            "sampled; "
            "path_tracing finds their light");
    }
    if (!report.complete() || !lights.emits()) return report;
    const auto count = static_cast<std::uint32_t>(job.samples_per_pixel);
    const std::unique_ptr<Sampler> sampler = plan.sampler->make(job.seed, count);
    const FilterKernel filter(*plan.filter, plan.radius);
    const SampleRound round{*sampler, filter, 0, count, {}, {}, job.seed};
    RenderJob paths = job;
    paths.round = &round;
    paths.aovs = nullptr;
    SplatFilm splats(film, plan);
    const int width = film.frame_width(), height = film.frame_height();
    Film frame(width, height, {0, 0, width, height});
    const RenderReport traced = render_tiles(paths, frame, [&] {
        return std::make_unique<LightTiles>(paths, lights, settings_, splats);
    });
    report.counters += traced.counters;
    report.done += traced.done;
    report.parts += traced.parts;
    if (traced.complete()) {
        splats.add_to(film, static_cast<double>(width) * height * job.samples_per_pixel);
    }
    return report;
}

}  // namespace alhazen
