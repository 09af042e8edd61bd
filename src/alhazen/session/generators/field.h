#pragma once
/// A meadow of any number of grass blades, built by instancing a few thousand stored ones.
///
/// Source: Snyder and Barr, "Ray Tracing Complex Models Containing Surface Tessellations", SIGGRAPH
/// 1987: a field of 2 * 10^9 primitives by instances of lists and grids of instances.
/// Differs: their objects are not published; these are modelled here. `field` leaves the choice of
/// the accelerator to the user.
/// Conventions: metres. A tuft has 1000 triangles. 10 x 10 tufts, randomly rotated, scaled and
/// moved, form a patch, 10 x 10 patches a plot, and so on; the largest units are laid out in rows.
/// Every level has four variants.

#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// At least `triangles` triangles, counted with instances expanded, and a ground plane.
[[nodiscard]] SceneDescription field(std::uint64_t triangles);

/// The same scene with explicit grids, as in the source: 10 x 10 cells per patch and plot, default
/// grid per tuft, and a grid over the rows.
[[nodiscard]] SceneDescription field_of_grids(std::uint64_t triangles);

}  // namespace alhazen
