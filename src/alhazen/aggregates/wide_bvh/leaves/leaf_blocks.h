#pragma once
/// The layout of primitives in the leaves of the wide BVH: eight of one kind, lane by lane, in
/// float and in the local frame, for the filters (triangle_filter.h, shape_filters.h). Triangles
/// and spheres are stored themselves, round shapes as a cylinder around them, and all others,
/// including rectangles and instances, as a slanted box.
///
/// Conventions: lanes are in ascending order of id; the used lanes come first.

#include <bit>
#include <cstdint>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/accel/wide_bvh/build/collapse.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/shapes/quadrics/sphere.h"

namespace alhazen {

class BoundedPrimitives;
class PrimitiveTable;

inline constexpr std::size_t kBlockWidth = 8;

/// Kinds of leaves, as NodeRef::kind.
enum class LeafType : std::uint32_t { Triangles, Spheres, Frustums, Others };

/// The primitive of a lane, with two flags.
class BlockId {
  public:
    BlockId() = default;
    BlockId(PrimitiveId id, bool opaque, bool exact)
        : bits_(static_cast<std::uint32_t>(id) | (opaque ? kOpaqueBit : 0u) |
                (exact ? kExactBit : 0u)) {}
    /// The value of unused lanes.
    [[nodiscard]] static BlockId none() { return {kNoPrimitive, true, true}; }

    [[nodiscard]] bool used() const { return bits_ != static_cast<std::uint32_t>(kNoPrimitive); }
    [[nodiscard]] PrimitiveId id() const { return PrimitiveId{bits_ & kLimit}; }
    /// True if the primitive is opaque.
    [[nodiscard]] bool opaque() const { return (bits_ & kOpaqueBit) != 0; }

    /// True if a block of triangles or spheres holds the primitive unrounded.
    [[nodiscard]] bool exact() const { return (bits_ & kExactBit) != 0; }

    /// Bound of the ids that fit.
    static constexpr std::uint32_t kLimit = 0x3FFFFFFFu;
    /// The bit of `exact`, for code that reads ids in lanes.
    static constexpr std::uint32_t kExactBit = 1u << 30;

  private:
    static constexpr std::uint32_t kOpaqueBit = 1u << 31;
    std::uint32_t bits_;
};

/// Five cache lines. Unused lanes hold a triangle far outside the scene.
struct alignas(64) TriangleBlock {
    float vertex[3][3][kBlockWidth];  ///< [corner][axis][lane], in the frame of the tree
    BlockId ids[kBlockWidth];

    [[nodiscard]] Vec3 corner(std::size_t i, std::size_t lane) const {
        return {vertex[i][0][lane], vertex[i][1][lane], vertex[i][2][lane]};
    }
};
static_assert(sizeof(TriangleBlock) == 320);

/// Replaces a TriangleBlock to save memory: the vertices are read from the mesh.
struct alignas(32) IndexBlock {
    BlockId ids[kBlockWidth];
};

/// The number of used lanes of a block.
template <class Block>
[[nodiscard]] std::uint32_t used_lanes(const Block& block) {
    std::uint32_t count = 0;
    for (const BlockId& id : block.ids) count += id.used();
    return count;
}

/// The number of used lanes that are not among the candidates.
template <class Block>
[[nodiscard]] std::uint32_t filtered_out(const Block& block, std::uint32_t candidates) {
    const std::uint32_t used = used_lanes(block);
    return used - static_cast<std::uint32_t>(std::popcount(candidates & ((1u << used) - 1)));
}

/// Spheres without a placement.
struct alignas(64) SphereBlock {
    float center[3][kBlockWidth];  ///< [axis][lane]
    float radius[kBlockWidth];     ///< includes the rounding of the center
    BlockId ids[kBlockWidth];
    std::uint32_t lanes = 0;  ///< bits of the used lanes; the others repeat the first

