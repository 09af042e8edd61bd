#pragma once
/// Photons as a point cloud in a PLY file.
///
/// Source: Turk, "The PLY Polygon File Format", 1994.
/// Conventions: binary, little-endian: a vertex has x y z (double), dx dy dz (unit, the direction
/// in which the photon travelled), power_r power_g power_b, and caustic (1: of the map of
/// caustics).

#include <string>

#include "alhazen/renderers/core/photon_cloud.h"

namespace alhazen {

[[nodiscard]] std::string photon_ply(const PhotonCloud& cloud);

}  // namespace alhazen
