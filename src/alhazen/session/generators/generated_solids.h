#pragma once
/// Generated scenes of CSG (see generate.h).

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// A plate of 2 x 2 x 0.1 with `holes` round holes in a square grid.
[[nodiscard]] SceneDescription perforated_plate(std::uint64_t holes);

/// A unit cube minus square bars (Menger 1926): 8^(k-1) of them along each axis for level k. The
/// first level with at least `leaves` leaves, including the cube.
[[nodiscard]] SceneDescription menger_sponge(std::uint64_t leaves);

/// `spheres` spheres in a cubic grid, each a separate difference.
[[nodiscard]] SceneDescription drilled_spheres(std::uint64_t spheres);

}  // namespace alhazen
