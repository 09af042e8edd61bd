#pragma once
/// Float filters for the tests of shapes: one ray against the eight spheres, cylinders or slanted
/// boxes of a leaf. A filter never rejects a shape that the test in double would hit.
///
/// Source: Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere
/// Intersection", Ray Tracing Gems, 2019, ch. 7 (distance of the center to the line); Kay and
/// Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs).
/// Differs: in float, with a proven error bound; the body encloses the shape.
/// The ray is that of triangle_filter.h: (O + z (S_x, S_y, 1)) along its axes, z at most R, where e
/// = 2^-24 and R is its reach; the error of S is 3 e, that of O e R. A hit of the test in double
/// lies at a point of the exact ray that is within 2 delta of the body. Vectors of coordinates up
/// to R have a length of at most 1.74 R.
/// - Slabs |w . (p - c)| <= h, |w| = 1: the error of w . (O - c) is 10.4 e R (O, the difference,
///   three products and sums with |w_x| + |w_y| + |w_z| <= 1.74), that of z w . S 12.2 e R. The
///   quotients' rounding, in units of the slab's width: 5.3 e R of the middle, 4 e h of the half, h
///   <= 2 R. Together 36.1 e R and 4 delta. A slope w . S below 2^-40 is replaced by 2^-40: less
///   than e R.
/// - Round bodies: the errors of the parts of O - c and S across the axis are 14 e R and 15 e. What
///   follows is exact for slightly other vectors of these. The error of the position of the nearest
///   point is 15.7 e R along the ray, that of the distance there 25 e R, that of the ends of the
///   chord 10 e R: with the radius widened by the sum of all these, 84 e R and 4 delta, the chord
///   contains the exact one. (With a, g and k the exact radius, and bounds of an error along and
///   across the ray: (a + g + k)^2 - (q + k)^2 >= (sqrt(a^2 - q^2) + g)^2 where q <= a.) Where the
///   slope across the axis is below 2^-30 the chord is lengthened, which preserves this. A sphere
///   has no axis, and a smaller error.
/// - Parameters are z times S_z, with an error of 3 e R |S_z|: less than
///   TriangleFilterRay::s_slack.
/// TriangleFilterRay::edge_slack is 5.12 (13.2 e R + 4 delta), so that 0.7 and 1.35 times it cover
/// slabs and round bodies. Where it is infinite everything passes.

namespace alhazen {

/// Slack of a slab's half width and of a radius, as factors of TriangleFilterRay::edge_slack.
inline constexpr float kSlabSlack = 0.7f, kRoundSlack = 1.35f;

}  // namespace alhazen
