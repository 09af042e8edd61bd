#pragma once
/// All crossings of a line with a height field, for any number type.
///
/// Source: the definition in shapes/meshes/height_field.h.
/// Differs: no triangle is intersected. Above the line the terrain is a polyline with corners where
/// the line, seen from above, crosses rows, columns and diagonals.

#include "alhazen/verification/exact_polynomials.h"

namespace alhazen {

/// The terrain's height relative to the line at t.
template <class R>
class TerrainAbove {
  public:
    TerrainAbove(const HeightField& field, const LineOf<R>& line) : field_(field), line_(line) {}

    /// The t of all corners in [lo, hi], including both ends, ascending.
    [[nodiscard]] std::vector<R> corners(const R& lo, const R& hi) const {
        std::vector<R> t{lo, hi};
        const auto add = [&](const R& at) {
            if (at > lo && at < hi) t.push_back(at);
        };
        for (std::uint32_t i = 1; i + 1 < field_.columns && line_.direction.x != 0; ++i) {
            add((R(field_.vertex(i, 0).x) - line_.origin.x) / line_.direction.x);
        }
        for (std::uint32_t j = 1; j + 1 < field_.rows && line_.direction.y != 0; ++j) {
            add((R(field_.vertex(0, j).y) - line_.origin.y) / line_.direction.y);
        }
        std::sort(t.begin(), t.end());
        const std::size_t cells = t.size() - 1;
        for (std::size_t i = 0; i < cells; ++i) {
            const Cell cell((t[i] + t[i + 1]) / 2, *this);
            const R a = cell.beside_diagonal(t[i]), b = cell.beside_diagonal(t[i + 1]);
            if ((a < 0) != (b < 0)) t.push_back(t[i] + (t[i + 1] - t[i]) * (a / (a - b)));
        }
        std::sort(t.begin(), t.end());
        return t;
    }
    /// The height at t of the plane of the triangle under the line at `within`, relative to the
    /// line.
    [[nodiscard]] R at(const R& t, const R& within) const {
        return Cell(within, *this).height(t, within) - (line_.origin.z + t * line_.direction.z);
    }

  private:
    /// The cell under the line at some t.
    struct Cell {
        const TerrainAbove& of;
        std::uint32_t i, j;

        Cell(const R& t, const TerrainAbove& above) : of(above) {
            const HeightField& f = above.field_;
            i = index(above.x(t), f.columns, [&](std::uint32_t k) { return f.vertex(k, 0).x; });
            j = index(above.y(t), f.rows, [&](std::uint32_t k) { return f.vertex(0, k).y; });
        }
        /// The last cell that begins before `at`.
        template <class Place>
        static std::uint32_t index(const R& at, std::uint32_t count, Place&& place) {
            std::uint32_t lo = 0, hi = count - 1;
            while (hi - lo > 1) {
                const std::uint32_t middle = lo + (hi - lo) / 2;
                (R(place(middle)) < at ? lo : hi) = middle;
            }
            return lo;
        }
        /// Negative on the side of the corner with the highest column and the lowest row.
        [[nodiscard]] R beside_diagonal(const R& t) const {
            const Vec3 a = of.field_.vertex(i, j), c = of.field_.vertex(i + 1, j + 1);
            return (R(c.x) - R(a.x)) * (of.y(t) - R(a.y)) - (R(c.y) - R(a.y)) * (of.x(t) - R(a.x));
        }
        [[nodiscard]] R height(const R& t, const R& within) const {
            const HeightField& f = of.field_;
            const Vec3 a = f.vertex(i, j), c = f.vertex(i + 1, j + 1);
            const bool low = beside_diagonal(within) < 0;
            const R u = (of.x(t) - R(a.x)) / (R(c.x) - R(a.x));
            const R v = (of.y(t) - R(a.y)) / (R(c.y) - R(a.y));
            const R along_x =
                low ? R(f.vertex(i + 1, j).z) - R(a.z) : R(c.z) - R(f.vertex(i, j + 1).z);
            const R along_y =
                low ? R(c.z) - R(f.vertex(i + 1, j).z) : R(f.vertex(i, j + 1).z) - R(a.z);
            return R(a.z) + u * along_x + v * along_y;
        }
    };
    [[nodiscard]] R x(const R& t) const { return line_.origin.x + t * line_.direction.x; }
    [[nodiscard]] R y(const R& t) const { return line_.origin.y + t * line_.direction.y; }

    const HeightField& field_;
    const LineOf<R>& line_;
};

template <class R>
CrossingsOf<R> exact_crossings(const HeightField& field, const LineOf<R>& line) {
    ClippedPart<R> part;
    part.cut(line.origin.x, line.direction.x, field.lo.x, field.hi.x);
    part.cut(line.origin.y, line.direction.y, field.lo.y, field.hi.y);
    // The solid lies below all of these heights.
    part.cut(line.origin.z, line.direction.z, field.base,
             field.bounds.hi.z + (field.bounds.hi.z - field.base));
    if (part.empty()) return {};
    const TerrainAbove<R> terrain(field, line);
    const std::vector<R> t = terrain.corners(part.lo, part.hi);
    CrossingsOf<R> found;
    bool inside = false;
    const auto cross = [&](const R& at) {
        found.t.push_back(at);
        inside = !inside;
    };
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
        const R within = (t[i] + t[i + 1]) / 2;
        const R a = terrain.at(t[i], within), b = terrain.at(t[i + 1], within);
        if ((a > 0) != inside) cross(t[i]);
        if ((b > 0) != inside) cross(t[i] + (t[i + 1] - t[i]) * (a / (a - b)));
    }
    if (inside) cross(part.hi);
    return found;
}

}  // namespace alhazen
