#pragma once
/// All photons of a shot, by all threads.
///
/// Conventions: photons are in the order of their numbers, and for one number in that of the
/// surfaces: the same for any number of threads. Memory: at most `most` photons and what a group of
/// numbers adds to them.

#include <cstddef>
#include <vector>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/photons/photon_walk.h"

namespace alhazen {

struct ShotPhotons {
    std::vector<Photon> photons;  ///< at surfaces
    std::vector<Photon> in_volumes;
    RayCounters counters;
    bool complete = true;  ///< false after a stop
};

/// A sentence for RenderReport::notes where some lights send no photons, though others do.
void note_silent_lights(const Illumination& lights, const char* renderer, RenderReport& report);

/// `renderer`: its name, for messages. Throws Error: Resource where more than `most` would be
/// stored, Usage where no light gives any photon power.
[[nodiscard]] ShotPhotons shoot_photons(const RenderJob& job, const Illumination& lights,
                                        const PhotonShot& shot, std::size_t most,
                                        const char* renderer);

}  // namespace alhazen
