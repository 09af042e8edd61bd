#pragma once
/// Which cell of a patch a line passes through, decided by the borders of the cells: the rule that
/// leaves no gap between cells, and none between patches that share a boundary curve.
///
/// The line is the origin of a plane onto which the control points are projected. Every border
/// between two cells has a whole number: how often it crosses the positive x axis, counted by sign.
/// The sum around a cell is the winding number of its border, odd where the line passes through the
/// cell. The number of a border depends on its curve alone, and the numbers of its parts add up to
/// that of the whole, whatever the rounding. Thus both cells of a border agree, also where one of
/// them is divided further, and the sum over all cells of a closed mesh is even.
///
/// Source: Alexander's numbering of the regions of a plane curve (1928); the control polygon's
/// hull: Farin, "Curves and Surfaces for CAGD", 2002, chapter 4.
/// Conventions: docs/design/patches.md has the proof. Parameters of cells are multiples of
/// 2^-kMaxCellLevel.
/// Complexity: O(degree^2 * kMaxBorderLevel) for a border near the origin.

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

inline constexpr int kMaxCellLevel = 42;    ///< of the borders of cells
inline constexpr int kMaxBorderLevel = 44;  ///< of the polylines that stand for borders

/// A point of the plane. Not initialised, since nets are made for every ray.
struct PlanePoint {
    double x, y;
};
inline PlanePoint operator+(PlanePoint a, PlanePoint b) {
    return {a.x + b.x, a.y + b.y};
}
inline PlanePoint operator-(PlanePoint a, PlanePoint b) {
    return {a.x - b.x, a.y - b.y};
}
inline PlanePoint operator*(double s, PlanePoint a) {
    return {s * a.x, s * a.y};
}

/// A patch in the plane perpendicular to a line: (w x, w y) of its control points.
struct PlaneNet {
    int degree_u, degree_v;
    std::array<PlanePoint, kMaxPatchOrder * kMaxPatchOrder> at;

    [[nodiscard]] int count() const { return (degree_u + 1) * (degree_v + 1); }
};

/// A line through patches, by its direction and the two axes of its plane.
struct PatchLine {
    Vec3 origin;
    Vec3 direction;  ///< unit
    Vec3 axis_x, axis_y;
    double shift = 0;       ///< t of the ray at `origin`
    double per_length = 1;  ///< t of the ray for a unit of length
    double tiny = 0;        ///< far above the rounding errors of a projected control point
};

[[nodiscard]] PlaneNet plane_net(BezierView net, const PatchLine& line);
/// The same for a line that lies about `tiny` beside: what lies within rounding of the line itself
/// (an edge that is one point, a straight edge along the line) is then clearly beside it.
[[nodiscard]] PlaneNet border_net(BezierView net, const PatchLine& line);

/// A part of the unit square.
struct PatchCell {
    double u0, u1, v0, v1;
};

/// Whether the winding number of the cell's border around the line is odd. Takes the `border_net`
/// of the patch.
[[nodiscard]] bool passes_through(const PlaneNet& whole, const PatchCell& cell, double tiny);

}  // namespace alhazen
