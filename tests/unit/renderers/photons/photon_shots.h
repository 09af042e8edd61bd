#pragma once
/// Photons of a scene for tests, and their power.

#include <vector>

#include "alhazen/renderers/photons/photon_shooting.h"

namespace alhazen::testing {

inline ShotPhotons shot_of(const Scene& scene, const PhotonShot& shot, int threads = 1) {
    const RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .control = {.threads = threads}};
    return shoot_photons(job, Illumination(scene), shot, std::size_t{1} << 30, "test");
}
/// The total power.
inline Rgb power_of(const std::vector<Photon>& photons) {
    Rgb sum;
    for (const Photon& p : photons) sum += kColorChannels.color(p.light());
    return sum;
}

}  // namespace alhazen::testing
