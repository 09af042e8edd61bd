#pragma once
/// A city: any number of boxes on square ground, for renderers of planar facets.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// `houses` boxes on a square grid with exponentially distributed heights; every fourth reflects a
/// fifth of the light. 6 `houses` + 1 polygons, one sun.
[[nodiscard]] SceneDescription city(std::uint64_t houses);

}  // namespace alhazen
