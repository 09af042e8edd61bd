#pragma once
/// Rays prepared for the triangle filter: a float test of a block of triangles that never rejects a
/// triangle that the exact test (in double, geometry/watertight_triangle.h) would hit, and that
/// marks most hits as sure. The exact test decides; it runs on the nearest triangle and on the few
/// that float cannot decide.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013 (shear
/// and edge functions); Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates", Discrete & Computational Geometry 18, 1997 (the idea of a filter).
/// Differs: the error bound is per ray and triangle, and the position along the ray is an interval.
/// In the local frame of the tree, where scene coordinates are at most 1, with e = 2^-24 and R the
/// reach of the ray (no vertex is farther from its origin in any coordinate):
/// - the error of a sheared coordinate (v_x - o_x) - S_x (v_z - o_z), |S_x| <= 1, is at most 13 e
///   R: rounding of v and o, two differences, S (from a direction and its reciprocal in float), the
///   product and the sum; plus 4 delta for the rounding of the exact test (LocalRay::delta), which
///   may shear along another axis of the same length. E is that sum.
/// - the error of an edge function a_x b_y - a_y b_x of coordinates with error E and magnitude at
///   most L is 4 E L + 2 E^2, plus 4 e L^2 <= E L for its own rounding: within 5.1 E L + 2.1 E^2.
/// - a weight of the hit is an edge function over their sum, so the position of the hit on the ray
///   moves by at most 24 err w / |sum| (the code uses 25, for rounding) within the extent w of the
///   triangle along the ray.
/// - the remaining error of the position, in parameters of the ray (R |S_z| is the reach): z has an
///   error of 2 e R and its scale 3 e; three products, two sums and a quotient of parts of one sign
///   round 9 e R: 14 e R, plus 4 delta for the exact test.
/// For a triangle whose sheared coordinates are at most L across and Z along, rounding of v and o
/// gives 2 e R, all the rest 2 e L + 7 e Z, so E is within 2.2 e R + 7.3 e (L + Z) + 4 delta, a
/// fraction of the above where the ray begins; 4 e L^2 <= E L still holds. The remaining error of
/// the position is e R + 13 e Z and 4 delta, within 1.6 E. This bound is computed only for blocks
/// that pass the bound for all triangles.
/// Unused lanes may lie farther away than R; users of a result check the lane's id.
/// The exact test must stay within the range of exponents: rays for which this is not certain have
/// an infinite slack (see `LocalRay::regular`), pass every triangle and are sure of none.
/// All bounds hold for fused and unfused multiplication, so hits are the same on every instruction
/// set.

#include "alhazen/accel/wide_bvh/trace/slab_ray.h"

namespace alhazen {

/// A prepared ray, one cache line.
struct alignas(64) TriangleFilterRay {
    float origin[3];           ///< along the axes below
    float edge_slack;          ///< 5.1 E
    float sx, sy, sz;          ///< as in RayShear, for local parameters
    float edge_slack_min;      ///< 2.1 E^2
    std::uint32_t kx, ky, kz;  ///< as in RayShear
    float s_slack;             ///< error of a local parameter, in addition to that of the weights
    float near_error;          ///< the part of E that all triangles share
    float sure_min, sure_max;  ///< parameters between these are certainly in the ray's range
};
static_assert(sizeof(TriangleFilterRay) == 64);

}  // namespace alhazen
