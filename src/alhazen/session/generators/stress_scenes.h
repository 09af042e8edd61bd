#pragma once
/// Scenes that are hard for one accelerator or another.
///
/// Source: the questions are the field's: the teapot in a stadium (Haines, Ray Tracing News, 1988),
/// long thin objects across the axes, many objects in one place.
/// Differs: the shapes are ours.
/// Conventions: the size is stated with each.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// A teapot of at least `triangles` triangles on the pitch of a stadium of as many, some 500 times
/// its size: cells fit for one hold all of the other.
[[nodiscard]] SceneDescription stadium(std::uint64_t triangles);

/// `sticks` cylinders through a cube, in all directions, 500 times as long as thick: their boxes
/// are nearly all empty, and overlap.
[[nodiscard]] SceneDescription thin_sticks(std::uint64_t sticks);

/// `spheres` spheres in heaps of 64: half of each are the same sphere, the others share its centre.
/// No plane and no median divides a heap.
[[nodiscard]] SceneDescription coincident_clusters(std::uint64_t spheres);

}  // namespace alhazen
