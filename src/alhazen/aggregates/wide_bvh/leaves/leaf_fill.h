#pragma once
/// Writes primitives into the blocks of leaves.

#include <span>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

namespace alhazen {

/// [corner][axis] The triangle in an unused lane: few rays come near it, and its hits are ignored
/// by the lane's id.
inline constexpr float kUnusedTriangle[3][3] = {{40, 47, 53}, {41, 45, 52}, {42, 48, 50}};

/// A triangle to be written into a leaf.
struct LeafTriangle {
    const Vec3* corner[3];
    PrimitiveId id;
    bool opaque;
};

/// Up to kBlockWidth triangles, in the order of their ids; the other lanes are unused.
void fill_block(TriangleBlock& block, std::span<const LeafTriangle> triangles,
                const LocalFrame& frame);
void fill_block(IndexBlock& block, std::span<const LeafTriangle> triangles,
                const LocalFrame& frame);

/// Up to kBlockWidth primitives, in the order of their ids; the other lanes are unused.
void fill_block(TriangleBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame);
/// The lanes are not exact: vertices are read from the mesh.
void fill_block(IndexBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame);
/// The bodies are rounded outward to float.
void fill_block(SphereBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame);
void fill_block(FrustumBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame);
void fill_block(BoxBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame);

}  // namespace alhazen
