#pragma once
/// Small scenes for the experiments of claims.h: N equal primitives in a cube, some of them
/// mirrors, and one light. The same on every machine.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

enum class ClaimShape { Spheres, Boxes, Cylinders, ThinSticks };

/// `spread`: scale of the primitives' size; 1 fills about a tenth of the cube for any count.
[[nodiscard]] SceneDescription claim_scene(ClaimShape shape, std::uint64_t count,
                                           double spread = 1);

}  // namespace alhazen
