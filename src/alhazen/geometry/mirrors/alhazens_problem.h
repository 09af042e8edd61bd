#pragma once
/// Alhazen's problem: the points of a spherical mirror that reflect a lamp at A to an eye at B.
///
/// Source: Ibn al-Haytham, "Kitab al-Manazir" (Book of Optics), book V, 1011 to 1021; Huygens, in
/// Philosophical Transactions 8, 1673 (the points are those of the circle on an equilateral
/// hyperbola); docs/design/alhazens_problem.md has the derivation.
/// Differs: the quartic of the angle is cut into four arcs of the circle, each in Bernstein form
/// with a bound of its rounding, so that its real roots are found by certified changes of sign; the
/// one point of a convex mirror lies in a known arc and is found by a bracketed Newton iteration.
/// Conventions: any units and any place. An end on the mirror is no answer, nor is a point where
/// light only grazes. Two points closer than about 1e-8 of the radius, at a caustic, may be found
/// as none. What is not finite, and a radius that is not above 0, give none.
/// Threads: free functions.

#include <array>

#include "alhazen/math/vec.h"

namespace alhazen {

enum class MirrorFace : unsigned char {
    Outer,  ///< convex: at most one point
    Inner,  ///< concave: at most four; A and B may lie on any side of the sphere
};

struct MirrorPoints {
    int count = 0;
    std::array<Vec3, 4> points;
    /// [of points] A, B and the centre are on one line: this point stands for a circle around it.
    std::array<bool, 4> on_ring{};
    /// A and B are the centre: every point reflects.
    bool everywhere = false;
};

/// A lamp or an eye: at a point, or in the direction of it from the centre, infinitely far away.
struct MirrorEnd {
    Vec3 at;
    bool infinite = false;
};

/// All points of the sphere that reflect A to B, as if nothing else were there and the other face
/// let light through.
[[nodiscard]] MirrorPoints reflecting_points(const Vec3& center, double radius, MirrorFace face,
                                             const MirrorEnd& a, const MirrorEnd& b);

}  // namespace alhazen
