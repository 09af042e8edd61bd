#pragma once
/// The generated scenes whose subject is CSG (see generate.h).

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// A plate of 2 x 2 x 0.1 with `holes` round holes in a square grid.
[[nodiscard]] SceneDescription perforated_plate(std::uint64_t holes);

/// A unit cube without square bars through it (Menger 1926): 8^(k-1) of them along each axis for
/// level k. The first level with `leaves` leaves, the cube included.
[[nodiscard]] SceneDescription menger_sponge(std::uint64_t leaves);

/// `spheres` spheres in a cubic grid, each a difference of its own.
[[nodiscard]] SceneDescription drilled_spheres(std::uint64_t spheres);

}  // namespace alhazen
