#pragma once
/// Scenes that are hard for some accelerators: a teapot in a stadium, long thin objects across the
/// axes, many objects in one place. Sizes are stated with each function.
///
/// Source: teapot in a stadium: Haines, Ray Tracing News, 1988. The shapes are modelled here.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// A teapot of at least `triangles` triangles in a stadium of as many, about 500 times its size: a
/// grid cell sized for the stadium contains the whole teapot.
[[nodiscard]] SceneDescription stadium(std::uint64_t triangles);

/// `sticks` cylinders through a cube in random directions, 500 times as long as thick: their boxes
/// are almost empty and overlap.
[[nodiscard]] SceneDescription thin_sticks(std::uint64_t sticks);

/// `spheres` spheres in clusters of 64: half of each cluster are identical, the others share their
/// centre. No plane and no median divides a cluster.
[[nodiscard]] SceneDescription coincident_clusters(std::uint64_t spheres);

}  // namespace alhazen
