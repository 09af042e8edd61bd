#pragma once
/// Finds the first transitions of eight rays in lanes for a solid of a few convex leaves.
///
/// Source: csg_truth_table.h: the same solids and rules.
/// Differs: comparisons with the ends of the leaves' spans tell which leaves contain a crossing, so
/// nothing is sorted. If all rays enter the only needed leaf far from the others, the others are
/// neither tested nor counted. Nearly coincident crossings are left to the scalar version.
/// Conventions: internal to this folder. Bit i of a set of lanes represents lane i. Every target is
/// bit-identical to the scalar version.

#include <cstdint>

#include "alhazen/math/vec.h"
#include "alhazen/primitives/lane_solid.h"

namespace alhazen {

struct Frustum;

/// The data of a solid for the kernel.
struct CsgLanesSolid {
    static constexpr std::uint32_t kMaxLeaves = 6;
    enum class Kind : std::uint32_t { None, Sphere, Box, Frustum };

    struct Leaf {
        PrimitiveId id{0};
        Kind kind = Kind::None;
        const void* shape = nullptr;  ///< a Sphere, a BoxShape or a Frustum with its caps
        bool needed = false;          ///< the solid is empty without it
        /// Bit s: entering this leaf enters or leaves the solid if the ray is inside exactly the
        /// other leaves whose bits (indices here) are set in s.
        std::uint64_t changes = 0;
    };
    std::uint32_t leaf_count = 0;
    /// The first leaf is the only needed one, and a ray that enters only this leaf enters the
    /// solid.
    bool begins_with_first = false;
    RayMask visible_to = kAllRays;  ///< rays that see all leaves
    // The minimum distance of crossings is `apart` times the sum of `size` and the largest
    // component of the distance of the origin from the center.
    Vec3 center;
    double size = 0, apart = 0;
    Leaf leaves[kMaxLeaves];  ///< needed leaves first
};

/// Results of the kernel besides the hits.
struct CsgLanesReport {
    std::uint32_t unsure;            ///< rays left to the scalar version
    std::uint32_t tests, tests_met;  ///< tests of rays with leaves, without unsure ones
};

/// The kernel of one instruction set.
struct CsgLanesKernel {
    /// Finds the first hits; returns the rays of `wanted` that hit, without unsure ones.
    std::uint32_t (*first)(const CsgLanesSolid&, const RayLanes&, std::uint32_t wanted, LaneHits&,
                           CsgLanesReport&);
    bool knows_frusta;  ///< false: every ray is unsure for solids with frusta
};

/// The kernel for the best instruction set of this machine, or the forced one (simd/targets.h).
[[nodiscard]] const CsgLanesKernel& csg_lanes_kernel();

}  // namespace alhazen
