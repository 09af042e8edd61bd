#pragma once
/// The cells of a regular grid over a box, and their traversal by a ray.
///
/// Source: Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics
/// 1987.
/// Differs: computes the t of the next plane from the plane's number instead of adding increments,
/// so that long traversals do not drift. Primitives are stored in all cells within `pad` of them;
/// the error of the traversal is far smaller for rays accepted by `covers`.
/// Conventions: cells are numbered x + nx (y + ny z).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "alhazen/accel/core/padded_box.h"

namespace alhazen {

struct CellGrid : PaddedBox {
    std::array<int, 3> cells{1, 1, 1};
    Vec3 cell_size, per_cell_size;

    CellGrid() = default;
    /// A grid of about `count` cells, as cubical as possible, at most `most` along an axis.
    CellGrid(const Box3& around, double count, int most);
    /// A grid with the given number of cells along each axis.
    CellGrid(const Box3& around, const std::array<int, 3>& along);

    [[nodiscard]] std::size_t size() const {
        return std::size_t(cells[0]) * std::size_t(cells[1]) * std::size_t(cells[2]);
    }
    [[nodiscard]] std::size_t number(const std::array<int, 3>& cell) const {
        return std::size_t(cell[0]) +
               std::size_t(cells[0]) *
                   (std::size_t(cell[1]) + std::size_t(cells[1]) * std::size_t(cell[2]));
    }
    [[nodiscard]] double plane(int axis, int i) const {
        return i == cells[static_cast<std::size_t>(axis)] ? box.hi[axis]
                                                          : box.lo[axis] + i * cell_size[axis];
    }
    [[nodiscard]] int index(int axis, double x) const {
        const double place = (x - box.lo[axis]) * per_cell_size[axis];
        const int last = cells[static_cast<std::size_t>(axis)] - 1;
        return place >= last ? last : place > 0.0 ? static_cast<int>(place) : 0;
    }
    [[nodiscard]] Box3 cell_box(const std::array<int, 3>& cell) const;
    /// The first and the last cell within `pad` of a box.
    [[nodiscard]] std::array<std::array<int, 3>, 2> range(const Box3& b) const;

  private:
    void divide(const std::array<int, 3>& along);
};

/// The cells that a ray traverses, in order.
class CellWalk {
  public:
    /// `outside` if the ray misses the grid up to t_max.
    CellWalk(const CellGrid& grid, const Ray& ray, double t_max) : grid_(grid), ray_(ray) {
        const RaySpan span(grid.box, ray, t_max);
        if (span.empty()) return;
        inverse_ = span.inverse;
        outside_ = false;
        entry_ = span.begin;
        const Vec3 p = ray.at(entry_);
        for (int k = 0; k < 3; ++k) {
            cell_[static_cast<std::size_t>(k)] = grid.index(k, p[k]);
            set_next(k);
        }
    }

    [[nodiscard]] bool outside() const { return outside_; }
    [[nodiscard]] const std::array<int, 3>& cell() const { return cell_; }
    /// The t at which the ray enters the cell, and the t at which it leaves it.
    [[nodiscard]] double entry() const { return entry_; }
    [[nodiscard]] double exit() const { return std::min(next_[0], std::min(next_[1], next_[2])); }

    void step() {
        const int axis =
            next_[0] <= next_[1] ? (next_[0] <= next_[2] ? 0 : 2) : (next_[1] <= next_[2] ? 1 : 2);
        const auto k = static_cast<std::size_t>(axis);
        entry_ = next_[k];
        cell_[k] += ray_.direction[axis] > 0.0 ? 1 : -1;
        outside_ = cell_[k] < 0 || cell_[k] >= grid_.cells[k];
        if (!outside_) set_next(axis);
    }

  private:
    void set_next(int axis) {
        const auto k = static_cast<std::size_t>(axis);
        if (std::isinf(inverse_[axis])) {
            next_[k] = std::numeric_limits<double>::infinity();
            return;
        }
        const int plane = cell_[k] + (ray_.direction[axis] > 0.0 ? 1 : 0);
        next_[k] = (grid_.plane(axis, plane) - ray_.origin[axis]) * inverse_[axis];
    }

    const CellGrid& grid_;
    const Ray& ray_;
    Vec3 inverse_;
    std::array<int, 3> cell_{};
    std::array<double, 3> next_{};
    double entry_ = 0;
    bool outside_ = true;
};

}  // namespace alhazen
