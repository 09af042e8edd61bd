#include "alhazen/renderers/vcm/vcm_passes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "alhazen/illumination/illumination.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/photons/numbered_shooting.h"
#include "alhazen/renderers/photons/photon_density.h"
#include "alhazen/renderers/photons/photon_passes.h"
#include "alhazen/renderers/photons/photon_records.h"
#include "alhazen/renderers/vcm/light_paths.h"
#include "alhazen/renderers/vcm/vcm_tracer.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr std::size_t kPairsAtOnce = 256;

void record_vertices(const std::vector<LightVertex>& vertices, const RenderJob& job,
                     const Wavelengths& waves) {
    if (job.photons == nullptr) return;
    std::vector<Photon> photons;
    photons.reserve(vertices.size());
    for (const LightVertex& v : vertices) photons.push_back(v.photon);
    add_to_cloud(photons, false, job.photons, waves);
}

void record_density(const LightVertexGrid& grid, const RenderJob& job, const Film& film) {
    record_photon_layer(job, film, [&](const Vec3& point, const Vec3& normal) {
        const PhotonFits fits(normal, false);
        double count = 0.0;
        grid.for_near(point, [&](const LightVertex& v) { count += fits(v.photon) ? 1.0 : 0.0; });
        return count / (kPi * grid.radius() * grid.radius());
    });
}

}  // namespace

VcmSettings resolved(const VcmSettings& settings, const RenderJob& job, const Film& film) {
    VcmSettings own = settings;
    if (own.photons == 0) {
        const auto pixels = std::uint64_t(film.frame_width()) * std::uint64_t(film.frame_height());
        own.photons = std::min(VcmSettings::kUsualMost, pixels);
    }
    if (!(own.radius > 0.0)) own.radius = radius_of_pixels(job, film);
    return own;
}

RenderReport render_merging(const RenderJob& job, Film& film, const VcmSettings& settings,
                            MergeWork& work) {
    PhotonPasses passes(job, film, "vcm");
    const Illumination lights(job.scene);
    LensLight lens_light{SplatFilm(film, *passes.job().sampling), {}};
    const LightPathNumbers numbers(passes.job(), mix64(~job.seed));
    const auto most = static_cast<std::size_t>(
        std::min(settings.memory * 1e6 / LightVertexGrid::kBytesOfPhoton, 0x1p31));
    LightPathShot shot{.count = settings.photons, .settings = settings.paths};
    double radius = settings.radius;
    bool merges = lights.emits(), complete = true;
    for (std::uint32_t pass = 0; pass < passes.count() && complete; ++pass) {
        const Wavelengths waves = waves_of_pass(job, pass);
        shot.waves = &waves;
        shot.shutter = shutter_of_pass(passes.job(), pass);
        NumberedRecords<LightVertex> kept;
        shot.merging = kPi * radius * radius * static_cast<double>(shot.count);
        if (merges) {
            kept = shoot_numbers<LightVertex>(passes.job(), shot.count, most, "vcm",
                                              [&](RayCounters& counters, TraversalStats* stats) {
                                                  return LightPathWalk(numbers, lights, shot,
                                                                       counters, stats);
                                              });
            passes.report().counters += kept.counters;
            work.light_rays += kept.counters.total_cast();
            complete = !job.stop_requested();
            merges = kept.powerful > 0;
            if (!complete) {
                static_cast<void>(passes.stopped());
                break;
            }
            if (!merges) {
                passes.report().notes.emplace_back(
                    "vcm: no light of the scene emits light paths because none can be sampled: "
                    "no vertices are merged; light is found by paths from the eye only");
            }
        }
        if (pass == 0) record_vertices(kept.records, job, waves);
        const LightVertexGrid grid(std::move(kept.records), radius);
        if (pass == 0) record_density(grid, job, film);
        MergePass merging{grid, merges ? shot.merging : 0.0, job.spectral ? &waves : nullptr};
        complete = passes.look([&](const RenderJob& part) {
            return std::make_unique<RoundRenderer<VcmTracer>>(
                part, kPairsAtOnce, lights, settings.paths, &lens_light, &merging);
        });
        work.merged += merging.merged.load();
        shot.first += shot.count;
        radius *= std::sqrt(squared_radius_step(settings.alpha, static_cast<int>(pass) + 1));
    }
    if (const std::uint64_t paths = lens_light.paths.load(); paths > 0) {
        lens_light.splats.add_to(film, static_cast<double>(paths));
    }
    return passes.report();
}

}  // namespace alhazen
