#pragma once
/// What renderers with photons tell besides the picture: the photons themselves, and their density
/// at what each pixel sees.

#include <functional>
#include <span>

#include "alhazen/renderers/core/photon_cloud.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/photons/photon.h"

namespace alhazen {

/// Appends photons; nothing where `cloud` is null.
void add_to_cloud(std::span<const Photon> photons, bool caustic, PhotonCloud* cloud,
                  const Wavelengths& waves = kColorChannels);

/// Photons by area at a point with this unit geometric normal, towards the eye. Called from many
/// threads.
using PhotonCount = std::function<double(const Vec3& point, const Vec3& normal)>;

/// Sets the layer of photons: at the surface in the middle of each pixel. Nothing where the job
/// does not ask for it.
void record_photon_layer(const RenderJob& job, const Film& film, const PhotonCount& count);

}  // namespace alhazen
