#pragma once
/// Outlines of lines and cubic Bézier curves in the plane, for prisms and lathes.
///
/// Source: Farin, "Curves and Surfaces for CAGD", 5th ed., 2002 (Bézier curves, their convex hull
/// and de Casteljau's algorithm).
/// Conventions: a loop is a chain of curves, each beginning at the end of the one before, bit for
/// bit; inside is odd-even over all loops.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

class FieldChecks;

struct ProfileCurve {
    std::array<Vec2, 4> p{};  ///< control points; a line has only the first and the last
    bool line = true;

    [[nodiscard]] int degree() const { return line ? 1 : 3; }
    /// Control point i of the curve's degree.
    [[nodiscard]] const Vec2& control(int i) const { return p[line ? 3 * i : i]; }
    /// The point at s in [0, 1]; exact at the ends.
    [[nodiscard]] Vec2 point(double s) const;
    /// Derivative of the point by s.
    [[nodiscard]] Vec2 derivative(double s) const;
    /// The derivative, or at a cusp (zero derivative) the direction along the curve; zero only for
    /// a curve that is a point.
    [[nodiscard]] Vec2 direction(double s) const;
};

[[nodiscard]] ProfileCurve line_curve(Vec2 from, Vec2 to);
[[nodiscard]] ProfileCurve cubic_curve(Vec2 from, Vec2 control1, Vec2 control2, Vec2 to);

struct Profile {
    std::vector<ProfileCurve> curves;      ///< all loops, consecutive
    std::vector<std::uint32_t> loop_ends;  ///< [loop] one past its last curve

    /// True if every loop ends where it begins.
    [[nodiscard]] bool loops_close() const;
    /// Bounds of all control points: lo and hi.
    [[nodiscard]] std::array<Vec2, 2> bounds() const;
    /// Largest coordinate of a control point.
    [[nodiscard]] double reach() const;
    /// Reports invalid numbers and chains with gaps.
    void validate(FieldChecks& checks) const;
};

}  // namespace alhazen
