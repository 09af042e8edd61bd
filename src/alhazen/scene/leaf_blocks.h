#pragma once
/// How primitives lie in the leaves of the wide BVH: eight of one kind side by side, lane by
/// lane, in double, so that the block test has the very numbers of the scalar one. Kinds without
/// a block are tested one by one.
///
/// Conventions: lanes are in ascending order of id; `lanes` has a bit for each lane in use,
/// `opaque` for each that lets no light through; lanes not in use repeat the first.

#include <cstdint>
#include <vector>

#include "alhazen/accel/wide_bvh/collapse.h"
#include "alhazen/accel/wide_bvh/local_frame.h"
#include "alhazen/accel/wide_bvh/wide_node.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/math/vec.h"

namespace alhazen {

class BoundedPrimitives;
class PrimitiveTable;

inline constexpr std::size_t kBlockWidth = 8;

/// Kinds of leaf, as NodeRef::kind.
enum class LeafType : std::uint32_t { Triangles, Spheres, Others };

/// What all blocks have beside their geometry.
struct BlockIds {
    PrimitiveId id[kBlockWidth];
    std::uint32_t lanes = 0;
    std::uint32_t opaque = 0;
};

struct alignas(64) TriangleBlock {
    double vertex[3][3][kBlockWidth];  ///< [corner][axis][lane]
    BlockIds ids;

    [[nodiscard]] Vec3 corner(int i, std::size_t lane) const {
        return {vertex[i][0][lane], vertex[i][1][lane], vertex[i][2][lane]};
    }
};
static_assert(sizeof(TriangleBlock) == 640);

/// Spheres that stand in the frame of the aggregate.
struct alignas(64) SphereBlock {
    double center[3][kBlockWidth];  ///< [axis][lane]
    double radius[kBlockWidth];
    BlockIds ids;
};
static_assert(sizeof(SphereBlock) == 320);

/// A wide BVH over a table, with its leaves.
struct WideBvhLayout {
    LocalFrame frame;
    WideBvh tree;
    std::vector<TriangleBlock> triangles;
    std::vector<SphereBlock> spheres;
    std::vector<PrimitiveId> others;

    [[nodiscard]] std::size_t memory_bytes() const;
};

/// Builds over the bounded primitives; parallel, the same for every number of threads.
[[nodiscard]] WideBvhLayout build_wide_bvh(const PrimitiveTable& table,
                                           const BoundedPrimitives& bounded);

}  // namespace alhazen
