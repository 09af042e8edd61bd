#pragma once
/// Cost of the trees of Embree's builders by the measure of wide_bvh, for comparing build times at
/// equal cost.
/// Embree gives no access to the trees of its scenes. Its builder is called through rtcBuildBVH
/// with the settings of its scenes (eight children, blocks of four, leaves of four to 28), which
/// makes the same kind of tree, but not necessarily the same tree.
/// Conventions: those of accel/wide_bvh/build/sah_cost.h: the cost is the node visits of a random
/// line that intersects the box; a leaf costs its blocks.

#include <embree3/rtcore.h>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::bench {

/// The cost, where leaves test `width` triangles together at the cost of `block_cost` node visits.
[[nodiscard]] double embree_tree_cost(const TriangleMesh& mesh, RTCBuildQuality quality,
                                      std::size_t width, double block_cost);

}  // namespace alhazen::bench
