#pragma once
/// A grid of equal cells, each with a list of its primitives.
///
/// Source: Fujimoto, Tanaka and Iwata, "ARTS: Accelerated Ray-Tracing System", IEEE CG&A 6(4),
/// 1986; Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987;
/// Lagae and Dutre, "Compact, Fast and Robust Grids for Ray Tracing", EGSR 2008 (lists by
/// counting).
/// Differs: rays from so far away that rounding could make them miss a cell are tested against all
/// primitives.
/// Complexity: O(n + cells) to build and in memory.

#include <cstdint>
#include <vector>

#include "alhazen/accel/cells/cell_grid.h"
#include "alhazen/accel/cells/mailbox.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/traversal_trace.h"

namespace alhazen {

class UniformGrid {
  public:
    static constexpr const char* kName = "uniform_grid";
    static constexpr const char* kDescription = "equal cells, traversed along the ray";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        double density = 3;          ///< cells per primitive
        std::array<int, 3> cells{};  ///< number along each axis; 0: determined by the density
        bool by_boxes = false;       ///< store a primitive in all cells that its box overlaps
        bool mailbox = true;         ///< test a primitive in many cells once per ray
        bool hit_in_cell =
            true;  ///< end only at hits inside the cell; false demonstrates the errors
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    /// Throws Error(Resource) for more than 2^32 entries in the lists.
    [[nodiscard]] static UniformGrid build(const BoundsSource& source, const Config& config);

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        if (starts_.empty()) return;
        if (!grid_.covers(ray)) return visit_all(primitives_, visitor);
        const double t_max = visitor.t_max();
        Mailbox mailbox;
        for (CellWalk walk(grid_, ray, t_max); !walk.outside(); walk.step()) {
            if (walk.entry() > visitor.t_max()) return;
            const std::size_t cell = grid_.number(walk.cell());
            stats.nodes(1);
            note_cell(stats, cell);
            const std::span entries(entries_.data() + starts_[cell],
                                    starts_[cell + 1] - starts_[cell]);
            if (visit_entries(entries, config_.mailbox, mailbox, visitor, stats)) return;
            // A hit beyond the cell may lie behind another one in an earlier cell.
            const double known = config_.hit_in_cell ? walk.exit() : t_max;
            if (visitor.t_max() < known) return;
        }
    }

    [[nodiscard]] std::size_t memory_bytes() const {
        return (starts_.capacity() + entries_.capacity()) * sizeof(std::uint32_t);
    }
    [[nodiscard]] const CellGrid& cells() const { return grid_; }

  private:
    Config config_;
    CellGrid grid_;
    std::uint32_t primitives_ = 0;
    std::vector<std::uint32_t> starts_;   ///< [cell], and one more: its part of `entries_`
    std::vector<std::uint32_t> entries_;  ///< primitives, by cell
};
static_assert(Accelerator<UniformGrid>);

}  // namespace alhazen
