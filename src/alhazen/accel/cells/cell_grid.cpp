#include "alhazen/accel/cells/cell_grid.h"

namespace alhazen {

void CellGrid::divide(const std::array<int, 3>& along) {
    cells = along;
    for (int k = 0; k < 3; ++k) {
        const double n = along[static_cast<std::size_t>(k)];
        cell_size[k] = box.size()[k] / n;
        per_cell_size[k] = n / box.size()[k];
    }
}

CellGrid::CellGrid(const Box3& around, const std::array<int, 3>& along) : PaddedBox(around) {
    divide(along);
}

CellGrid::CellGrid(const Box3& around, double count, int most) : PaddedBox(around) {
    const Vec3 size = box.size();
    // Edge length of a cube with the volume available to each cell; flat axes have one cell.
    int flat = 0;
    double volume = 1;
    for (int k = 0; k < 3; ++k) {
        if (size[k] <= 1e-6 * max_component(size)) {
            ++flat;
        } else {
            volume *= size[k] / max_component(size);
        }
    }
    const double edge =
        flat == 3 ? 1.0 : max_component(size) * std::pow(volume / count, 1.0 / (3 - flat));
    std::array<int, 3> along{};
    for (int k = 0; k < 3; ++k) {
        along[static_cast<std::size_t>(k)] =
            static_cast<int>(std::clamp(std::round(size[k] / edge), 1.0, double(most)));
    }
    divide(along);
}

Box3 CellGrid::cell_box(const std::array<int, 3>& cell) const {
    Box3 b;
    for (int k = 0; k < 3; ++k) {
        b.lo[k] = plane(k, cell[static_cast<std::size_t>(k)]);
        b.hi[k] = plane(k, cell[static_cast<std::size_t>(k)] + 1);
    }
    return b;
}

std::array<std::array<int, 3>, 2> CellGrid::range(const Box3& b) const {
    std::array<std::array<int, 3>, 2> ends{};
    for (int k = 0; k < 3; ++k) {
        ends[0][static_cast<std::size_t>(k)] = index(k, b.lo[k] - pad);
        ends[1][static_cast<std::size_t>(k)] = index(k, b.hi[k] + pad);
    }
    return ends;
}

}  // namespace alhazen
