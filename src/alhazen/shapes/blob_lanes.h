#pragma once
/// Where the balls of a blob hold along eight rays, side by side in lanes.
///
/// Source: blob.cpp, the same operations in the same order. Differs: nothing. Conventions: internal
/// to this folder. Every target gives the bits of the scalar text.

#include <cstddef>
#include <cstdint>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Eight rays from points near a blob; what is not used repeats the first.
struct alignas(64) BlobRayLanes {
    static constexpr std::size_t kWidth = 8;

    double origin[3][kWidth], direction[3][kWidth];  ///< [axis][lane]
    double pad[kWidth];                              ///< room for what the origin rounds
};

/// Along each of them the range within a ball, and 1 - (distance / radius)^2 there, which is
/// peak - bend (t - middle)^2.
struct alignas(64) BallLanes {
    static constexpr std::size_t kWidth = BlobRayLanes::kWidth;

    double lo[kWidth], hi[kWidth], middle[kWidth], peak[kWidth], bend[kWidth];
};

/// The set of rays that the ball may hold on, bit i for ray i; only of these something is written.
using WithinBallKernel = std::uint32_t (*)(const BlobRayLanes&, const Vec3& center, double radius,
                                           BallLanes&);

/// For the best instruction set of this machine, or the one that is forced (simd/targets.h).
[[nodiscard]] WithinBallKernel within_ball_kernel();

}  // namespace alhazen
