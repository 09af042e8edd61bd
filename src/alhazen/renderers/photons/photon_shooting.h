#pragma once
/// Shoots all photons of a shot, in parallel.
///
/// Conventions: photons are sorted by number, and for one number by the order of the surfaces: the
/// same for any number of threads. Memory: at most `most` photons plus those of a group of numbers.

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

/// Adds a sentence to RenderReport::notes if some lights, but not all, emit no photons.
void note_silent_lights(const Illumination& lights, const char* renderer, RenderReport& report);

/// `renderer`: name for messages. Throws Error: Resource if more than `most` would be stored, Usage
/// if no light gives any photon power.
[[nodiscard]] ShotPhotons shoot_photons(const RenderJob& job, const Illumination& lights,
                                        const PhotonShot& shot, std::size_t most,
                                        const char* renderer);

}  // namespace alhazen
