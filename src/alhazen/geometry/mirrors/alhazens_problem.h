#pragma once
/// Alhazen's problem: the points of a spherical mirror that reflect a light at A to an eye at B.
///
/// Source: Ibn al-Haytham, "Kitab al-Manazir" (Book of Optics), book V, 1011 to 1021; Huygens, in
/// Philosophical Transactions 8, 1673 (the points are those of the circle on an equilateral
/// hyperbola); docs/design/alhazens_problem.md has the derivation.
/// Differs: the quartic of the angle is divided into four arcs of the circle, each in Bernstein
/// form with a bound on its rounding error, so that its real roots are found by certified sign
/// changes. The single point of a convex mirror lies in a known arc and is found by a bracketed
/// Newton iteration.
/// Conventions: any unit and any position. An end on the mirror gives no point, nor does grazing
/// incidence. Two points closer than about 1e-8 of the radius, at a caustic, may be found as none.
/// Non-finite input and a radius that is not positive give none.
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
    /// [i] true if A, B and the centre are collinear and point i represents a circle around their
    /// line.
    std::array<bool, 4> on_ring{};
    /// True if A and B are at the centre: every point reflects.
    bool everywhere = false;
};

/// A light or an eye: a point, or a direction from the centre towards an infinitely distant one.
struct MirrorEnd {
    Vec3 at;
    bool infinite = false;
};

/// All points of the sphere that reflect A to B, without regard to occlusion and to the other face,
/// which lets light through.
[[nodiscard]] MirrorPoints reflecting_points(const Vec3& center, double radius, MirrorFace face,
                                             const MirrorEnd& a, const MirrorEnd& b);

}  // namespace alhazen
