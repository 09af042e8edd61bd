#pragma once
/// The cells into which the base plane of a bundle of parallel lines is cut.
///
/// Implementation of stratified_chords.h. Cells that touch differ by one halving at most.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace alhazen {

/// A rectangle of the unit square.
struct ChordCell {
    /// Second derivatives xx, xy, yy in units of half a cell's sides.
    using Curvature = std::array<float, 3>;

    double x, y;
    float width, height;
    float scatter = 0;  ///< estimated variance of the two pairs of lines
    Curvature curvature{};
    float trust = 0;       ///< share of the curvature in the model; 0: no model
    bool quarter = false;  ///< quarter of a surveyed cell
    bool surveyed = false;
    std::uint8_t level = 0;   ///< halvings of its patch
    std::uint8_t patch = 0;   ///< index of its patch
    std::uint64_t place = 0;  ///< Morton number of its lower corner in the patch; x before y

    [[nodiscard]] double area() const { return double{width} * height; }
    [[nodiscard]] std::array<ChordCell, 4> quarters() const;
};

/// Cells that fill patches of the unit square.
class ChordCells {
  public:
    /// A rectangle of the unit square.
    struct Patch {
        double x = 0, y = 0;
        float width = 1, height = 1;

        [[nodiscard]] double area() const { return double{width} * height; }
    };

    /// The unit square.
    ChordCells() : patches_{Patch{}} {}
    /// Precondition: the patches are disjoint, at least one and at most 256.
    explicit ChordCells(std::vector<Patch> patches);

    [[nodiscard]] std::size_t size() const { return cells_.size(); }
    [[nodiscard]] std::span<ChordCell> all() { return cells_; }
    [[nodiscard]] std::span<const ChordCell> all() const { return cells_; }
    /// Area of the patches.
    [[nodiscard]] double covered() const { return covered_; }
    /// Least width and height of the patches.
    [[nodiscard]] const std::array<double, 2>& narrowest() const { return narrowest_; }

    /// Makes about a fourth of this many cells, and at least one for every patch.
    void make_grid(std::size_t cells);
    /// Cuts the cells of largest variance, and some of the largest, into four each until there are
    /// about `cells`. `share_for_size`: of the cells cut that are cut for their size alone.
    void cut(std::size_t cells, double share_for_size);

  private:
    /// Marks a cell to be cut, and all others that must be for it; returns their number.
    std::size_t mark(std::size_t cell, std::vector<bool>& is_cut) const;
    /// The cell that contains the place.
    [[nodiscard]] std::size_t cell_at(std::uint8_t patch, std::uint64_t place) const;

    std::vector<Patch> patches_;
    double covered_ = 1;
    std::array<double, 2> narrowest_{1, 1};
    std::vector<ChordCell> cells_;
};

}  // namespace alhazen
