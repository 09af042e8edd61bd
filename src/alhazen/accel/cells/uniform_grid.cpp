#include "alhazen/accel/cells/uniform_grid.h"

#include <algorithm>

#include "alhazen/accel/cells/cell_limits.h"
#include "alhazen/base/error.h"

namespace alhazen {
namespace {

/// Throws Error (Usage) for too many cells. 0: determined by the density.
void check_cell_count(const std::array<int, 3>& cells) {
    double count = 1;
    for (const int n : cells) count *= std::max(n, 1);
    if (count <= kMostCells) return;
    throw Error(ErrorKind::Usage, "uniform_grid: nx, ny and nz make more than 134217728 cells");
}

/// Calls add(cell number) for all cells that may contain a point of the primitive, or of its box.
template <class Add>
void for_cells(const CellGrid& grid, const BoundsSource& source, std::size_t i, bool by_box,
               const Add& add) {
    const auto [first, last] = grid.range(source.box(i));
    const Vec3 pad{grid.pad, grid.pad, grid.pad};
    const bool all = by_box || first == last;
    for (int z = first[2]; z <= last[2]; ++z) {
        for (int y = first[1]; y <= last[1]; ++y) {
            for (int x = first[0]; x <= last[0]; ++x) {
                const Box3 cell = grid.cell_box({x, y, z});
                if (!all && !source.overlaps(i, {cell.lo - pad, cell.hi + pad})) continue;
                add(grid.number({x, y, z}));
            }
        }
    }
}

}  // namespace

UniformGrid::Config UniformGrid::configure(SettingsReader& reader) {
    Config config;
    config.density = reader.number("density", "cells per primitive", 3, 1e-6, 1000);
    static constexpr const char* kAlong[] = {"nx", "ny", "nz"};
    for (std::size_t k = 0; k < 3; ++k) {
        config.cells[k] = reader.count(kAlong[k], "cells along the axis, 0: by the density", 0, 0,
                                       kMostAlongAxis);
    }
    if (std::ranges::all_of(config.cells, [](int n) { return n > 0; })) {
        reader.exclude("density", "nx, ny and nz");
    }
    check_cell_count(config.cells);
    static constexpr const char* kLists[] = {"exact", "boxes"};
    config.by_boxes = reader.choice("lists", "what must overlap a cell: the primitive, or its box",
                                    0, kLists) == 1;
    config.mailbox = reader.flag("mailbox", "test a primitive in many cells once per ray", true);
    config.hit_in_cell =
        reader.flag("hit_in_cell", "off: a hit beyond its cell counts (wrong pictures)", true);
    return config;
}

UniformGrid UniformGrid::build(const BoundsSource& source, const Config& config) {
    UniformGrid made;
    made.config_ = config;
    if (source.size() == 0) return made;
    Box3 all;
    for (std::size_t i = 0; i < source.size(); ++i) all.include(source.box(i));
    made.primitives_ = static_cast<std::uint32_t>(source.size());
    made.grid_ =
        CellGrid(all, std::min(kMostCells, config.density * static_cast<double>(source.size())),
                 kMostAlongAxis);
    std::array<int, 3> along = made.grid_.cells;
    for (std::size_t k = 0; k < 3; ++k) {
        if (config.cells[k] > 0) along[k] = config.cells[k];
    }
    check_cell_count(along);
    if (along != made.grid_.cells) made.grid_ = CellGrid(all, along);

    std::vector<std::uint32_t> counts(made.grid_.size() + 1, 0);
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < source.size(); ++i) {
        for_cells(made.grid_, source, i, config.by_boxes, [&](std::size_t cell) {
            ++counts[cell + 1];
            ++total;
        });
        if (total > 0xFFFFFFFFu) {
            throw Error(ErrorKind::Resource,
                        "uniform_grid: more than 4294967295 entries in the lists of its cells; "
                        "lower the density");
        }
    }
    for (std::size_t c = 1; c < counts.size(); ++c) counts[c] += counts[c - 1];
    made.starts_ = counts;
    made.entries_.resize(total);
    for (std::size_t i = 0; i < source.size(); ++i) {
        for_cells(made.grid_, source, i, config.by_boxes, [&](std::size_t cell) {
            made.entries_[counts[cell]++] = static_cast<std::uint32_t>(i);
        });
    }
    return made;
}

}  // namespace alhazen
