#pragma once
/// Small scenes for the experiments of claims.h: N equal things in a cube, some of them mirrors, in
/// the light of one lamp. The same on every machine.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

enum class ClaimShape { Spheres, Boxes, Cylinders, ThinSticks };

/// `spread`: the size of things; 1 fills some tenth of the cube whatever their number.
[[nodiscard]] SceneDescription claim_scene(ClaimShape shape, std::uint64_t count,
                                           double spread = 1);

}  // namespace alhazen
