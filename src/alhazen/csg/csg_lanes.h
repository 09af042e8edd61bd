#pragma once
/// The first transitions of eight rays with a solid of a few convex leaves, side by side in lanes.
///
/// Source: csg_truth_table.h, the same solid and the same rules. Differs: what is inside of what
/// where a leaf is crossed is a comparison with the ends of the others' spans, so nothing is
/// sorted; where all rays enter the leaf without which there is nothing far from the others, these
/// are not crossed at all, nor counted; crossings that lie nearly together are left to the scalar
/// text. Conventions: internal to this folder. Bit i of a set of lanes stands for lane i. Every
/// target gives the bits of the scalar text.

#include <cstdint>

#include "alhazen/math/vec.h"
#include "alhazen/primitives/lane_solid.h"

namespace alhazen {

struct Frustum;

/// What the kernel knows of a solid.
struct CsgLanesSolid {
    static constexpr std::uint32_t kMaxLeaves = 6;
    enum class Kind : std::uint32_t { None, Sphere, Box, Frustum };

    struct Leaf {
        PrimitiveId id{0};
        Kind kind = Kind::None;
        const void* shape = nullptr;  ///< a Sphere, a BoxShape or a Frustum with its caps
        bool needed = false;          ///< where it is not, nothing is
        /// Bit s: where a ray is inside of the leaves (by their places here) whose bits are set in
        /// s, this one among those that are not, it enters or leaves the solid where it enters the
        /// leaf.
        std::uint64_t changes = 0;
    };
    std::uint32_t leaf_count = 0;
    /// The first leaf is the only one that is needed, and where a ray enters it alone it enters the
    /// solid.
    bool begins_with_first = false;
    RayMask visible_to = kAllRays;  ///< rays that see all leaves
    // What crossings must lie apart: `apart` times the sum of `size` and the distance of the
    // origin from the center along the axis where it is largest.
    Vec3 center;
    double size = 0, apart = 0;
    Leaf leaves[kMaxLeaves];  ///< those that are needed first
};

/// What the kernel tells beside the hits.
struct CsgLanesReport {
    std::uint32_t unsure;            ///< rays that the scalar text must be asked for
    std::uint32_t tests, tests_met;  ///< of rays with leaves, where they are sure
};

/// That of one instruction set.
struct CsgLanesKernel {
    /// Of `wanted` rays those that hit; none that it is unsure of.
    std::uint32_t (*first)(const CsgLanesSolid&, const RayLanes&, std::uint32_t wanted, LaneHits&,
                           CsgLanesReport&);
    bool knows_frusta;  ///< else every ray is unsure of them
};

/// For the best instruction set of this machine, or the one that is forced (simd/targets.h).
[[nodiscard]] const CsgLanesKernel& csg_lanes_kernel();

}  // namespace alhazen
