#pragma once
/// The directions from a point to boxes: a rectangle on each face of a cube around the point,
/// divided into cells.
///
/// Source: Haines and Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", IEEE CG&A 6(9),
/// 1986 (the cube).
/// Differs: divides only the rectangle of a face in which something is visible: from far away a
/// whole scene lies in a few cells of complete faces.
/// Conventions: faces and their slopes u, v are those of accel/directions/direction_cube.h; boxes
/// are relative to the point; cells are numbered by face, then by row of v.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "alhazen/accel/directions/direction_cube.h"
#include "alhazen/geometry/box.h"
#include "alhazen/math/constants.h"

namespace alhazen {

class DirectionWindows {
  public:
    static constexpr std::size_t kNone = ~std::size_t{0};
    /// Ranges of u and v on a face.
    using Slopes = std::array<Interval, 2>;

    /// The slopes of the points of a box on a face; empty if none are visible. A box around the
    /// point has all slopes.
    [[nodiscard]] static std::optional<Slopes> slopes_of(const Box3& box, int face) {
        const Interval along = range(box, face / 2, face % 2 != 0);
        if (!(along.hi > 0.0)) return std::nullopt;
        Slopes slopes;
        for (int side = 0; side < 2; ++side) {
            const Interval across = range(box, (face / 2 + 1 + side) % 3, false);
            const double near = std::max(along.lo, 0.0);
            const auto slope = [&](double a, double z) { return z > 0.0 ? a / z : kInfinity * a; };
            Interval& s = slopes[static_cast<std::size_t>(side)];
            s.lo = across.lo >= 0.0 ? across.lo / along.hi : slope(across.lo, near);
            s.hi = across.hi <= 0.0 ? across.hi / along.hi : slope(across.hi, near);
            s = intersection(Interval{s.lo - kSlack, s.hi + kSlack}, Interval{-1.0, 1.0});
            if (s.empty()) return std::nullopt;
        }
        return slopes;
    }

    /// Lower bound of the depth, along the axis of the face, of the part of a box in a range of
    /// slopes.
    [[nodiscard]] static double depth_of(const Box3& box, int face, const Slopes& slopes) {
        double depth = std::max(0.0, range(box, face / 2, face % 2 != 0).lo);
        for (int side = 0; side < 2; ++side) {
            const Interval across = range(box, (face / 2 + 1 + side) % 3, false);
            const Interval& s = slopes[static_cast<std::size_t>(side)];
            const double most = s.hi + kSlack, least = s.lo - kSlack;
            if (across.lo > 0.0 && most > 0.0) depth = std::max(depth, across.lo / most);
            if (across.hi < 0.0 && least < 0.0) depth = std::max(depth, across.hi / least);
        }
        return depth;
    }

