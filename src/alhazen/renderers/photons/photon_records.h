#pragma once
/// Outputs of renderers with photons in addition to the picture: the photons, and their density at
/// the visible surfaces.

#include <functional>
#include <span>

#include "alhazen/renderers/core/photon_cloud.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/photons/photon.h"

namespace alhazen {

/// Appends photons; does nothing if `cloud` is null.
void add_to_cloud(std::span<const Photon> photons, bool caustic, PhotonCloud* cloud,
                  const Wavelengths& waves = kColorChannels);

/// Photons per area at a point with this unit geometric normal, towards the eye. Must be
/// thread-safe.
using PhotonCount = std::function<double(const Vec3& point, const Vec3& normal)>;

/// Sets the layer of photons, for the surface in the middle of each pixel. Does nothing if the job
/// does not request it.
void record_photon_layer(const RenderJob& job, const Film& film, const PhotonCount& count);

}  // namespace alhazen
