#pragma once
/// Rays made ready for the triangle filter: a test of a block of triangles in float that never
/// loses a triangle which the test in double (geometry/watertight_triangle.h) would hit, and that
/// knows of most hits that they are sure. The test in double decides; it runs on the winner, and
/// on the few triangles of which float cannot tell.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013 (shear
/// and edge functions); Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates", Discrete & Computational Geometry 18, 1997 (the idea of a filter).
/// Differs: the bound of the error is per ray and triangle, and the position along the ray is an
/// interval.
/// All in the local frame of the tree, where scene coordinates are at most 1. With e = 2^-24 and R
/// the reach of the ray (no vertex is farther from its origin in any coordinate):
/// - a sheared coordinate (v_x - o_x) - S_x (v_z - o_z), |S_x| <= 1, is off by at most 13 e R:
///   rounding of v and o, two differences, S (from a direction and its reciprocal in float), the
///   product and the sum; and by 4 delta for what the test in double rounds (LocalRay::delta),
///   which may shear along another axis of the same length. E is that sum.
/// - an edge function a_x b_y - a_y b_x of coordinates that are off by E and at most L in magnitude
///   is off by 4 E L + 2 E^2, and by 4 e L^2 <= E L of its own rounding: within 5.1 E L + 2.1 E^2.
/// - a weight of the hit is an edge function over their sum, so the place of the hit on the ray
///   moves by at most 24 err w / |sum| (25 are taken, for the rounding of that) within the extent w
///   of the triangle along the ray.
/// - the rest of the place's error, in parameters of the ray (R |S_z| is the reach): z is off by
///   2 e R and its scale by 3 e; three products, two sums and a quotient of parts of one sign round
///   9 e R: 14 e R, and 4 delta for the test in double.
/// The same for a triangle whose sheared coordinates are at most L across and Z along: rounding of
/// v and o gives 2 e R, all the rest 2 e L + 7 e Z, so E is within 2.2 e R + 7.3 e (L + Z) +
/// 4 delta, a fraction of the above where the ray begins; 4 e L^2 <= E L still holds. The rest of
/// the place's error is e R + 13 e Z and 4 delta, within 1.6 E. It is computed only for blocks that
/// the bound for all triangles lets pass.
/// Free lanes may lie farther off than R; who reads a result looks at the lane's id.
/// The test in double must not leave the range of exponents: rays of which that is not sure have an
/// infinite slack (see `LocalRay::regular`), pass every triangle and are sure of none.
/// All of it holds for fused and unfused multiplication alike, so the decision, not its cost, is
/// the same on every instruction set.

#include "alhazen/accel/wide_bvh/trace/slab_ray.h"

namespace alhazen {

/// A ray made ready, one cache line.
struct alignas(64) TriangleFilterRay {
    float origin[3];           ///< along the axes below
    float edge_slack;          ///< 5.1 E
    float sx, sy, sz;          ///< as in RayShear, for local parameters
    float edge_slack_min;      ///< 2.1 E^2
    std::uint32_t kx, ky, kz;  ///< as in RayShear
    float s_slack;             ///< error of a local parameter beside that of the weights
    float near_error;          ///< the part of E that is the same for all triangles
    float sure_min, sure_max;  ///< within these it is in the ray's range for sure
};
static_assert(sizeof(TriangleFilterRay) == 64);

}  // namespace alhazen
