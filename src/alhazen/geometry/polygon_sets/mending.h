#pragma once
/// Polygon sets out of any loops: self-crossing, overlapping, of zero area, in any direction.
///
/// Conventions: a point is inside where a ray from it crosses the loops an odd number of times.
/// Complexity: as set_operations.h.

#include <cstddef>
#include <span>
#include <string>

#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

/// What was mended.
struct Mending {
    std::size_t crossings = 0;        ///< places where edges crossed away from vertices
    std::size_t overlaps = 0;         ///< pieces of edges that lay on each other
    std::size_t flat_loops = 0;       ///< loops without area, of fewer than 3 distinct points too
    std::size_t repeated_points = 0;  ///< points equal to the one before
    std::size_t touches = 0;          ///< places where the outline touched itself

    [[nodiscard]] bool any() const {
        return crossings + overlaps + flat_loops + repeated_points + touches > 0;
    }
};

/// In words: "3 crossings, 1 loop without area"; empty where nothing was mended.
[[nodiscard]] std::string to_string(const Mending& mending);

/// The region of the loops by the even-odd rule. Throws Error where a coordinate exceeds
/// kLatticeLimit.
[[nodiscard]] PolygonSet polygon_set(std::span<const LatticeLoop> loops,
                                     Mending* mending = nullptr);
[[nodiscard]] PolygonSet polygon_set(const LatticeLoop& loop, Mending* mending = nullptr);

}  // namespace alhazen
