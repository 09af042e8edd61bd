#pragma once
/// Makes polygon sets of arbitrary loops: self-crossing, overlapping, of zero area, of any
/// orientation.
///
/// Conventions: a point is inside if a ray from it crosses the loops an odd number of times.
/// Complexity: as set_operations.h.

#include <cstddef>
#include <span>
#include <string>

#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

/// Counts of the defects that were repaired.
struct Mending {
    std::size_t crossings = 0;        ///< places where edges crossed away from vertices
    std::size_t overlaps = 0;         ///< overlapping pieces of edges
    std::size_t flat_loops = 0;       ///< without area, or of fewer than 3 distinct points
    std::size_t repeated_points = 0;  ///< points equal to the previous one
    std::size_t touches = 0;          ///< places where the outline touched itself

    [[nodiscard]] bool any() const {
        return crossings + overlaps + flat_loops + repeated_points + touches > 0;
    }
};

/// A description such as "3 crossings, 1 loop without area"; empty if there were no defects.
[[nodiscard]] std::string to_string(const Mending& mending);

/// The region of the loops by the even-odd rule. Throws Error if a coordinate exceeds
/// kLatticeLimit.
[[nodiscard]] PolygonSet polygon_set(std::span<const LatticeLoop> loops,
                                     Mending* mending = nullptr);
[[nodiscard]] PolygonSet polygon_set(const LatticeLoop& loop, Mending* mending = nullptr);

}  // namespace alhazen
