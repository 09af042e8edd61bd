#pragma once
/// The filters in front of the tests of shapes: eight spheres, cylinders or slanted boxes of a leaf
/// in float against one ray, never losing a shape that the test in double would hit.
///
/// Source: Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere
/// Intersection", Ray Tracing Gems, 2019, ch. 7 (distance of the center to the line); Kay and
/// Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs).
/// Differs: in float, with a proven bound of what that is off; the body is only around the shape.
/// The ray is that of triangle_filter.h: (O + z (S_x, S_y, 1)) along its axes, z at most R, where e
/// = 2^-24 and R is its reach; S is off by 3 e and O by e R each. A hit of the test in double lies
/// at a point of the exact ray that is within 2 delta of the body. Vectors of coordinates up to R
/// have a length of at most 1.74 R.
/// - Slabs |w . (p - c)| <= h, |w| = 1: w . (O - c) is off by 10.4 e R (O, the difference, three
///   products and sums with |w_x| + |w_y| + |w_z| <= 1.74), z w . S by 12.2 e R. The quotients'
///   rounding, in units of the slab's width: 5.3 e R of the middle, 4 e h of the half, h <= 2 R.
///   Together 36.1 e R and 4 delta. A slope w . S below 2^-40 is taken for that: less than e R.
/// - Round bodies: the parts of O - c and S across the axis are off by 14 e R and 15 e. What
///   follows is exact for slightly other vectors of these. The place of the nearest point is off by
///   15.7 e R along the ray, the distance there by 25 e R, the ends of the chord by 10 e R: with
///   the radius widened by the sum of all that, 84 e R and 4 delta, the chord holds the exact one.
///   (With a, g and k the exact radius, and bounds of an error along and across the ray: (a + g +
///   k)^2 - (q + k)^2 >= (sqrt(a^2 - q^2) + g)^2 where q <= a.) Where the slope across the axis is
///   below 2^-30 the chord is made longer, which holds for that as well. A sphere has no axis, and
///   less error.
/// - Parameters are z times S_z, off by 3 e R |S_z|: less than TriangleFilterRay::s_slack.
/// TriangleFilterRay::edge_slack is 5.12 (13.2 e R + 4 delta), so that 0.7 and 1.35 of it cover
/// slabs and round bodies. Where it is infinite everything passes.

namespace alhazen {

/// Slack of a slab's half width and of a radius, over that of an edge function.
inline constexpr float kSlabSlack = 0.7f, kRoundSlack = 1.35f;

}  // namespace alhazen
