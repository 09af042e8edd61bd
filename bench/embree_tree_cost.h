#pragma once
/// What the trees of Embree's builders cost by our measure, to compare building time at equal cost.
///
/// Embree does not show the trees of its scenes. Its builder is called through rtcBuildBVH with the
/// settings that its scenes use (eight children, blocks of four, leaves of four to 28), which makes
/// the same kind of tree but perhaps not the very same one.
/// Conventions: as in accel/wide_bvh/build/sah_cost.h: visits of a node for a random line that
/// meets the box; a leaf costs its blocks.

#include <embree3/rtcore.h>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::bench {

/// `width` triangles of a leaf are tested together at `block_cost` visits of a node.
[[nodiscard]] double embree_tree_cost(const TriangleMesh& mesh, RTCBuildQuality quality,
                                      std::size_t width, double block_cost);

}  // namespace alhazen::bench
