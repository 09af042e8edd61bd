#include "alhazen/renderers/photons/photon_shooting.h"

#include <fmt/format.h>

#include <algorithm>

#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

/// Numbers that one thread takes at a time, and takes of them between two looks at the store.
constexpr std::uint64_t kTogether = 4096;
constexpr std::uint64_t kTakes = 64;

/// Photons of neighbouring numbers.
struct PhotonTake {
    std::vector<Photon> photons;
    RayCounters counters;
    std::uint64_t powerful = 0;  ///< that left a light
};

}  // namespace

void note_silent_lights(const Illumination& lights, const char* renderer, RenderReport& report) {
    if (!lights.leaves_some_to_chance()) return;
    report.notes.push_back(
        fmt::format("{}: some emitting surfaces light nothing, for they cannot be sampled; "
                    "path_tracing finds their light",
                    renderer));
}

ShotPhotons shoot_photons(const RenderJob& job, const Illumination& lights, const PhotonShot& shot,
                          std::size_t most, const char* renderer) {
    ShotPhotons shot_photons;
    std::vector<PhotonTake> takes(kTakes);
    std::uint64_t powerful = 0;
    ThreadLimit threads(job.control.threads);
    for (std::uint64_t first = 0; first < shot.count; first += kTakes * kTogether) {
        const std::uint64_t numbers = std::min(kTakes * kTogether, shot.count - first);
        const std::uint64_t count = (numbers + kTogether - 1) / kTogether;
        threads.run([&] {
            parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    PhotonTake& take = takes[i];
                    take = {};
                    if (job.stop_requested()) return;
                    PhotonWalk walk(job.scene, lights, shot, take.counters,
                                    job.count_tests ? &take.counters.tests : nullptr);
                    const std::uint64_t from = first + i * kTogether;
                    const std::uint64_t to = std::min(from + kTogether, first + numbers);
                    for (std::uint64_t n = from; n < to; ++n) {
                        take.powerful += walk.shoot(n, take.photons);
                    }
                }
            });
        });
        for (std::uint64_t i = 0; i < count; ++i) {
            const PhotonTake& take = takes[i];
            shot_photons.counters += take.counters;
            powerful += take.powerful;
            std::vector<Photon>& all = shot_photons.photons;
            if (all.size() + take.photons.size() > most) {
                throw Error(ErrorKind::Resource,
                            fmt::format("{}: {} of {} photons fill the memory, which has place "
                                        "for {} at surfaces; give it more (memory=MB), or shoot "
                                        "fewer",
                                        renderer, first + (i + 1) * kTogether, shot.count, most));
            }
            all.insert(all.end(), take.photons.begin(), take.photons.end());
        }
        if (powerful == 0) {
            throw Error(ErrorKind::Usage,
                        fmt::format("{}: no light of the scene sends photons: its emitting "
                                    "surfaces cannot be sampled; path_tracing finds their light",
                                    renderer));
        }
        shot_photons.complete = !job.stop_requested();
        if (!shot_photons.complete) break;
        if (job.control.progress != nullptr) {
            job.control.progress->update("photons", first + numbers, shot.count);
        }
    }
    return shot_photons;
}

}  // namespace alhazen
