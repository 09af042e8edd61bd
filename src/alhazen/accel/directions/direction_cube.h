#pragma once
/// All directions from a point, divided into cells: a cube around it whose faces are grids.
///
/// Source: Haines and Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", IEEE CG&A 6(9),
/// 1986.
/// Conventions: face 2 k looks along axis k, 2 k + 1 against it; with x along the face and y, z the
/// next two axes cyclically, a direction is (u, v) = (y / x, z / x) in [-1, 1]. Cells are numbered
/// by face, then by row of v.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "alhazen/math/vec.h"

namespace alhazen {

class DirectionCube {
  public:
    DirectionCube() = default;
    explicit DirectionCube(int resolution) : resolution_(resolution) {}

    [[nodiscard]] int resolution() const { return resolution_; }
    [[nodiscard]] std::size_t size() const {
        return 6 * std::size_t(resolution_) * std::size_t(resolution_);
    }
    [[nodiscard]] std::size_t number(int face, int column, int row) const {
        return (std::size_t(face) * std::size_t(resolution_) + std::size_t(row)) *
                   std::size_t(resolution_) +
               std::size_t(column);
    }
    /// The cell of a direction of any length except zero.
    [[nodiscard]] std::size_t cell_of(const Vec3& d) const {
        int axis = 0;
        for (int k = 1; k < 3; ++k) {
            if (std::abs(d[k]) > std::abs(d[axis])) axis = k;
        }
        const double x = std::abs(d[axis]);
        return number(2 * axis + (d[axis] > 0.0 ? 0 : 1), index(d[(axis + 1) % 3] / x),
                      index(d[(axis + 2) % 3] / x));
    }
    /// The lower end of the i-th cell of a row.
    [[nodiscard]] double bound(int i) const { return -1.0 + 2.0 * i / resolution_; }
    /// The direction (u, v) on a face; not unit.
    [[nodiscard]] static Vec3 direction(int face, double u, double v) {
        Vec3 d;
        d[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
        d[(face / 2 + 1) % 3] = u;
        d[(face / 2 + 2) % 3] = v;
        return d;
    }
    /// The four corners of a cell.
    [[nodiscard]] std::array<Vec3, 4> corners(int face, int column, int row) const {
        const double u0 = bound(column), u1 = bound(column + 1);
        const double v0 = bound(row), v1 = bound(row + 1);
        return {direction(face, u0, v0), direction(face, u1, v0), direction(face, u1, v1),
                direction(face, u0, v1)};
    }

  private:
    [[nodiscard]] int index(double slope) const {
        return std::clamp(static_cast<int>(0.5 * (slope + 1.0) * resolution_), 0, resolution_ - 1);
    }

    int resolution_ = 1;
};

}  // namespace alhazen
