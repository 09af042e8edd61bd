#pragma once
/// Clipping by walks along linked boundary lists.
///
/// Source: Weiler and Atherton, "Hidden Surface Removal Using Polygon Area Sorting", SIGGRAPH 1977:
/// crossings are vertices of both boundaries, linked to each other; from a crossing where the
/// subject enters the clip polygon, the subject is followed to the next crossing, then the clip
/// polygon from there on, and so on to the start.
/// Differs: the region is on the left, not on the right, of its boundary. The clip polygon is
/// followed backwards where the paper copies it in reverse. Crossings are exact. The union is the
/// walk of the same kind along what is outside of the other. The regions are rounded and written as
/// those of set_operations.h and are equal to them.
/// Conventions: for general position alone: no operand touches itself, no vertex of one lies on the
/// boundary of the other. Where this does not hold the walk cannot know where it enters; nothing is
/// returned then, and the position says why.
/// Complexity: O(n m) for the crossings, O((n + k) log(n + k)) for the rest.

#include <cstdint>
#include <optional>

#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

enum class GeneralPosition : std::uint8_t {
    Holds,
    OperandTouchesItself,
    VertexOnBoundary,
};

struct WeilerAtherton {
    PolygonSet inside;   ///< subject and clip
    PolygonSet outside;  ///< subject without clip
    PolygonSet merged;   ///< subject or clip
};

/// All three regions, where the operands are in general position.
[[nodiscard]] std::optional<WeilerAtherton> weiler_atherton(const PolygonSet& subject,
                                                            const PolygonSet& clip,
                                                            GeneralPosition* position = nullptr);

}  // namespace alhazen
