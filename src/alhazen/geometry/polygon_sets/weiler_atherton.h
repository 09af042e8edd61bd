#pragma once
/// Clipping by walks along linked boundary lists.
///
/// Source: Weiler and Atherton, "Hidden Surface Removal Using Polygon Area Sorting", SIGGRAPH 1977:
/// crossings are vertices of both boundaries, linked to each other; from a crossing where the
/// subject enters the clip polygon, the subject is followed to the next crossing, then the clip
/// polygon from there on, and so on to the start.
/// Differs: the region is to the left, not to the right, of its boundary. The clip polygon is
/// followed backwards where the paper copies it in reverse. Crossings are exact. The union is a
/// similar walk along the parts outside the other operand. Regions are rounded and written as in
/// set_operations.h and equal its results.
/// Conventions: operands must be in general position: neither touches itself, and no vertex of one
/// lies on the boundary of the other. Otherwise the walk cannot determine where it enters; the
/// result is then empty, and the position tells why.
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

/// All three regions, if the operands are in general position.
[[nodiscard]] std::optional<WeilerAtherton> weiler_atherton(const PolygonSet& subject,
                                                            const PolygonSet& clip,
                                                            GeneralPosition* position = nullptr);

}  // namespace alhazen
