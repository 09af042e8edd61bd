#pragma once
/// What a wide BVH costs a random line that meets its box, in visits of a node: to compare trees.
///
/// Source: MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", The Visual
/// Computer 6, 1990.
/// Differs: leaves cost what their blocks do; boxes weigh as in the builders (FloatBox::weight).

#include "alhazen/accel/wide_bvh/build/collapse.h"

namespace alhazen {

/// 0 for an empty tree and one without extent.
[[nodiscard]] double sah_cost(const WideBvh& tree, const LeafKinds& kinds);

}  // namespace alhazen
