#include "alhazen/renderers/photons/photon_shooting.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/renderers/photons/numbered_shooting.h"

namespace alhazen {

void refuse_photons(const char* renderer, std::uint64_t shot, std::uint64_t count,
                    std::size_t most) {
    throw Error(ErrorKind::Resource,
                fmt::format("{}: {} of {} photons exceed the memory limit of {}; raise it "
                            "(memory=MB), or shoot fewer",
                            renderer, shot, count, most));
}

void note_silent_lights(const Illumination& lights, const char* renderer, RenderReport& report) {
    if (!lights.has_unsampled_emitters()) return;
    report.notes.push_back(
        fmt::format("{}: some emitting surfaces emit no photons because they cannot be sampled; "
                    "path_tracing finds their light",
                    renderer));
}

ShotPhotons shoot_photons(const RenderJob& job, const Illumination& lights, const PhotonShot& shot,
                          std::size_t most, const char* renderer) {
    NumberedRecords<Photon> shot_photons = shoot_numbers<Photon>(
        job, shot.count, most, renderer, [&](RayCounters& counters, TraversalStats* stats) {
            return PhotonWalk(job.scene, lights, shot, counters, stats);
        });
    if (shot.count > 0 && shot_photons.powerful == 0 && !job.stop_requested()) {
        throw Error(ErrorKind::Usage,
                    fmt::format("{}: no light of the scene emits photons: its emitting "
                                "surfaces cannot be sampled; path_tracing finds their light",
                                renderer));
    }
    std::vector<Photon>& photons = shot_photons.records;
    const auto first = std::stable_partition(photons.begin(), photons.end(),
                                             [](const Photon& p) { return !p.in_volume(); });
    std::vector<Photon> in_volumes(first, photons.end());
    photons.erase(first, photons.end());
    return {std::move(photons), std::move(in_volumes), shot_photons.counters,
            shot_photons.complete};
}

}  // namespace alhazen
