#pragma once
/// The nearest point of a polygon.
///
/// Source: the foot of the perpendicular if it lies inside by the odd-even rule (Foley, van Dam et
/// al., "Computer Graphics", section 2.1.3), else the nearest point of an edge.
/// Differs: edges that an even number of loops share are none (math/odd_segments.h).
/// Conventions: as clipped_region.h. Complexity: O(vertices).

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/shapes/nearest/clipped_region.h"

namespace alhazen {

class FlatRegion {
  public:
    /// Loops of vertices in or near a plane, onto which they are projected; `normal` is unit.
    /// loop_ends: [loop] one past its last vertex.
    FlatRegion(const std::vector<Vec3>& vertices, std::vector<std::uint32_t> loop_ends,
               const Vec3& point, const Vec3& normal);

    [[nodiscard]] PointOnSurface nearest(const Vec3& from) const;
    [[nodiscard]] std::size_t bytes() const {
        return sizeof(*this) + edges_.capacity() * sizeof(Edge);
    }

  private:
    struct Edge {
        std::array<Vec3, 2> ends;
        std::array<Vec2, 2> flat;  ///< the ends in coordinates of the plane
    };

    [[nodiscard]] bool holds(const Vec2& p) const;
    [[nodiscard]] Vec2 flat(const Vec3& p) const;

    std::vector<Edge> edges_;
    Vec3 point_, normal_, x_axis_, y_axis_;
};

}  // namespace alhazen
