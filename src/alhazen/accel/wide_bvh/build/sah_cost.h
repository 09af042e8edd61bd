#pragma once
/// The expected cost of a wide BVH for a random line that intersects its box, in visits of a node.
///
/// Source: MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", The Visual
/// Computer 6, 1990.
/// Differs: leaves have the cost of their blocks; boxes have the weight of the builders
/// (FloatBox::weight).

#include "alhazen/accel/wide_bvh/build/collapse.h"

namespace alhazen {

/// 0 for an empty tree and for one without extent.
[[nodiscard]] double sah_cost(const WideBvh& tree, const LeafKinds& kinds);

}  // namespace alhazen
