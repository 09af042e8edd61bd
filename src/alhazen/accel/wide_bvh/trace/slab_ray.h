#pragma once
/// A ray prepared for the slab test on float boxes. The test accepts every box in which the exact
/// test, in double, of a primitive can find a hit. Made by slab_ray-inl.h.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013 (the problem).
/// Differs: a relative factor on the far distance does not suffice for the form p * r + c; all
/// slack is absolute and added to the constants c, once per ray.
/// With R the reach of the ray (1, where the scene ends in the local frame, plus the largest
/// coordinate of its origin), A = 1 / |d| along an axis and e = 2^-24, the error of the parameter
/// of a plane is at most 6.01 e R A (docs/design/boxes.md has the proof); the slack is 6.5 e R A,
/// plus the displacement `delta` for all computations in double: the local frame, the shift of the
/// origin and the rounding of the exact tests. A direction component below 2^-100 is replaced by
/// 2^-100.
/// The range of a ray begins at s >= 0, so that parameters can be compared as integers:
/// local_ray_from_afar moves the origin of a ray with a negative t_min, or far from the scene.
/// Conventions: parameters in the local frame, s = t * scale - shift (`LocalParameter`). A ray from
/// farther than 2^40 scene sizes passes every box: doubles have no precision at that distance.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// Relative rounding error of a parameter converted to the local frame.
inline constexpr double kLocalSlack = 0x1p-50;

/// Converts a parameter t of a ray to the local one.
struct LocalParameter {
    double scale;  ///< 0: parameters are out of range, nothing is skipped because of them
    double shift;

    /// Rounded up: boxes that begin beyond it contain no hit at t or before.
    [[nodiscard]] float above(double t) const {
        if (scale == 0) return std::numeric_limits<float>::infinity();
        const double s = t * scale;
        const double x = s - shift + kLocalSlack * (std::abs(s) + std::abs(shift));
        // Up to two steps more than necessary, without a branch, as the direction of rounding is
        // unpredictable.
        return static_cast<float>(x + (std::abs(x) * 0x1p-23 + 0x1p-100));
    }
    [[nodiscard]] float below(double t) const {
        const double s = t * scale;
        const double x = s - shift - kLocalSlack * (std::abs(s) + std::abs(shift));
        return static_cast<float>(x - (std::abs(x) * 0x1p-23 + 0x1p-100));
    }
};

/// The planes of a box that a ray meets first.
struct alignas(8) NearRows {
    /// Four times the index of the row of the near planes in WideNodeOf::planes, per axis: the
    /// offset in floats where a row has four children.
    std::uint16_t row[3];
    std::uint16_t octant;  ///< bit k is set if the direction is negative along axis k

    /// As `row`, for the far planes.
    [[nodiscard]] std::size_t far_row(std::size_t axis) const {
        return 4 * (2 * axis + 3) - row[axis];
    }
};

/// [octant]
inline constexpr std::array<NearRows, 8> kNearRows = [] {
    std::array<NearRows, 8> table{};
    for (std::uint16_t octant = 0; octant < 8; ++octant) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t down = octant >> k & 1;
            table[octant].row[k] = static_cast<std::uint16_t>(4 * (k + 3 * down));
        }
        table[octant].octant = octant;
    }
    return table;
}();

/// The input of the slab test of a node, one cache line.
struct alignas(64) SlabRay {
    float reciprocal[4], near_offset[4], far_offset[4];  ///< [axis]; the fourth is not used
    float s_min, s_max;
    NearRows near;
};
static_assert(sizeof(SlabRay) == 64);

/// A ray in the local frame, moved close to the scene.
struct alignas(16) LocalRay {
    float origin[4], direction[4];  ///< origin after the shift; the fourth is 0
    float reach, delta;             ///< as in FrameSlack
    /// The two ends of the ray's range, rounded down and up.
    alignas(8) float below[2], above[2];
    std::uint32_t main_axis;  ///< index of the largest component of the direction
    bool valid;               ///< false: the ray cannot be traced; no other member is set
    bool regular;             ///< false: out of the range of float; every test must pass
    LocalParameter parameter;
};

/// Moves a ray that is far away, or whose direction has an unusual length, close to the scene.
[[nodiscard]] LocalRay local_ray_from_afar(const LocalFrame& frame, const Ray& ray);

/// Makes every box pass, except those of free slots, whose planes are infinite.
void pass_everything(SlabRay& slabs);

}  // namespace alhazen