    /// Bits of the lanes whose filter may be sure of a hit.
    [[nodiscard]] std::uint32_t may_be_sure() const { return lanes; }
    /// The sphere of a lane that is exact: the radius is one step above its own.
    [[nodiscard]] Sphere sphere(std::size_t lane, const LocalFrame& frame) const {
        const auto bits = std::bit_cast<std::uint32_t>(radius[lane]) - 1;
        return {frame.world({center[0][lane], center[1][lane], center[2][lane]}),
                frame.inverse_scale * std::bit_cast<float>(bits)};
    }
};
static_assert(sizeof(SphereBlock) == 192);

/// Cylinders around cylinders, cones and discs without a placement; and spheres, as cylinders
/// without an axis, which have no ends.
struct alignas(64) FrustumBlock {
    float center[3][kBlockWidth];
    float axis[3][kBlockWidth];      ///< of length 1, up to rounding; of spheres 0
    float half_height[kBlockWidth];  ///< of spheres kEndless
    float radius[kBlockWidth];       ///< the larger one
    BlockId ids[kBlockWidth];
    std::uint32_t lanes = 0;  ///< as in a SphereBlock
    /// Bits of the spheres and cylinders, whose filter may be sure of a hit.
    std::uint32_t certain = 0;
    std::uint32_t balls = 0;  ///< bits of the spheres

    static constexpr float kEndless = 0x1p60f;
    [[nodiscard]] std::uint32_t may_be_sure() const { return certain; }
};
static_assert(sizeof(FrustumBlock) == 320);

/// Slanted boxes around all primitives without a block of their own: all p with |direction_k . (p -
/// center)| <= half_k, for k = 0, 1, 2; and balls around the same centers that contain them too.
struct alignas(64) BoxBlock {
    float center[3][kBlockWidth];
    float direction[3][3][kBlockWidth];  ///< [k][axis][lane]; of length 1, up to rounding
    float half[3][kBlockWidth];          ///< [k][lane]; -inf for an unused lane
    float radius[kBlockWidth];
    /// Of a polygon or rectangle across direction_2: a line that crosses that slab within the two
    /// others, narrowed by this on each side, hits it. If negative: a line that crosses it within
    /// the disc of this radius around the center. Else kNoInset, or kNotFlat.
    float inset[kBlockWidth];
    BlockId ids[kBlockWidth];
    static constexpr float kNoInset = 0x1p60f, kNotFlat = 0x1p61f;

    /// As in a SphereBlock.
    [[nodiscard]] std::uint32_t may_be_sure() const {
        std::uint32_t lanes = 0;
        for (std::uint32_t i = 0; i < kBlockWidth; ++i)
            lanes |= std::uint32_t{inset[i] < kNoInset} << i;
        return lanes;
    }
};
static_assert(sizeof(BoxBlock) == 576);

/// A wide BVH over a table, with its leaves.
struct WideBvhLayout {
    LocalFrame frame;
    WideBvh tree;
    MappableVector<TriangleBlock> triangles;
    /// Replaces `triangles` in a tree with Leaves::Indices.
    MappableVector<IndexBlock> indices;
    MappableVector<SphereBlock> spheres;
    MappableVector<FrustumBlock> frustums;
    MappableVector<BoxBlock> others;

    /// True if the triangles are in `indices`.
    [[nodiscard]] bool is_indexed() const { return !indices.empty(); }
    [[nodiscard]] std::size_t memory_bytes() const;
    /// Expected cost of a ray that meets the box, in visits of a node; see
    /// accel/wide_bvh/build/sah_cost.h.
    [[nodiscard]] double sah_cost() const;
};

/// Calls `f` with every array of a layout. Every new array must be added here: this function
/// determines what is measured, stored and loaded.
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

/// The box that the frame of a tree over these primitives is made for.
[[nodiscard]] Box3 box_of_bounded(const BoundedPrimitives& bounded);

/// Builds a tree over the bounded primitives, in parallel; the result is the same for every number
/// of threads.
[[nodiscard]] WideBvhLayout build_wide_bvh(const PrimitiveTable& table,
                                           const BoundedPrimitives& bounded,
                                           const BuildOptions& options = {});

}  // namespace alhazen
