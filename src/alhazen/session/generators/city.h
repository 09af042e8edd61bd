#pragma once
/// A city: boxes of any number on a square of ground, for renderers of planar facets.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// `houses` boxes on a square grid, of heights that fall off exponentially; every fourth reflects a
/// fifth of the light. 6 `houses` + 1 polygons, one sun.
[[nodiscard]] SceneDescription city(std::uint64_t houses);

}  // namespace alhazen
