#pragma once
/// A ray made ready for the slab test on float boxes: the test never loses a box in which the
/// exact test, in double, of a primitive can find a hit. slab_ray-inl.h makes it.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013 (the problem).
/// Differs: a relative factor on the far distance is not enough for the form p * r + c; all slack
/// is absolute and folded into the constants c, once per ray.
/// In the local frame let R be the reach of the ray: 1, where the scene ends, and its origin's
/// largest coordinate; A = 1 / |d| along an axis and e = 2^-24. The parameter of a plane is
/// (p - o) / d; computed is fl(fl(p r) + c) with c = fl(-fl(o r) -+ slack), |r| <= A (1 + 2.01 e).
/// It is off by at most
/// - 2.01 e |p - o| A for r: the direction is rounded to float, and so is the quotient
/// - e |p| A for the product, where multiply-add is not fused
/// - 3 e |o| A for the origin, its product and the sum with the slack
/// - e |p - o| A for the last sum
/// together 6.01 e R A; 6.5 are taken. `delta` is a displacement in space on top of that, which
/// covers everything done in double: the local frame, the shift of the origin, the rounding inside
/// the exact tests (whose computed hit lies that near to the ray). A direction component below
/// 2^-100, which is 2^-60 of the largest or less, is replaced by that: inside the scene this
/// displaces the ray by 2^-60 R.
/// The range of a ray begins at s >= 0, so that boxes may be compared by the bits of numbers: one
/// with a negative t_min, or with an origin that is not near the scene, is first moved along itself
/// to the point nearest to the scene's center and back by twice the direction, so that the scene
/// lies in front of it.
/// Conventions: parameters in the local frame, s = t * scale - shift (`LocalParameter`). A ray from
/// farther than 2^40 scene sizes passes every box: doubles say nothing at that distance.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// Rounding of a parameter on its way to the local frame.
inline constexpr double kLocalSlack = 0x1p-50;

/// From the parameter t of a ray to the local one.
struct LocalParameter {
    double scale;  ///< 0: parameters do not fit, nothing is skipped because of them
    double shift;

    /// Rounded up: boxes that begin beyond it cannot hold a hit at t.
    [[nodiscard]] float above(double t) const {
        if (scale == 0) return std::numeric_limits<float>::infinity();
        const double s = t * scale;
        const double x = s - shift + kLocalSlack * (std::abs(s) + std::abs(shift));
        // Up to two steps more than needed, without a branch: which way a number is rounded cannot
        // be predicted.
        return static_cast<float>(x + (std::abs(x) * 0x1p-23 + 0x1p-100));
    }
    [[nodiscard]] float below(double t) const {
        const double s = t * scale;
        const double x = s - shift - kLocalSlack * (std::abs(s) + std::abs(shift));
        return static_cast<float>(x - (std::abs(x) * 0x1p-23 + 0x1p-100));
    }
};

/// Which planes of a box a ray meets first.
struct alignas(8) NearRows {
    /// Four times the number of the row of the near planes in WideNodeOf::planes, per axis: the
    /// distance in floats where four children lie side by side.
    std::uint16_t row[3];
    std::uint16_t octant;  ///< bit k is set when the ray goes down axis k

    /// As `row`, of the far planes.
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

/// What the slab test of a node reads, one cache line.
struct alignas(64) SlabRay {
    float reciprocal[4], near_offset[4], far_offset[4];  ///< [axis]; the fourth is not used
    float s_min, s_max;
    NearRows near;
};
static_assert(sizeof(SlabRay) == 64);

/// A ray in the local frame, and what the tests of leaves in float start from.
struct alignas(16) LocalRay {
    float origin[4], direction[4];  ///< moved along the ray by the shift; the fourth is 0
    float reach, delta;             ///< as in FrameSlack
    /// The two ends of the ray's range, rounded down and up.
    alignas(8) float below[2], above[2];
    std::uint32_t main_axis;  ///< of the largest component of the direction
    bool valid;               ///< false: the ray cannot be traced, nothing else is set
    bool regular;             ///< false: nothing is known, every test must pass
    LocalParameter parameter;
};

/// Moves a ray that is far off or not of a usual length near to the scene.
[[nodiscard]] LocalRay local_ray_from_afar(const LocalFrame& frame, const Ray& ray);

/// Every box is met; a free slot still is not: its planes are infinite.
void pass_everything(SlabRay& slabs);

}  // namespace alhazen
