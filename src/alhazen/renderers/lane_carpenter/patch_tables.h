#pragma once
/// The patch table and the active-patch table of Fig. 15.54 (scan_lines.h).
///
/// Conventions: a patch is stored in the bucket of the row where it begins; an active one is split,
/// and its parts are added to either table, until they are flat.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "alhazen/renderers/core/reports/scan_line_report.h"
#include "alhazen/renderers/lane_carpenter/sample_grid.h"
#include "alhazen/renderers/lane_carpenter/scan_scene.h"
#include "alhazen/renderers/lane_carpenter/screen_view.h"
#include "alhazen/renderers/lane_carpenter/subdivision.h"

namespace alhazen {

class BoundarySeams;

class PatchTables {
  public:
    /// All arguments except `view` and `options` must outlive the object. `keeps_seams`:
    /// sub-patches store the weights of BoundarySeams.
    PatchTables(const ScanScene& scene, const ScreenView& view, const SampleGrid& grid,
                const ScanLineOptions& options, bool keeps_seams);

    [[nodiscard]] PatchDegrees degrees(const SubPatch& patch) const {
        const BezierNet& net = scene_.pieces[patch.piece].net;
        return {net.degree_u, net.degree_v};
    }

    /// Splits the patches that begin at rows up to `row`; calls `draw(patch)` for flat ones.
    template <class Draw>
    void advance(int row, ScanLineReport& report, Draw&& draw) {
        std::uint32_t& first = buckets_[static_cast<std::size_t>(row)];
        while (first != kNoPatch) {
            active_.push_back(first);
            first = pool_.at(first).next;
            --waiting_;
        }
        most_active_ = active_.size();
        while (!active_.empty()) {
            const std::uint32_t index = active_.back();
            active_.pop_back();
            SubPatch& patch = pool_.at(index);
            if (patch.step == PatchStep::Draw) {
                draw(patch);
            } else {
                split(patch, row, report);
            }
            pool_.give_back(index);
            most_active_ = std::max(most_active_, active_.size());
        }
    }

    /// Largest size of the active-patch table at the last scan line.
    [[nodiscard]] std::size_t most_active() const { return most_active_; }
    [[nodiscard]] std::size_t waiting() const { return waiting_; }
    [[nodiscard]] SubPatchPool& pool() { return pool_; }

  private:
    static constexpr std::uint32_t kNoPatch = 0xFFFFFFFFu;

    void add_piece(std::uint32_t piece, const BoundarySeams* seams);
    void split(const SubPatch& patch, int row, ScanLineReport& report);
    /// Adds a patch to the active table if it has begun, else to its bucket.
    void place(std::uint32_t index, int row);

    const ScanScene& scene_;
    ScreenView view_;
    Subdivision subdivision_;
    SubPatchPool pool_;
    std::vector<std::uint32_t> buckets_;  ///< [row] the patch table
    std::vector<std::uint32_t> active_;
    std::size_t waiting_ = 0, most_active_ = 0;
};

}  // namespace alhazen
