#pragma once
/// The polygon table of Fig. 15.54 (scan_lines.h): polygons are stored in the buckets of the scan
/// lines where they begin, and are active while scan lines cross them.
///
/// Conventions: a polygon has `first_row`, `end_row` (one past its last) and `next` for its bucket.
/// It is identified by its slot, which is reused after it has left.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace alhazen {

template <class Polygon>
class PolygonTable {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    explicit PolygonTable(int rows) : buckets_(static_cast<std::size_t>(rows), kNone) {}

    /// Returns a free slot, whose polygon still has its old value.
    [[nodiscard]] std::uint32_t take() {
        ++live_;
        most_ = std::max(most_, live_);
        if (free_.empty()) {
            polygons_.emplace_back();
            return static_cast<std::uint32_t>(polygons_.size() - 1);
        }
        const std::uint32_t slot = free_.back();
        free_.pop_back();
        return slot;
    }
    void give_back(std::uint32_t slot) {
        free_.push_back(slot);
        --live_;
    }
    [[nodiscard]] Polygon& operator[](std::uint32_t slot) { return polygons_[slot]; }

    /// Adds a polygon to the bucket of its first row, or of `row` if it has begun; the later of
    /// them must be a row of the table.
    void put(std::uint32_t slot, int row) {
        Polygon& polygon = polygons_[slot];
        std::uint32_t& first = buckets_[static_cast<std::size_t>(std::max(row, polygon.first_row))];
        polygon.next = first;
        first = slot;
    }
    /// Activates the polygons in the row's bucket.
    void enter(int row) {
        for (std::uint32_t slot = buckets_[static_cast<std::size_t>(row)]; slot != kNone;
             slot = polygons_[slot].next) {
            active_.push_back(slot);
        }
    }
    /// Frees polygons that end at the row.
    void leave(int row) {
        std::size_t kept = 0;
        for (const std::uint32_t slot : active_) {
            if (polygons_[slot].end_row > row) {
                active_[kept++] = slot;
            } else {
                give_back(slot);
            }
        }
        active_.resize(kept);
    }

    /// The slots of the polygons that cross the row.
    [[nodiscard]] const std::vector<std::uint32_t>& active() const { return active_; }
    [[nodiscard]] std::size_t live() const { return live_; }
    /// The largest `live` so far.
    [[nodiscard]] std::size_t most() const { return most_; }

  private:
    std::vector<Polygon> polygons_;       ///< [slot]
    std::vector<std::uint32_t> free_;     ///< slots
    std::vector<std::uint32_t> buckets_;  ///< [row] the first slot; the others follow by `next`
    std::vector<std::uint32_t> active_;
    std::size_t live_ = 0, most_ = 0;
};

}  // namespace alhazen