    /// Extends the rectangles to those of a box.
    void include(const Box3& box) {
        for (int f = 0; f < 6; ++f) {
            const auto slopes = slopes_of(box, f);
            if (!slopes) continue;
            for (std::size_t side = 0; side < 2; ++side) {
                Interval& s = faces_[static_cast<std::size_t>(f)].slopes[side];
                s = hull(s, (*slopes)[side]);
            }
        }
    }
    /// Sum of the areas of the rectangles, in units of slopes.
    [[nodiscard]] double area() const {
        double sum = 0;
        for (const Face& f : faces_) sum += f.slopes[0].width() * f.slopes[1].width();
        return sum;
    }
    [[nodiscard]] double longest_edge() const {
        double longest = 0;
        for (const Face& f : faces_) {
            longest = std::max({longest, f.slopes[0].width(), f.slopes[1].width()});
        }
        return longest;
    }
    /// Divides the rectangles into cells with edges of about this slope, at most `most` in a row.
    void divide(double edge, int most) {
        std::size_t first = 0;
        for (Face& f : faces_) {
            f.first = first;
            if (f.slopes[0].empty()) continue;
            for (std::size_t side = 0; side < 2; ++side) {
                const double width = f.slopes[side].width();
                f.cells[side] =
                    static_cast<int>(std::clamp(std::ceil(width / edge), 1.0, double(most)));
                f.per_cell[side] = width / f.cells[side];
                f.per_slope[side] = width > 0.0 ? f.cells[side] / width : 0.0;
            }
            first += std::size_t(f.cells[0]) * std::size_t(f.cells[1]);
        }
        size_ = first;
    }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t number(int face, int column, int row) const {
        const Face& f = faces_[static_cast<std::size_t>(face)];
        return f.first + std::size_t(row) * std::size_t(f.cells[0]) + std::size_t(column);
    }
    /// The cell of a direction of any length except zero; kNone outside of the rectangles.
    [[nodiscard]] std::size_t cell_of(const Vec3& d) const {
        int axis = 0;
        for (int k = 1; k < 3; ++k) {
            if (std::abs(d[k]) > std::abs(d[axis])) axis = k;
        }
        const double x = std::abs(d[axis]);
        const int face = 2 * axis + (d[axis] > 0.0 ? 0 : 1);
        const Face& f = faces_[static_cast<std::size_t>(face)];
        const double u = d[(axis + 1) % 3] / x, v = d[(axis + 2) % 3] / x;
        if (!f.slopes[0].contains(u) || !f.slopes[1].contains(v)) return kNone;
        return number(face, f.index(0, u), f.index(1, v));
    }

    /// First and last column, first and last row.
    struct Cells {
        int face;
        std::array<std::array<int, 2>, 2> ends;
    };
    /// The cells that overlap the slopes; empty outside of the rectangles.
    [[nodiscard]] std::optional<Cells> cells_of(const Slopes& slopes, int face) const {
        const Face& f = faces_[static_cast<std::size_t>(face)];
        Cells cells{face, {}};
        for (std::size_t side = 0; side < 2; ++side) {
            const Interval within = {f.slopes[side].lo - kSlack, f.slopes[side].hi + kSlack};
            if (intersection(slopes[side], within).empty()) return std::nullopt;
            // A bound that rounding could move across belongs to both cells.
            const double slack = kSlack * f.per_slope[side];
            const double lo = (slopes[side].lo - f.slopes[side].lo) * f.per_slope[side] - slack;
            const double hi = (slopes[side].hi - f.slopes[side].lo) * f.per_slope[side] + slack;
            cells.ends[side] = {f.clamped(side, lo), f.clamped(side, hi)};
        }
        return cells;
    }
    /// The lower end of the i-th column (side 0) or row (side 1).
    [[nodiscard]] double bound(int face, std::size_t side, int i) const {
        const Face& f = faces_[static_cast<std::size_t>(face)];
        return i == f.cells[side] ? f.slopes[side].hi : f.slopes[side].lo + i * f.per_cell[side];
    }
    /// Slopes of a cell.
    [[nodiscard]] Slopes slopes_of_cell(int face, int column, int row) const {
        return {Interval{bound(face, 0, column), bound(face, 0, column + 1)},
                Interval{bound(face, 1, row), bound(face, 1, row + 1)}};
    }

  private:
    /// Margin of slopes, larger than their rounding errors.
    static constexpr double kSlack = 1e-12;

    struct Face {
        Slopes slopes;
        std::array<int, 2> cells{};
        std::array<double, 2> per_cell{}, per_slope{};
        std::size_t first = 0;

        [[nodiscard]] int clamped(std::size_t side, double place) const {
            const int last = cells[side] - 1;
            return place >= last ? last : place > 0.0 ? static_cast<int>(place) : 0;
        }
        [[nodiscard]] int index(std::size_t side, double slope) const {
            return clamped(side, (slope - slopes[side].lo) * per_slope[side]);
        }
    };

    [[nodiscard]] static Interval range(const Box3& box, int axis, bool mirrored) {
        return mirrored ? Interval{-box.hi[axis], -box.lo[axis]}
                        : Interval{box.lo[axis], box.hi[axis]};
    }

    std::array<Face, 6> faces_;
    std::size_t size_ = 0;
};

}  // namespace alhazen
