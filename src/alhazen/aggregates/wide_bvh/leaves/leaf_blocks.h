#pragma once
/// How primitives lie in the leaves of the wide BVH: eight of one kind side by side, lane by lane.
/// All are there in float, in the local frame, for the filters (triangle_filter.h,
/// shape_filters.h): triangles and spheres as they are, what is round in a cylinder around it, all
/// else, rectangles and instances among it, in a slanted box.
///
/// Conventions: lanes are in ascending order of id; the used ones come first.

#include <cstdint>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/accel/wide_bvh/build/collapse.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/geometry/hit.h"

namespace alhazen {

class BoundedPrimitives;
class PrimitiveTable;

inline constexpr std::size_t kBlockWidth = 8;

/// Kinds of leaf, as NodeRef::kind.
enum class LeafType : std::uint32_t { Triangles, Spheres, Frustums, Others };

/// What a lane holds.
class BlockId {
  public:
    BlockId() = default;
    BlockId(PrimitiveId id, bool opaque, bool exact)
        : bits_(static_cast<std::uint32_t>(id) | (opaque ? kOpaqueBit : 0u) |
                (exact ? kExactBit : 0u)) {}
    /// Of the lanes that are not in use.
    [[nodiscard]] static BlockId none() { return {kNoPrimitive, true, true}; }

    [[nodiscard]] bool used() const { return bits_ != static_cast<std::uint32_t>(kNoPrimitive); }
    [[nodiscard]] PrimitiveId id() const { return PrimitiveId{bits_ & kLimit}; }
    /// It lets no light through.
    [[nodiscard]] bool opaque() const { return (bits_ & kOpaqueBit) != 0; }

    /// What a block of triangles holds of it is all of it, not rounded.
    [[nodiscard]] bool exact() const { return (bits_ & kExactBit) != 0; }

    /// Ids from this on do not fit.
    static constexpr std::uint32_t kLimit = 0x3FFFFFFFu;

  private:
    static constexpr std::uint32_t kOpaqueBit = 1u << 31;
    static constexpr std::uint32_t kExactBit = 1u << 30;
    std::uint32_t bits_;
};

/// Five cache lines. Lanes not in use hold a triangle far outside of the scene.
struct alignas(64) TriangleBlock {
    float vertex[3][3][kBlockWidth];  ///< [corner][axis][lane], in the frame of the tree
    BlockId ids[kBlockWidth];

    [[nodiscard]] Vec3 corner(std::size_t i, std::size_t lane) const {
        return {vertex[i][0][lane], vertex[i][1][lane], vertex[i][2][lane]};
    }
};
static_assert(sizeof(TriangleBlock) == 320);

/// In place of a TriangleBlock where memory counts: the vertices are read from the mesh.
struct alignas(32) IndexBlock {
    BlockId ids[kBlockWidth];
};

/// How many lanes of a block are in use.
template <class Block>
[[nodiscard]] std::uint32_t used_lanes(const Block& block) {
    std::uint32_t count = 0;
    for (const BlockId& id : block.ids) count += id.used();
    return count;
}

/// Spheres that stand in the frame of the aggregate.
struct alignas(64) SphereBlock {
    float center[3][kBlockWidth];  ///< [axis][lane]
    float radius[kBlockWidth];     ///< with room for the rounding of the center
    BlockId ids[kBlockWidth];
    std::uint32_t lanes = 0;  ///< a bit for each lane in use; the others repeat the first
};
static_assert(sizeof(SphereBlock) == 192);

/// Cylinders around cylinders, cones and discs that stand in the frame of the aggregate.
struct alignas(64) FrustumBlock {
    float center[3][kBlockWidth];
    float axis[3][kBlockWidth];  ///< of length 1, rounded
    float half_height[kBlockWidth];
    float radius[kBlockWidth];  ///< the wider one
    BlockId ids[kBlockWidth];
    std::uint32_t lanes = 0;  ///< as in a SphereBlock
};
static_assert(sizeof(FrustumBlock) == 320);

/// Slanted boxes around whatever has no block of its own: all p with |direction_k . (p - center)|
/// at most half_k, for k = 0, 1, 2; and balls around the same centers that hold it too.
struct alignas(64) BoxBlock {
    float center[3][kBlockWidth];
    float direction[3][3][kBlockWidth];  ///< [k][axis][lane]; of length 1, rounded
    float half[3][kBlockWidth];          ///< [k][lane]; of a free lane -inf
    float radius[kBlockWidth];
    BlockId ids[kBlockWidth];
};
static_assert(sizeof(BoxBlock) == 576);

/// A wide BVH over a table, with its leaves.
struct WideBvhLayout {
    LocalFrame frame;
    WideBvh tree;
    MappableVector<TriangleBlock> triangles;
    /// In place of `triangles` in a tree with Leaves::Indices.
    MappableVector<IndexBlock> indices;
    MappableVector<SphereBlock> spheres;
    MappableVector<FrustumBlock> frustums;
    MappableVector<BoxBlock> others;

    /// The triangles are in `indices`.
    [[nodiscard]] bool is_indexed() const { return !indices.empty(); }
    [[nodiscard]] std::size_t memory_bytes() const;
    /// Expected cost of a ray that meets the box, in visits of a node; see
    /// accel/wide_bvh/build/sah_cost.h.
    [[nodiscard]] double sah_cost() const;
};

/// Calls `f` with every array of a layout. ADD AN ARRAY HERE: it is then measured, stored and
/// loaded.
template <class Layout, class F>
void for_each_array(Layout& layout, F&& f) {
    f(layout.tree.nodes);
    f(layout.tree.nodes_of_4);
    f(layout.tree.nodes_of_16);
    f(layout.triangles);
    f(layout.indices);
    f(layout.spheres);
    f(layout.frustums);
    f(layout.others);
}

/// Of the primitives that a tree is built over: what its frame is made for.
[[nodiscard]] Box3 box_of_bounded(const BoundedPrimitives& bounded);

/// Builds over the bounded primitives; parallel, the same for every number of threads.
[[nodiscard]] WideBvhLayout build_wide_bvh(const PrimitiveTable& table,
                                           const BoundedPrimitives& bounded,
                                           const BuildOptions& options = {});

}  // namespace alhazen
