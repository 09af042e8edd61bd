#pragma once
/// A ray made ready for the slab test on float boxes: the test never loses a box in which the
/// exact test, in double, of a primitive can find a hit. slab_ray-inl.h makes it.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013 (the problem).
/// Differs: a relative factor on the far distance is not enough for the form p * r + c; all slack
/// is absolute and folded into the constants c, once per ray.
/// For a hit at parameter s with |s| <= T, and e = 2^-24:
/// - plane parameter s_p = (p - o) / d; computed fl(fl(p r) + c), r = (1 / d) (1 + e1), |e1| <= e
/// - near plane, s_p <= s: computed <= s when c is lowered by 2.2 e T (rounding of r and of the
///   sum), e |r| (of the product, where multiply-add is not fused) and delta |r|; and by
///   2 e reach |r| for the rounding of c itself to float
/// - far plane: the mirror image
///
/// `delta` is a displacement in space that covers everything done in double: the local frame, the
/// shift of the origin, the rounding inside the exact tests (whose computed hit lies that near to
/// the ray). A direction component below 2^-60 is replaced by that: inside the scene this
/// displaces the ray by less than delta. An origin that is not near the scene is first moved
/// along the ray to the point nearest to the scene's center.
/// Conventions: parameters in the local frame, s = t * t_scale - t_shift, with the largest
/// direction component in [1, 2). A ray from farther than 2^40 scene sizes passes every box:
/// doubles say nothing at that distance.

#include <cstdint>

#include "alhazen/accel/wide_bvh/local_frame.h"

namespace alhazen {

/// Bound, relative to the distances in play, of how far from the ray a computed hit can be.
inline constexpr double kExactTestSlack = 0x1p-38;

/// A float not below `x`, by up to two steps more than needed, without a branch: which way a number
/// is rounded cannot be predicted.
inline float well_above(double x) {
    return static_cast<float>(x + (std::abs(x) * 0x1p-23 + 0x1p-100));
}

/// Rounding of a parameter on its way to the local frame.
inline constexpr double kLocalSlack = 0x1p-50;

/// N rays, the same number of each side by side: [axis][ray] or [ray].
template <std::size_t N>
struct alignas(64) SlabRays {
    /// In the local frame; the origin moved along the ray by t_shift, the direction scaled by a
    /// power of two.
    double origin[3][N], direction[3][N];
    double t_scale[N];  ///< 0: parameters do not fit, nothing is skipped because of them
    double t_shift[N];
    double delta[N];  ///< displacement that covers what is computed in double
    double reach[N];  ///< no coordinate of the scene is farther from the origin than this
    float reciprocal[3][N], near_offset[3][N], far_offset[3][N];
    float s_min[N], s_max[N];
    /// Distances in floats from WideNode::planes of the rows of the near and the far planes.
    std::uint32_t near_plane[3][N], far_plane[3][N];
    std::uint32_t octant[N];  ///< bit k is set when the ray goes down axis k

    /// The local parameter of t, rounded up: boxes that begin beyond it cannot hold a hit at t.
    [[nodiscard]] float local_max(std::size_t ray, double t) const {
        if (t_scale[ray] == 0) return std::numeric_limits<float>::infinity();
        const double s = t * t_scale[ray];
        const double shift = t_shift[ray];
        return well_above(s - shift + kLocalSlack * (std::abs(s) + std::abs(shift)));
    }
};

}  // namespace alhazen
