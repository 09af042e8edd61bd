#pragma once
/// The edges of two sets cut at all their common points, exactly: input of the rounding, of the
/// choice of regions and of the exact areas.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/polygon_sets/lattice.h"

namespace alhazen {

/// Bits of a state: which operands a point is inside of.
inline constexpr std::uint8_t kInFirst = 1;
inline constexpr std::uint8_t kInSecond = 2;

/// A piece of an edge between two points of the arrangement that follow each other on it.
struct SubEdge {
    std::uint32_t begin = 0;  ///< the lesser point
    std::uint32_t end = 0;
    std::uint32_t edge = 0;  ///< an edge that it lies on
    std::uint8_t below = 0;  ///< the state on its right
    std::uint8_t above = 0;  ///< the state on its left
};

struct ArrangementEdge {
    LatticePoint lo;  ///< the lesser end
    LatticePoint hi;
};

/// Two successive sub-edges between which a point of the arrangement ends the free view, from below
/// to above; between them is the inside of the first operand.
struct EdgeInterval {
    std::uint32_t point = 0;
    std::uint32_t lower = 0;  ///< index of a sub-edge
    std::uint32_t upper = 0;
};

struct Arrangement {
    std::vector<ArrangementEdge> edges;
    std::vector<LatticePlace> points;     ///< in ascending order, no two equal
    std::vector<SubEdge> sub_edges;       ///< no two on each other, none in the other's inside
    std::vector<EdgeInterval> intervals;  ///< where asked for; in ascending order of the points
    bool rounds = false;                  ///< a point is not on the lattice
    std::size_t crossings = 0;            ///< points where edges cross that end at neither
    std::size_t overlaps = 0;             ///< sub-edges of several edges

    void clear() {
        edges.clear();
        points.clear();
        sub_edges.clear();
        intervals.clear();
        rounds = false;
        crossings = 0;
        overlaps = 0;
    }
};

/// The faces of an arrangement of any number of operands. A face has one number or several, which
/// `root` makes one.
struct ArrangementFaces {
    std::vector<std::uint32_t> below;       ///< [sub-edge] a number of the face on its right
    std::vector<std::uint32_t> above;       ///< on its left
    std::vector<std::uint32_t> owner_ends;  ///< [number] in `owners`
    std::vector<std::uint32_t> owners;      ///< operands that hold a face, ascending
    std::vector<std::uint32_t> same;        ///< [number] one of the same face

    void clear();
    [[nodiscard]] std::uint32_t root(std::uint32_t number) const;
    [[nodiscard]] std::span<const std::uint32_t> owners_of(std::uint32_t number) const {
        const std::uint32_t begin = number == 0 ? 0 : owner_ends[number - 1];
        return std::span(owners).subspan(begin, owner_ends[number] - begin);
    }
    /// The face across an edge of the operands `crossed`, ascending.
    std::uint32_t add_across(std::uint32_t number, std::span<const std::uint32_t> crossed);
    void unite(std::uint32_t a, std::uint32_t b);
};

class PolygonSet;

/// The arrangement of two sets before anything is rounded: what exact areas are taken from. Valid
/// until the next call in this thread.
[[nodiscard]] const Arrangement& exact_arrangement(const PolygonSet& first,
                                                   const PolygonSet& second);

}  // namespace alhazen
