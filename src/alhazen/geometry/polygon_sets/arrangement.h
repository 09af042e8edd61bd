#pragma once
/// The edges of two sets, divided exactly at all their common points: input of the rounding, of the
/// selection of regions and of the exact areas.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/polygon_sets/lattice.h"

namespace alhazen {

/// Bits of a state: the operands that contain a point.
inline constexpr std::uint8_t kInFirst = 1;
inline constexpr std::uint8_t kInSecond = 2;

/// A piece of an edge between two successive points of the arrangement on it.
struct SubEdge {
    std::uint32_t begin = 0;  ///< the lesser point
    std::uint32_t end = 0;
    std::uint32_t edge = 0;  ///< one of the edges that it lies on
    std::uint8_t below = 0;  ///< the state on its right
    std::uint8_t above = 0;  ///< the state on its left
};

struct ArrangementEdge {
    LatticePoint lo;  ///< the lesser end
    LatticePoint hi;
};

/// Two successive sub-edges whose vertical view of each other ends at a point of the arrangement;
/// the interior of the first operand lies between them.
struct EdgeInterval {
    std::uint32_t point = 0;
    std::uint32_t lower = 0;  ///< index of a sub-edge
    std::uint32_t upper = 0;
};

struct Arrangement {
    std::vector<ArrangementEdge> edges;
    std::vector<LatticePlace> points;     ///< in ascending order, no two equal
    std::vector<SubEdge> sub_edges;       ///< none overlaps or crosses another
    std::vector<EdgeInterval> intervals;  ///< if requested; in ascending order of the points
    bool rounds = false;                  ///< true if a point is not on the lattice
    std::size_t crossings = 0;            ///< points where edges cross and neither ends
    std::size_t overlaps = 0;             ///< sub-edges shared by several edges

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

/// The faces of an arrangement of any number of operands. A face may have several numbers; `root`
/// maps them to one.
struct ArrangementFaces {
    std::vector<std::uint32_t> below;       ///< [sub-edge] a number of the face on its right
    std::vector<std::uint32_t> above;       ///< [sub-edge] a number of the face on its left
    std::vector<std::uint32_t> owner_ends;  ///< [number] one past its last entry in `owners`
    std::vector<std::uint32_t> owners;      ///< operands that contain a face, ascending
    std::vector<std::uint32_t> same;        ///< [number] another number of the same face

    void clear();
    [[nodiscard]] std::uint32_t root(std::uint32_t number) const;
    [[nodiscard]] std::span<const std::uint32_t> owners_of(std::uint32_t number) const {
        const std::uint32_t begin = number == 0 ? 0 : owner_ends[number - 1];
        return std::span(owners).subspan(begin, owner_ends[number] - begin);
    }
    /// The face on the other side of an edge of the operands `crossed`, which ascend.
    std::uint32_t add_across(std::uint32_t number, std::span<const std::uint32_t> crossed);
    void unite(std::uint32_t a, std::uint32_t b);
};

class PolygonSet;

/// The arrangement of two sets before rounding, from which exact areas are computed. Valid until
/// the next call in this thread.
[[nodiscard]] const Arrangement& exact_arrangement(const PolygonSet& first,
                                                   const PolygonSet& second);

}  // namespace alhazen
