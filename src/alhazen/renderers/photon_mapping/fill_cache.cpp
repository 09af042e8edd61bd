#include "alhazen/renderers/photon_mapping/fill_cache.h"

#include <algorithm>

#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/photon_mapping/gathering_eye.h"

namespace alhazen {

namespace {

/// Number of pixels of a task.
constexpr std::size_t kPixelsAtOnce = 64;

/// Pixels at multiples of `step` that are not multiples of twice the step.
std::vector<SamplePixel> pixels_of_step(const Film& film, int step, bool first) {
    std::vector<SamplePixel> pixels;
    for (int y = 0; y < film.frame_height(); y += step) {
        for (int x = 0; x < film.frame_width(); x += step) {
            if (first || x % (2 * step) != 0 || y % (2 * step) != 0) pixels.push_back({x, y});
        }
    }
    return pixels;
}

struct NewRecords {
    std::vector<IrradianceRecord> records;
    RayCounters counters;
};

}  // namespace

IrradianceCache filled_cache(const RenderJob& job, const Film& film, const Illumination& lights,
                             const PhotonMaps& maps, const PhotonMappingSettings& settings,
                             RayCounters& counters) {
    constexpr int kFirstStep = 16;
    IrradianceCache cache(settings.cache);
    const SamplingPlan& plan = *job.sampling;
    const std::unique_ptr<Sampler> sampler = plan.sampler->make(job.seed, 1);
    const FilterKernel filter(*plan.filter, plan.radius);
    const SampleRound round{*sampler, filter, 0, 1, {}, {}, job.seed};
    PhotonMappingSettings looking = settings;
    looking.paths.every = 1;  // a record is made at the hit of the only sample
    RenderJob part = job;
    part.round = &round;
    ThreadLimit threads(job.control.threads);
    for (int step = kFirstStep; step >= 1; step /= 2) {
        const std::vector<SamplePixel> pixels = pixels_of_step(film, step, step == kFirstStep);
        std::vector<NewRecords> made((pixels.size() + kPixelsAtOnce - 1) / kPixelsAtOnce);
        threads.run([&] {
            parallel_for(made.size(), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = begin; k < end && !job.stop_requested(); ++k) {
                    GatheringEye eye(part, kPixelsAtOnce, made[k].counters, lights, maps, looking,
                                     &cache);
                    eye.keep_records(&made[k].records);
                    const std::size_t last = std::min((k + 1) * kPixelsAtOnce, pixels.size());
                    std::vector<SampleId> ids;
                    std::vector<Ray> rays;
                    for (std::size_t i = k * kPixelsAtOnce; i < last; ++i) {
                        ids.push_back({pixels[i], 0});
                        rays.push_back(eye_ray(job.camera, (pixels[i].x + 0.5) / film.frame_width(),
                                               1.0 - (pixels[i].y + 0.5) / film.frame_height()));
                    }
                    std::vector<Rgb> radiance(rays.size());
                    eye.trace_samples(ids, rays, radiance);
                }
            });
        });
        for (const NewRecords& m : made) {
            counters += m.counters;
            for (const IrradianceRecord& record : m.records) cache.add(record);
        }
        if (job.stop_requested()) break;
    }
    return cache;
}

}  // namespace alhazen
