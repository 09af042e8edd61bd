#pragma once
/// Decides through which cell of a patch a line passes, by the borders of the cells. The rule
/// leaves no gap between cells, nor between patches that share a boundary curve.
///
/// The control points are projected onto a plane perpendicular to the line, with the line as the
/// origin. Every border between two cells has an integer, the signed number of its crossings of the
/// positive x axis. The sum around a cell is the winding number of its border, odd if the line
/// passes through the cell. The number of a border depends on its curve only, and the numbers of
/// its parts add up to that of the whole, whatever the rounding. Thus both cells at a border agree,
/// even if one of them is divided further, and the sum over all cells of a closed mesh is even.
/// them is divided further, and the sum over all cells of a closed mesh is even.
///
/// Source: Alexander's numbering of the regions of a plane curve (1928); the control polygon's
/// hull: Farin, "Curves and Surfaces for CAGD", 2002, chapter 4.
/// Conventions: docs/design/patches.md has the proof. Parameters of cells are multiples of
/// 2^-kMaxCellLevel.
/// Complexity: O(degree^2 * kMaxBorderLevel) for a border near the origin.

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

inline constexpr int kMaxCellLevel = 42;    ///< largest level of the borders of cells
inline constexpr int kMaxBorderLevel = 44;  ///< level of the polylines that approximate borders

/// A point of the plane. Uninitialised, since nets are created for every ray.
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

/// A line through patches: direction, and the two axes of its plane.
struct PatchLine {
    Vec3 origin;
    Vec3 direction;  ///< unit
    Vec3 axis_x, axis_y;
    double shift = 0;       ///< t of the ray at `origin`
    double per_length = 1;  ///< change of t per unit of length
    double tiny = 0;        ///< well above the rounding errors of a projected control point
};

[[nodiscard]] PlaneNet plane_net(BezierView net, const PatchLine& line);
/// Projects the patch to the plane of a line displaced by about `tiny`, so that nothing lies within
/// rounding of the line (for example an edge that is one point, or a straight edge along the line).
[[nodiscard]] PlaneNet border_net(BezierView net, const PatchLine& line);

/// A cell: a part of the unit square.
struct PatchCell {
    double u0, u1, v0, v1;
};

/// True if the winding number of the cell's border around the line is odd. `whole` is the
/// `border_net` of the patch.
[[nodiscard]] bool passes_through(const PlaneNet& whole, const PatchCell& cell, double tiny);

}  // namespace alhazen
