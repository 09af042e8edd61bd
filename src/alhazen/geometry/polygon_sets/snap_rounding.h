#pragma once
/// Moves the points of an arrangement to lattice points such that no edge passes over a point.
///
/// Source: Hobby, "Practical Segment Intersection with Finite Precision Output", Computational
/// Geometry 13, 1999; Guibas and Marimont, "Rounding Arrangements Dynamically", SoCG 1995 (the
/// faces keep their order).
/// Conventions: the pixel of every point is hot. A sub-edge becomes the polyline through the
/// centres of all hot pixels that its edge meets between its ends. If all points are on the
/// lattice, nothing changes.
/// Complexity: O(m) if nothing is rounded, else usually O(m (log m + pixels near a sub-edge)).

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/polygon_sets/arrangement.h"

namespace alhazen {

class SnapRounding {
  public:
    /// Rounds the points. `arrangement` must outlive the use of the results.
    void round(const Arrangement& arrangement);

    /// [point] its lattice point.
    [[nodiscard]] std::span<const LatticePoint> pixels() const { return pixels_; }
    /// The point that represents all points of the same pixel.
    [[nodiscard]] std::uint32_t representative(std::uint32_t point) const {
        return rounds_ ? representative_[point] : point;
    }
    /// True if rounding may have made sub-edges overlap.
    [[nodiscard]] bool merges() const { return merges_; }
    /// The points, without its ends, that a sub-edge passes through, in its order. Valid until the
    /// next call.
    [[nodiscard]] std::span<const std::uint32_t> between(const SubEdge& sub_edge);

  private:
    void merge_columns();
    void merge_column(std::uint32_t begin, std::uint32_t end);
    void build_tree(std::uint32_t begin, std::uint32_t end, bool by_x);
    void search_tree(std::uint32_t begin, std::uint32_t end, bool by_x);
    void try_pixel(std::uint32_t point);

    const Arrangement* arrangement_ = nullptr;
    std::vector<LatticePoint> pixels_;
    std::vector<std::uint32_t> representative_;
    std::vector<std::uint32_t> between_;
    std::vector<std::uint32_t> tree_;  ///< points; the middle of each range divides it
    std::vector<std::uint32_t> column_;
    ArrangementEdge edge_;  ///< the edge searched for
    LatticeBox box_;
    LatticePoint ends_[2];
    bool rounds_ = false;
    bool merges_ = false;
};

}  // namespace alhazen
