#pragma once
/// Rounds vertices and fills blocks of triangles, compiled for several instruction sets: a vertex
/// is one register of doubles, and eight triangles are filled at once, where registers are so wide.
///
/// Conventions: results do not depend on the instruction set.

#include <cstdint>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/simd/registers.h"

namespace alhazen {

/// The triangles of a block: its lanes. The corners of unused lanes are those of any used one, and
/// their ids are not read.
struct LaneTriangles {
    const Float4* corner[3][kBlockWidth];
    BlockId ids[kBlockWidth];
    std::uint32_t count = 0;  ///< used lanes
};

/// What is known of the triangles of a block.
struct LaneExtent {
    Float4 lo, hi;  ///< box of the vertices; the fourth lane is undefined
    float area;     ///< those that are not opaque count half
};

struct LaneKernels {
    /// Rounds vertices to a frame; the fourth lane is 1 if the coordinates are exact, else 0.
    void (*round)(const LocalFrame& frame, const Vec3* from, std::size_t count, Float4* to);
    /// Writes a block with the vertices and flags that fill_block writes, unless it is null.
    LaneExtent (*fill)(TriangleBlock* block, const LaneTriangles& triangles);
};
/// Those of this machine.
[[nodiscard]] const LaneKernels& lane_kernels();

}  // namespace alhazen
