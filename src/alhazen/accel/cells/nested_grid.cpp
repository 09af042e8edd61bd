#include "alhazen/accel/cells/nested_grid.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "alhazen/accel/cells/cell_limits.h"
#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"

namespace alhazen {
namespace {

/// The cost of a step to a cell, in units of a primitive test.
constexpr double kStepCost = 0.5;
/// Largest relative cost of a grid: it must save a quarter to be worth its memory.
constexpr double kSaving = 0.75;

constexpr std::size_t kCellsAroundHeap = 8;

/// The numbers of cells along each axis for about `count` cells, as cubical as possible; flat axes
/// have one.
std::array<std::uint32_t, 3> resolution(const Vec3& size, double count, double least_edge) {
    const double widest = max_component(size);
    int flat = 0;
    double volume = 1;
    for (int k = 0; k < 3; ++k) {
        if (size[k] <= 1e-6 * widest) {
            ++flat;
        } else {
            volume *= size[k] / widest;
        }
    }
    const double edge = std::max(
        least_edge, flat == 3 ? widest : widest * std::pow(volume / count, 1.0 / (3 - flat)));
    std::array<std::uint32_t, 3> cells{};
    for (int k = 0; k < 3; ++k) {
        cells[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(
            std::clamp(std::round(size[k] / edge), 1.0, double(kMostAlongAxis)));
    }
    return cells;
}

/// Half the surface area.
double area(const Vec3& s) {
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

}  // namespace

class NestedGridBuilder {
  public:
    NestedGridBuilder(const BoundsSource& source, NestedGrid& made)
        : source_(source), made_(made), config_(made.config_) {}

    void run() {
        std::vector<std::uint32_t> all(source_.size());
        std::iota(all.begin(), all.end(), 0u);
        made_.root_ = make_cell(all, made_.space_.box, 0);
    }

  private:
    using Cell = NestedGrid::Cell;

    /// A grid before it is stored: its planes, and the lists of its cells.
    struct Draft {
        std::array<std::vector<double>, 3> planes;
        std::array<std::uint32_t, 3> cells{};
        std::vector<std::uint32_t> starts, entries;

        [[nodiscard]] Box3 box(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
            return {{planes[0][x], planes[1][y], planes[2][z]},
                    {planes[0][x + 1], planes[1][y + 1], planes[2][z + 1]}};
        }
        template <class Body>
        void for_cells(const std::array<std::array<std::uint32_t, 3>, 2>& ends,
                       const Body& body) const {
            for (std::uint32_t z = ends[0][2]; z <= ends[1][2]; ++z) {
                for (std::uint32_t y = ends[0][1]; y <= ends[1][1]; ++y) {
                    for (std::uint32_t x = ends[0][0]; x <= ends[1][0]; ++x) {
                        body(x + std::size_t(cells[0]) * (y + std::size_t(cells[1]) * z),
                             box(x, y, z));
                    }
                }
            }
        }
        [[nodiscard]] std::array<std::array<std::uint32_t, 3>, 2> all() const {
            return {{{0, 0, 0}, {cells[0] - 1, cells[1] - 1, cells[2] - 1}}};
        }
    };

    Cell make_cell(const std::vector<std::uint32_t>& inside, const Box3& box, int depth) {
        interruption_point();
        const bool divides = depth < config_.max_depth &&
                             inside.size() > static_cast<std::size_t>(config_.leaf_size);
        // The outermost grid is always made: otherwise the structure would be a plain list.
        if (!divides || (depth > 0 && fill(inside, box))) return make_list(inside);
        const Draft draft = divide(inside, box);
        if (depth > 0 && !pays(draft, inside.size(), box)) return make_list(inside);
        return make_grid(draft, inside.size(), depth);
    }

    Cell make_list(const std::vector<std::uint32_t>& inside) {
        auto& entries = made_.entries_;
        check_room(entries.size() + inside.size());
        const Cell cell{static_cast<std::uint32_t>(entries.size()),
                        static_cast<std::uint32_t>(inside.size())};
        entries.insert(entries.end(), inside.begin(), inside.end());
        return cell;
    }

    Cell make_grid(const Draft& draft, std::size_t count, int depth) {
        const auto number = static_cast<std::uint32_t>(made_.grids_.size());
        const std::size_t cells = draft.starts.size() - 1;
        check_room(made_.cells_.size() + cells);
        NestedGrid::Grid& grid = made_.grids_.emplace_back();
        grid.cells = draft.cells;
        for (std::size_t k = 0; k < 3; ++k) {
            grid.first_plane[k] = static_cast<std::uint32_t>(made_.planes_.size());
            made_.planes_.insert(made_.planes_.end(), draft.planes[k].begin(),
                                 draft.planes[k].end());
        }
        const std::size_t first = made_.cells_.size();
        grid.first_cell = static_cast<std::uint32_t>(first);
        made_.cells_.resize(first + cells);
        // Cells of a heap would each be divided for nothing.
        const bool divides = !parts_nothing(draft, count);
        std::vector<std::uint32_t> inside;
        draft.for_cells(draft.all(), [&](std::size_t c, const Box3& box) {
            inside.assign(draft.entries.begin() + draft.starts[c],
                          draft.entries.begin() + draft.starts[c + 1]);
            // A temporary, since the recursion grows `cells_`.
            const Cell cell = divides ? make_cell(inside, box, depth + 1) : make_list(inside);
            made_.cells_[first + c] = cell;
        });
        return {number, Cell::kIsGrid};
    }

    [[nodiscard]] Draft divide(const std::vector<std::uint32_t>& inside, const Box3& box) const {
        Draft draft;
        const double count =
            std::min(kMostCells, config_.density * static_cast<double>(inside.size()));
        draft.cells = resolution(box.size(), count, 64 * made_.space_.pad);
        for (std::size_t k = 0; k < 3; ++k) {
            draft.planes[k] =
                config_.balanced ? balanced_planes(inside, box, static_cast<int>(k), draft.cells[k])
                                 : equal_planes(box, static_cast<int>(k), draft.cells[k]);
            draft.cells[k] = static_cast<std::uint32_t>(draft.planes[k].size() - 1);
        }
        std::vector<std::uint32_t> counts(
            std::size_t(draft.cells[0]) * draft.cells[1] * draft.cells[2] + 1, 0);
        std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
        for_overlaps(inside, draft, [&](std::size_t cell, std::uint32_t i) {
            ++counts[cell + 1];
            check_room(found.size());
            found.emplace_back(static_cast<std::uint32_t>(cell), i);
        });
        std::partial_sum(counts.begin(), counts.end(), counts.begin());
        draft.starts = counts;
        draft.entries.resize(found.size());
        for (const auto& [cell, i] : found) draft.entries[counts[cell]++] = i;
        return draft;
    }

    /// True if the primitives are so large relative to the box that a ray through it passes close
    /// to most of them anyway. Evaluated before a grid is made.
    [[nodiscard]] bool fill(const std::vector<std::uint32_t>& inside, const Box3& box) const {
        double met = 0;
        for (const std::uint32_t i : inside) {
            met += area(source_.clipped_box(i, made_.space_.widened(box)).size());
        }
        return !(met < kSaving * static_cast<double>(inside.size()) * area(box.size()));
    }

    static std::vector<double> equal_planes(const Box3& box, int axis, std::uint32_t cells) {
        std::vector<double> planes(cells + 1);
        const double size = (box.hi[axis] - box.lo[axis]) / cells;
        for (std::uint32_t i = 0; i < cells; ++i) planes[i] = box.lo[axis] + i * size;
        planes.back() = box.hi[axis];
        return planes;
    }

    /// Planes with equal numbers of primitives' centers between them, as far as the minimum
    /// thickness of cells permits.
    [[nodiscard]] std::vector<double> balanced_planes(const std::vector<std::uint32_t>& inside,
                                                      const Box3& box, int axis,
                                                      std::uint32_t cells) const {
        std::vector<double> centers;
        centers.reserve(inside.size());
        for (const std::uint32_t i : inside) {
            const Box3 b = source_.box(i);
            centers.push_back(0.5 * b.lo[axis] + 0.5 * b.hi[axis]);
        }
        std::sort(centers.begin(), centers.end());
        const double least = 64 * made_.space_.pad;
        std::vector<double> planes{box.lo[axis]};
        for (std::uint32_t i = 1; i < cells; ++i) {
            const double plane = centers[i * centers.size() / cells];
            if (plane - planes.back() >= least && box.hi[axis] - plane >= least) {
                planes.push_back(plane);
            }
        }
        planes.push_back(box.hi[axis]);
        return planes;
    }

    /// Calls body(cell, primitive) for every cell that may contain a point of a primitive.
    template <class Body>
    void for_overlaps(const std::vector<std::uint32_t>& inside, const Draft& draft,
                      const Body& body) const {
        for (const std::uint32_t i : inside) {
            const Box3 b = made_.space_.widened(source_.box(i));
            std::array<std::array<std::uint32_t, 3>, 2> ends{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& planes = draft.planes[k];
                const auto cell_of = [&](double x) {
                    return static_cast<std::uint32_t>(
                        std::upper_bound(planes.begin() + 1, planes.end() - 1, x) - planes.begin() -
                        1);
                };
                const int axis = static_cast<int>(k);
                ends[0][k] = cell_of(b.lo[axis]);
                ends[1][k] = cell_of(b.hi[axis]);
                // On a plane, the cell below contains it as well.
                if (ends[0][k] > 0 && planes[ends[0][k]] == b.lo[axis]) --ends[0][k];
            }
            const bool one = ends[0] == ends[1];
            draft.for_cells(ends, [&](std::size_t cell, const Box3& box) {
                if (one || source_.overlaps(i, made_.space_.widened(box))) body(cell, i);
            });
        }
    }

    /// True if each nonempty cell contains nearly all of the primitives, a heap: these overlap, and
    /// finer cells would only copy their list.
    static bool parts_nothing(const Draft& draft, std::size_t count) {
        if (count < kHeap) return false;
        std::size_t used = 0;
        for (std::size_t c = 0; c + 1 < draft.starts.size(); ++c) {
            used += draft.starts[c + 1] > draft.starts[c];
        }
        // If few cells are used, the primitives may be a small heap in a large box, which is worth
        // separating.
        if (used <= kCellsAroundHeap) return false;
        return static_cast<double>(draft.entries.size()) >=
               kSameCells * static_cast<double>(used) * static_cast<double>(count);
    }

    /// True if the expected cost of a ray that intersects the box is lower with the grid than with
    /// the list: the probability of intersecting a cell is the ratio of the areas.
    static bool pays(const Draft& draft, std::size_t count, const Box3& box) {
        if (parts_nothing(draft, count)) return false;
        double cost = 0;
        draft.for_cells(draft.all(), [&](std::size_t c, const Box3& cell) {
            const double tests = draft.starts[c + 1] - draft.starts[c];
            cost += (tests + kStepCost) * (area(cell.size()) / area(box.size()));
        });
        return cost < kSaving * static_cast<double>(count);
    }

    static void check_room(std::uint64_t size) {
        if (size >= 0xFFFFFFFFu) {
            throw Error(ErrorKind::Resource,
                        "nested_grid: more than 4294967294 cells or entries in their lists; lower "
                        "the density");
        }
    }

    const BoundsSource& source_;
    NestedGrid& made_;
    const NestedGrid::Config& config_;
};

NestedGrid::Config NestedGrid::configure(SettingsReader& reader) {
    Config config;
    config.density = reader.number("density", "cells per primitive of a grid", 3, 1e-3, 1000);
    config.max_depth = reader.count("max_depth", "nesting depth of grids", 3, 1, 8);
    config.leaf_size =
        reader.count("leaf_size", "at most this many primitives stay a list", 8, 1, 1000000);
    static constexpr const char* kPlanes[] = {"equal", "balanced"};
    config.balanced =
        reader.choice("planes", "equally spaced, or at equal shares of the primitives", 0,
                      kPlanes) == 1;
    config.mailbox = reader.flag("mailbox", "test a primitive in many cells once per ray", true);
    return config;
}

NestedGrid NestedGrid::build(const BoundsSource& source, const Config& config) {
    NestedGrid made;
    made.config_ = config;
    made.primitives_ = static_cast<std::uint32_t>(source.size());
    if (source.size() == 0) return made;
    made.space_ = PaddedBox(source);
    NestedGridBuilder(source, made).run();
    return made;
}

}  // namespace alhazen
