#pragma once
/// An index of the boxes of a growing list of regions: finds those near a box.
///
/// Source: Franklin, "Adaptive Grids for Geometric Operations", Auto-Carto 6, 1983.
/// Differs: of a fixed number of cells, and made only for lists that are worth it.
/// Conventions: boxes have numbers from 0, in the order in which they are added. A region may
/// shrink after that: the index then has more than the region needs. Complexity: O(found) for small
/// boxes in long lists, O(n) in short ones.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "alhazen/geometry/polygon_sets/lattice.h"

namespace alhazen {

class BoxIndex {
  public:
    /// Removes all boxes; those to come lie about in `whole`.
    void reset(const LatticeBox& whole) {
        whole_ = whole;
        boxes_.clear();
        for (std::vector<std::uint32_t>& cell : cells_) cell.clear();
        indexed_ = false;
    }
    void add(const LatticeBox& box) {
        boxes_.push_back(box);
        if (indexed_) {
            insert(static_cast<std::uint32_t>(boxes_.size() - 1));
        } else if (boxes_.size() > kShort) {
            cells_.resize(kSide * kSide);
            for (std::uint32_t k = 0; k < boxes_.size(); ++k) insert(k);
            indexed_ = true;
        }
    }
    /// Numbers in ascending order, among them those of all boxes that meet `box`. Valid until the
    /// next call.
    [[nodiscard]] std::span<const std::uint32_t> near(const LatticeBox& box) {
        found_.clear();
        if (!indexed_) {
            found_.resize(boxes_.size());
            std::iota(found_.begin(), found_.end(), 0u);
            return found_;
        }
        for_cells(box, [&](std::size_t cell) {
            found_.insert(found_.end(), cells_[cell].begin(), cells_[cell].end());
        });
        std::sort(found_.begin(), found_.end());
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return found_;
    }

  private:
    /// Lists of at most this length have no grid.
    static constexpr std::size_t kShort = 512;
    static constexpr std::size_t kSide = 32;

    [[nodiscard]] static std::size_t column(std::int32_t x, std::int32_t lo, std::int32_t hi) {
        const std::int64_t wide = std::max<std::int64_t>(std::int64_t{hi} - lo, 1);
        const std::int64_t at = (std::int64_t{x} - lo) * std::int64_t{kSide} / wide;
        return static_cast<std::size_t>(std::clamp<std::int64_t>(at, 0, kSide - 1));
    }
    template <class Visit>
    void for_cells(const LatticeBox& box, const Visit& visit) const {
        const std::size_t x1 = column(box.hi.x, whole_.lo.x, whole_.hi.x);
        const std::size_t y1 = column(box.hi.y, whole_.lo.y, whole_.hi.y);
        for (std::size_t y = column(box.lo.y, whole_.lo.y, whole_.hi.y); y <= y1; ++y) {
            for (std::size_t x = column(box.lo.x, whole_.lo.x, whole_.hi.x); x <= x1; ++x) {
                visit(y * kSide + x);
            }
        }
    }
    void insert(std::uint32_t number) {
        for_cells(boxes_[number], [&](std::size_t cell) { cells_[cell].push_back(number); });
    }

    LatticeBox whole_;
    std::vector<LatticeBox> boxes_;
    std::vector<std::vector<std::uint32_t>> cells_;
    std::vector<std::uint32_t> found_;
    bool indexed_ = false;
};

}  // namespace alhazen
