#pragma once
/// The first transitions of eight rays with a solid of a few convex leaves, side by side in lanes.
///
/// Source: csg_truth_table.h, the same solid and the same rules. Differs: what is inside of what
/// where a leaf is crossed is a comparison with the ends of the others' spans, so nothing is
/// sorted; crossings that lie nearly together are left to the scalar text. Conventions: internal
/// to this folder. Bit i of a set of lanes stands for lane i. Every target gives the bits of the
/// scalar text.

#include <cstdint>

#include "alhazen/shapes/span_lanes.h"

namespace alhazen {

/// What the kernel knows of a solid.
struct CsgLanesSolid {
    static constexpr std::uint32_t kMaxLeaves = 6;

    std::uint32_t leaf_count = 0;
    /// [leaf] bit s: where a ray is inside of the leaves whose bits are set in s, the leaf's own
    /// among those that are not, it enters or leaves the solid where it enters the leaf.
    std::uint64_t changes[kMaxLeaves] = {};
    // What crossings must lie apart: `apart` times the sum of `size` and the distance of the
    // origin from the center along the axis where it is largest.
    Vec3 center;
    double size = 0, apart = 0;
};

struct alignas(64) CsgLanesHits {
    double t[kRayLanes];
    double event[kRayLanes];  ///< whole numbers: twice the leaf, and 1 where it is left
    std::uint32_t hit;
    std::uint32_t unsure;  ///< ask the scalar text; not in `hit`
};

/// Those of one instruction set.
struct CsgLanesKernels {
    /// Of `wanted`: the rays whose range meets the span of a leaf, or that are unsure of it.
    std::uint32_t (*in_range)(const CsgLanesSolid&, const RayLanes&, const SpanLanes&,
                              std::uint32_t wanted);
    /// [leaf] the spans of all leaves, known for `wanted` rays but where they are unsure.
    void (*first)(const CsgLanesSolid&, const RayLanes&, const SpanLanes*, std::uint32_t wanted,
                  CsgLanesHits&);
};

/// For the best instruction set of this machine, or the one that is forced (simd/targets.h).
[[nodiscard]] const CsgLanesKernels& csg_lanes_kernels();

}  // namespace alhazen
