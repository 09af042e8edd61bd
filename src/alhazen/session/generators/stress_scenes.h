#pragma once
/// Scenes that are hard for some accelerators.
///
/// Source: the teapot in a stadium (Haines, Ray Tracing News, 1988); long thin objects across the
/// axes; many objects in one place.
/// Differs: the shapes are new.
/// Conventions: the size is stated with each.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// A teapot of at least `triangles` triangles in a stadium of as many, about 500 times its size:
/// cells that fit one hold all of the other.
[[nodiscard]] SceneDescription stadium(std::uint64_t triangles);

/// `sticks` cylinders through a cube, in all directions, 500 times as long as thick: their boxes
/// are almost empty, and overlap.
[[nodiscard]] SceneDescription thin_sticks(std::uint64_t sticks);

/// `spheres` spheres in clusters of 64: half of each are the same sphere, the others share its
/// centre. No plane and no median divides a cluster.
[[nodiscard]] SceneDescription coincident_clusters(std::uint64_t spheres);

}  // namespace alhazen
