#pragma once
/// Nested grids: a cell with many primitives is divided by its own grid, if that lowers the cost.
///
/// Source: Jevans and Wyvill, "Adaptive Voxel Subdivision for Ray Tracing", Graphics Interface 1989
/// (grids in cells); Cazals, Drettakis and Puech, "Filtering, Clustering and Hierarchy
/// Construction", Eurographics 1995 (the reason: scenes of unequal density); Dippe and Swensen, "An
/// Adaptive Subdivision Algorithm and Parallel Architecture for Realistic Image Synthesis",
/// SIGGRAPH 1984 (`planes=balanced`: planes that balance the load).
/// Differs: few primitives stay a list. A cell also keeps its list if, by the areas of its cells, a
/// grid would not save tests, or if all nonempty cells would contain the same, overlapping
/// primitives. Dippe and Swensen move the corners of cells during rendering; here whole planes are
/// placed once, at equal shares of the primitives' centers along their axis. The clusters of Cazals
/// et al. are found by the recursion, without a search.
/// Conventions: cells are numbered x + nx (y + ny z) in their grid; traversal is that of Amanatides
/// and Woo (accel/cells/cell_grid.h), with planes looked up, not computed.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/accel/cells/mailbox.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/padded_box.h"
#include "alhazen/accel/core/reentrant_stack.h"

namespace alhazen {

class NestedGrid {
  public:
    static constexpr const char* kName = "nested_grid";
    static constexpr const char* kDescription = "nested grids: cells divided by grids of their own";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        double density = 3;     ///< cells per primitive of a grid
        int max_depth = 3;      ///< nesting depth
        int leaf_size = 8;      ///< lists of at most this size are not divided
        bool balanced = false;  ///< planes at equal shares of the primitives, not equally spaced
        bool mailbox = true;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    /// Throws Error(Resource) for more than 2^32 cells or entries.
    [[nodiscard]] static NestedGrid build(const BoundsSource& source, const Config& config);

    struct Grid {
        std::array<std::uint32_t, 3> first_plane{};  ///< in `planes()`, of cells + 1 along an axis
        std::array<std::uint32_t, 3> cells{};
        std::uint32_t first_cell = 0;
    };
    /// A list of primitives, or a grid.
    struct Cell {
        static constexpr std::uint32_t kIsGrid = 0xFFFFFFFFu;
        std::uint32_t index = 0;  ///< index of its first entry, or of the grid
        std::uint32_t count = 0;  ///< number of its entries, or kIsGrid
    };
    [[nodiscard]] const std::vector<Grid>& grids() const { return grids_; }
    [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }
    [[nodiscard]] const std::vector<double>& planes() const { return planes_; }
    [[nodiscard]] const std::vector<std::uint32_t>& entries() const { return entries_; }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const;

    [[nodiscard]] std::size_t memory_bytes() const {
        return grids_.capacity() * sizeof(Grid) + cells_.capacity() * sizeof(Cell) +
               planes_.capacity() * sizeof(double) + entries_.capacity() * sizeof(std::uint32_t);
    }

  private:
    friend class NestedGridBuilder;

    /// The position of a ray in a grid.
    struct Place {
        std::uint32_t grid;
        std::array<std::uint32_t, 3> cell;
        std::array<double, 3> next;  ///< t of the next plane of each axis
        double entry;
    };
    /// The traversal through one grid after another.
    struct Walk {
        const NestedGrid& made;
        const Ray& ray;
        Vec3 inverse;
        Place at;

        void enter(std::uint32_t grid, double t);
        [[nodiscard]] const Cell& cell() const;
        [[nodiscard]] double exit() const {
            return std::min(at.next[0], std::min(at.next[1], at.next[2]));
        }
        /// False if the step leaves the grid.
        [[nodiscard]] bool step();
        void set_next(std::size_t axis);
    };

    Config config_;
    PaddedBox space_;
    std::uint32_t primitives_ = 0;
    Cell root_;
    std::vector<Grid> grids_;
    std::vector<Cell> cells_;
    std::vector<double> planes_;
    std::vector<std::uint32_t> entries_;
};

inline void NestedGrid::Walk::enter(std::uint32_t grid, double t) {
    at.grid = grid;
    at.entry = t;
    const Grid& g = made.grids_[grid];
    const Vec3 p = ray.at(t);
    for (std::size_t k = 0; k < 3; ++k) {
        // The cell below the first inner plane above the point.
        const auto inner = made.planes_.begin() + g.first_plane[k] + 1;
        const auto above = std::upper_bound(inner, inner + g.cells[k] - 1, p[static_cast<int>(k)]);
        at.cell[k] = static_cast<std::uint32_t>(above - inner);
        set_next(k);
    }
}

inline const NestedGrid::Cell& NestedGrid::Walk::cell() const {
    const Grid& g = made.grids_[at.grid];
    return made
        .cells_[g.first_cell + at.cell[0] +
                std::size_t(g.cells[0]) * (at.cell[1] + std::size_t(g.cells[1]) * at.cell[2])];
}

inline void NestedGrid::Walk::set_next(std::size_t k) {
    const int axis = static_cast<int>(k);
    if (std::isinf(inverse[axis])) {
        at.next[k] = std::numeric_limits<double>::infinity();
        return;
    }
    const std::uint32_t plane =
        made.grids_[at.grid].first_plane[k] + at.cell[k] + (ray.direction[axis] > 0.0 ? 1u : 0u);
    at.next[k] = (made.planes_[plane] - ray.origin[axis]) * inverse[axis];
}

inline bool NestedGrid::Walk::step() {
    const auto& next = at.next;
    const std::size_t k =
        next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : (next[1] <= next[2] ? 1 : 2);
    at.entry = next[k];
    // Below zero it wraps around, which is outside of the grid as well.
    at.cell[k] += ray.direction[static_cast<int>(k)] > 0.0 ? 1u : 0xFFFFFFFFu;
    if (at.cell[k] >= made.grids_[at.grid].cells[k]) return false;
    set_next(k);
    return true;
}

template <class Visitor, class Stats>
void NestedGrid::traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
    if (root_.count != Cell::kIsGrid || !space_.covers(ray)) {
        return visit_all(primitives_, visitor);
    }
    const RaySpan span(space_.box, ray, visitor.t_max());
    if (span.empty()) return;
    Mailbox mailbox;
    ReentrantStack<Place> outer;
    Walk walk{*this, ray, span.inverse, {}};
    walk.enter(root_.index, span.begin);
    for (;;) {
        if (walk.at.entry > visitor.t_max()) return;
        const Cell& cell = walk.cell();
        stats.nodes(1);
        if (cell.count == Cell::kIsGrid) {
            outer.push(walk.at);
            walk.enter(cell.index, walk.at.entry);
            continue;
        }
        const std::span entries(entries_.data() + cell.index, cell.count);
        if (visit_entries(entries, config_.mailbox, mailbox, visitor, stats)) return;
        // A hit beyond the cell may lie behind another one in an earlier cell.
        if (visitor.t_max() < walk.exit()) return;
        while (!walk.step()) {
            if (outer.empty()) return;
            walk.at = outer.pop();
        }
    }
}
static_assert(Accelerator<NestedGrid>);

}  // namespace alhazen
