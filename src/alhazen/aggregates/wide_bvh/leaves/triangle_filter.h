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
/// reach of the ray (no vertex is farther from its origin in any coordinate);
/// docs/design/triangles.md has the proof:
/// - E, the error of a sheared coordinate (v_x - o_x) - S_x (v_z - o_z), is at most 13 e R + 4
///   delta (LocalRay::delta)
/// - an edge function of coordinates of magnitude at most L has an error of at most 5.1 E L + 2.1
///   E^2
/// - the position of the hit has an error of at most 25 err w / |sum|, with err that of an edge
///   function, sum the sum of the three and w the extent of the triangle along the ray, plus 14 e R
///   + 4 delta
/// - for a triangle whose sheared coordinates are at most L across and Z along, E is within 2.2 e R
///   + 7.3 e (L + Z) + 4 delta, and the second term of the position within 1.6 E; computed only for
///   blocks that pass the bound for all triangles
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
    float sure_min, sure_max;  ///< parameters between these are certainly in the ray's range
    float near_error;          ///< the part of E that all triangles share
};
static_assert(sizeof(TriangleFilterRay) == 64);

}  // namespace alhazen
