#pragma once
/// Finds the first transitions of eight rays, in lanes, with a solid of a few convex leaves.
///
/// Source: csg_truth_table.h, the same solid and the same rules.
/// Differs: the leaves that contain a crossing follow from comparisons with the ends of their
/// spans, so nothing is sorted; where all rays enter the only needed leaf far from the others, the
/// others are neither crossed nor counted; nearly coincident crossings are left to the scalar
/// version.
/// Conventions: internal to this folder. Bit i of a set of lanes represents lane i. Every target
/// gives the bits of the scalar version.

#include <cstdint>

#include "alhazen/math/vec.h"
#include "alhazen/primitives/lane_solid.h"

namespace alhazen {

struct Frustum;

/// The data of a solid used by the kernel.
struct CsgLanesSolid {
    static constexpr std::uint32_t kMaxLeaves = 6;
    enum class Kind : std::uint32_t { None, Sphere, Box, Frustum };

    struct Leaf {
        PrimitiveId id{0};
        Kind kind = Kind::None;
        const void* shape = nullptr;  ///< a Sphere, a BoxShape or a Frustum with its caps
        bool needed = false;          ///< without it the solid is empty
        /// Bit s: for a ray inside of the leaves whose bits (by their indices here) are set in s,
        /// and outside of this leaf, entering the leaf enters or leaves the solid.
        std::uint64_t changes = 0;
    };
    std::uint32_t leaf_count = 0;
    /// The first leaf is the only needed one, and a ray that enters it alone enters the solid.
    bool begins_with_first = false;
    RayMask visible_to = kAllRays;  ///< rays that see all leaves
    // The minimum distance of crossings: `apart` times the sum of `size` and the distance of the
    // origin from the center along the axis where it is largest.
    Vec3 center;
    double size = 0, apart = 0;
    Leaf leaves[kMaxLeaves];  ///< needed leaves first
};

/// Results of the kernel besides the hits.
struct CsgLanesReport {
    std::uint32_t unsure;            ///< rays that need the scalar version
    std::uint32_t tests, tests_met;  ///< tests of rays with leaves, without unsure ones
};

/// The kernel of one instruction set.
struct CsgLanesKernel {
    /// Returns the rays of `wanted` that hit, without unsure ones.
    std::uint32_t (*first)(const CsgLanesSolid&, const RayLanes&, std::uint32_t wanted, LaneHits&,
                           CsgLanesReport&);
    bool knows_frusta;  ///< otherwise every ray is unsure for frusta
};

/// The kernel for the best instruction set of this machine, or the forced one (simd/targets.h).
[[nodiscard]] const CsgLanesKernel& csg_lanes_kernel();

}  // namespace alhazen
