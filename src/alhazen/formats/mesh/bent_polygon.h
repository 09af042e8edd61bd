#pragma once
/// Polygons of files whose corners are not in a plane.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/shapes/polygons/polygon.h"

namespace alhazen {

struct BentPolygon {
    Polygon polygon;         ///< prepared; a single loop has no corner where the one before is
    std::vector<Vec3> flat;  ///< its corners, moved along the normal into its plane
    /// True if triangles on the corners are certain to cover what is inside its only loop, seen
    /// along the normal.
    bool is_simple = false;

    /// Triangles on the corners, as seen along the normal. Precondition: one loop.
    [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles() const;
    /// The beginning of a message: "its corners are not in a plane, but up to 0.1 off: it is ".
    [[nodiscard]] std::string warning() const;
};

/// Nothing if the corners are in a plane (`is_flat`), or numbers cannot be computed with.
[[nodiscard]] std::optional<BentPolygon> bent_polygon(const Polygon& given);

}  // namespace alhazen
