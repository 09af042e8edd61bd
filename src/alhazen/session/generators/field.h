#pragma once
/// A meadow of as many blades of grass as one likes, out of a few thousand that are stored.
///
/// Source: Snyder and Barr, "Ray Tracing Complex Models Containing Surface Tessellations", SIGGRAPH
/// 1987: a field of 2 * 10^9 primitives by instances of lists and grids of instances.
/// Differs: their objects are not published. `field` leaves the accelerator to the user.
/// Conventions: metres. A tuft is 1000 triangles; 10 x 10 tufts, turned, scaled and moved at
/// random, are a patch; 10 x 10 patches a plot, and so on; the largest are laid out in rows. There
/// are four different ones at every level.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// At least that many triangles, instances multiplied out, and a plane.
[[nodiscard]] SceneDescription field(std::uint64_t triangles);

/// The same with grids put together by hand, as in the source: one of 10 x 10 cells for each patch
/// and plot, one of equal cells for each tuft, and a grid of the rows for all.
[[nodiscard]] SceneDescription field_of_grids(std::uint64_t triangles);

}  // namespace alhazen
