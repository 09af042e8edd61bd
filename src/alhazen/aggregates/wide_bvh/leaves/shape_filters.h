#pragma once
/// Float filters for the tests of shapes: one ray against the eight spheres, cylinders or slanted
/// boxes of a leaf. A filter never rejects a shape that the test in double would hit, and it tells
/// which spheres, cylinders and flat shapes that test certainly hits: sure hits.
///
/// Source: Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere
/// Intersection", Ray Tracing Gems, 2019, ch. 7 (distance of the center to the line); Kay and
/// Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs).
/// Differs: in float, with a proven error bound; the body encloses the shape.
/// The ray is that of triangle_filter.h: (O + z (S_x, S_y, 1)) along its axes, z at most its reach
/// R, e = 2^-24. docs/design/boxes.md has the proof of these bounds:
/// - slabs |w . (p - c)| <= h, |w| = 1: h is widened by 36.1 e R + 4 delta; a slope w . S below
///   2^-40 is replaced by 2^-40
/// - round bodies: the radius is widened by 84 e R + 4 delta; a slope across the axis below 2^-30
/// is
///   replaced by 2^-30
/// - sure hits: of bodies narrowed by twice the slack, which covers the line and the widening of
/// the
///   body in its block; FilteredShapes::hi is a parameter not before the first hit
/// - parameters z times S_z: an error of 3 e R |S_z|, less than TriangleFilterRay::s_slack
/// TriangleFilterRay::edge_slack is 5.12 (13.2 e R + 4 delta), so that 0.7 and 1.35 times it cover
/// slabs and round bodies. Where it is infinite everything passes.

namespace alhazen {

/// Slack of a slab's half width and of a radius, as factors of TriangleFilterRay::edge_slack.
inline constexpr float kSlabSlack = 0.7f, kRoundSlack = 1.35f;

}  // namespace alhazen
