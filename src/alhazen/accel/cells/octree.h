#pragma once
/// An octree: cells are divided at their middles until they hold few primitives; four traversal
/// algorithms.
///
/// Source: Glassner, "Space Subdivision for Fast Ray Tracing", IEEE CG&A 4(10), 1984; the
/// traversals in octree_walks.h.
/// Differs: rays from so far away that rounding could make them miss a cell are tested against all
/// primitives.
/// Complexity: O(n d) to build for depth d, for small primitives.

#include "alhazen/accel/cells/mailbox.h"
#include "alhazen/accel/cells/octree_walks.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/traversal_trace.h"

namespace alhazen {

class Octree {
  public:
    static constexpr const char* kName = "octree";
    static constexpr const char* kDescription = "cells halved along each axis; four traversals";
    static constexpr bool kVisitsRepeatedly = true;

    enum class Walk : std::uint8_t { PointLocation, NeighborFinding, Smart, Parametric };
    struct Config {
        Walk walk = Walk::Parametric;
        int max_depth = 0;  ///< 0: three levels more than a full tree over the primitives
        int leaf_size = 1;  ///< largest number of primitives in an undivided cell
        bool mailbox = true;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    [[nodiscard]] static Octree build(const BoundsSource& source, const Config& config);

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        if (cells_.empty()) return;
        if (!cells_.covers(ray)) return visit_all(primitives_, visitor);
        const OctreeRay inside(cells_, ray, visitor.t_max());
        if (inside.misses()) return;
        Mailbox mailbox;
        const auto test_leaf = [&](std::uint32_t leaf, double exit) {
            return test(leaf, exit, mailbox, visitor, stats);
        };
        switch (config_.walk) {
            case Walk::PointLocation:
                return walk_by_point_location(cells_, inside, stats, test_leaf);
            case Walk::NeighborFinding:
                return walk_by_neighbors(cells_, inside, stats, test_leaf);
            case Walk::Smart:
                return walk_smart(cells_, inside, stats, test_leaf);
            case Walk::Parametric:
                return walk_parametric(cells_, inside, stats, test_leaf);
        }
    }

    [[nodiscard]] const OctreeCells& cells() const { return cells_; }
    [[nodiscard]] std::size_t memory_bytes() const { return cells_.memory_bytes(); }

  private:
    /// Tests a leaf. True if the ray is done: stopped, or its nearest hit lies in the cell (a hit
    /// beyond the cell may lie behind others).
    template <class Visitor, class Stats>
    bool test(std::uint32_t leaf, double exit, Mailbox& mailbox, Visitor& visitor,
              Stats stats) const {
        const OctreeCells::Node& cell = cells_.nodes()[leaf];
        note_cell(stats, leaf);
        const std::span entries(cells_.entries().data() + cell.first, cell.count);
        if (visit_entries(entries, config_.mailbox, mailbox, visitor, stats)) return true;
        return visitor.t_max() < exit;
    }

    Config config_;
    OctreeCells cells_;
    std::uint32_t primitives_ = 0;
};
static_assert(Accelerator<Octree>);

}  // namespace alhazen
