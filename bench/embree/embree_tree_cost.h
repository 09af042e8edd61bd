#pragma once
/// Cost of the trees of Embree's builders in the measure of wide_bvh, to compare building time at
/// equal cost.
/// Embree gives no access to the trees of its scenes. Its builder is called through rtcBuildBVH
/// with the settings that its scenes use (eight children, blocks of four, leaves of four to 28),
/// which makes the same kind of tree, but not necessarily the same tree.
/// Conventions: as in accel/wide_bvh/build/sah_cost.h: node visits of a random line that intersects
/// the box; a leaf costs its blocks.

#include <embree3/rtcore.h>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::bench {

/// Leaves test `width` triangles together at the cost of `block_cost` node visits.
[[nodiscard]] double embree_tree_cost(const TriangleMesh& mesh, RTCBuildQuality quality,
                                      std::size_t width, double block_cost);

}  // namespace alhazen::bench
