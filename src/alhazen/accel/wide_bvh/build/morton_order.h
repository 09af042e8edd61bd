#pragma once
/// Sorts points along a space-filling curve.
///
/// Source: Morton, "A Computer Oriented Geodetic Data Base", IBM 1966 (the curve); Lauterbach et
/// al., "Fast BVH Construction on GPUs", CGF 28(2), 2009 (its use).
/// Differs: the grid is halved along the longest side of its cells, not along the axes in turn;
/// a cell with more points than a block holds is divided anew, by a grid of its own.
/// Complexity and threads: O(n), parallel. The result is the same for every number of threads.

#include <cstdint>
#include <functional>
#include <vector>

#include "alhazen/accel/wide_bvh/build/box4.h"
#include "alhazen/base/huge_room.h"

namespace alhazen {

/// A regular grid of 2^32 cells at most over a box, and the places of its cells on the curve.
class CurveGrid {
  public:
    explicit CurveGrid(const Box4& box);

    /// Precondition: the point is in the box.
    [[nodiscard]] std::uint32_t code(Float4 point) const {
        const Cell c = cell(point);
        return (low_[0][c.x % kLow] | high_[0][c.x / kLow]) |
               (low_[1][c.y % kLow] | high_[1][c.y / kLow]) |
               (low_[2][c.z % kLow] | high_[2][c.z / kLow]);
    }

    /// The codes of many points, by larger tables. Keeps a reference.
    class Codes {
      public:
        explicit Codes(const CurveGrid& grid);
        [[nodiscard]] std::uint32_t operator()(Float4 point) const {
            const Cell c = grid_.cell(point);
            return all_[0][c.x] | all_[1][c.y] | all_[2][c.z];
        }

      private:
        const CurveGrid& grid_;
        std::uint32_t all_[3][1 << 11];  ///< [axis][number of the cell along it]
    };

  private:
    static constexpr int kAxisBits = 11, kLowBits = 6;
    static constexpr std::uint32_t kLow = 1u << kLowBits;

    /// The numbers of a cell along the axes.
    struct Cell {
        std::uint32_t x, y, z;
    };
    [[nodiscard]] Cell cell(Float4 point) const {
        const Int4 cell = __builtin_convertvector(lesser((point - lo_) * scale_, most_), Int4);
        return {static_cast<std::uint32_t>(cell[0]), static_cast<std::uint32_t>(cell[1]),
                static_cast<std::uint32_t>(cell[2])};
    }

    Float4 lo_, scale_{}, most_;
    /// The bits of the code by the low and the high bits of the cell's number along an axis.
    std::uint32_t low_[3][kLow], high_[3][1u << (kAxisBits - kLowBits)];
};

/// Cells with more points are divided anew.
inline constexpr std::size_t kCurveLeafSize = 8;

/// Points that are made whenever they are needed: storing them takes longer.
struct CurvePoints {
    std::size_t size = 0;
    /// Writes the points from `begin` to `end`, the fourth lane 0. Must be thread-safe.
    std::function<void(std::size_t begin, std::size_t end, Float4* to)> make;
};

/// Points in the order of the curve; those at the same place are in the order of their indices.
class CurveOrder {
  public:
    /// Takes room_bytes(points.size) of the room, which must outlive it.
    CurveOrder(const CurvePoints& points, HugeRoom& room);
    [[nodiscard]] static std::size_t room_bytes(std::size_t points) {
        return 2 * HugeRoom::bytes_for<Entry>(points);
    }

    /// The place of the i-th point on the curve; ascending.
    [[nodiscard]] std::uint64_t place(std::size_t i) const {
        const std::uint64_t cell = entries_[i] >> 32 << 32;
        return rest_ == nullptr ? cell : cell | rest_[i];
    }
    /// True if a cell was divided anew.
    [[nodiscard]] bool divided() const { return rest_ != nullptr; }
    /// [i] The cell, and below it the index. The differences of places that lie in other cells are
    /// those of these in the upper halves.
    [[nodiscard]] const std::uint64_t* entries() const { return entries_; }
    /// The index of the i-th point.
    [[nodiscard]] std::uint32_t index(std::size_t i) const {
        return static_cast<std::uint32_t>(entries_[i]);
    }

  private:
    /// A cell, and below it the index of a point.
    using Entry = std::uint64_t;
    struct Run {
        std::size_t begin, end;
    };

    static void sort(Entry*& entries, Entry*& other, std::size_t size);
    [[nodiscard]] std::vector<Run> crowded_cells() const;
    void divide_cell(Run run, const CurvePoints& points);

    std::size_t size_;
    Entry* entries_;
    HugeArray<std::uint32_t> rest_;  ///< [entry] place within a crowded cell; null if there is none
};

}  // namespace alhazen
