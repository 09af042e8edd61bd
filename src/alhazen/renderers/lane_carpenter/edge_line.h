#pragma once
/// Edges as lines on the grid, with an exact integer test of the side of a sample.
///
/// Source: Pineda, "A Parallel Algorithm for Polygon Rasterization", SIGGRAPH 1988 (edge
/// functions).
/// Conventions: a line runs from its upper end (less y, then less x) to its lower one, so that both
/// polygons at an edge have the same line and every sample is on one side of it. `right`: the side
/// of greater x; for a horizontal line the samples above and on it.

#include <cmath>

#include "alhazen/renderers/lane_carpenter/sample_grid.h"

namespace alhazen {

struct EdgeLine {
    std::int64_t x0 = 0, y0 = 0, dx = 0, dy = 0;  ///< dy >= 0
    double slope = 0;                             ///< dx / dy
    bool turned = false;  ///< the edge ran from the lower end to the upper one

    EdgeLine() = default;
    EdgeLine(const FixedPoint& from, const FixedPoint& to) {
        turned = to.y < from.y || (to.y == from.y && to.x < from.x);
        const FixedPoint& a = turned ? to : from;
        const FixedPoint& b = turned ? from : to;
        x0 = a.x;
        y0 = a.y;
        dx = std::int64_t{b.x} - a.x;
        dy = std::int64_t{b.y} - a.y;
        slope = dy > 0 ? static_cast<double>(dx) / static_cast<double>(dy) : 0.0;
    }

    /// Exact: coordinates are at most 2^30.
    [[nodiscard]] bool is_right(std::int32_t x, std::int32_t y) const {
        return (x - x0) * dy >= (y - y0) * dx;
    }
    /// The first column of the row whose sample is right of the line; `columns` if there is none.
    [[nodiscard]] int first_right(const SampleGrid& grid, std::int32_t y) const {
        const int columns = grid.columns();
        if (dy == 0) return (y - y0) * dx <= 0 ? 0 : columns;
        const double x = static_cast<double>(x0) + slope * static_cast<double>(y - y0);
        const double place = grid.column_of(x) + 1.0;
        int k = place > 0.0 ? (place < columns ? static_cast<int>(place) : columns) : 0;
        const double part = place - k;
        if (k < columns && part > grid.column_slack() && part < 1.0 - grid.column_slack()) return k;
        const std::int64_t far = (y - y0) * dx;
        const std::int32_t* const xs = grid.xs();
        while (k > 0 && (xs[k - 1] - x0) * dy >= far) --k;
        while (k < columns && (xs[k] - x0) * dy < far) ++k;
        return k;
    }
};

}  // namespace alhazen
