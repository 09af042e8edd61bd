#pragma once
/// The nearest point of a polygon.
///
/// Source: the foot of the perpendicular if it lies inside by the odd-even rule (Foley, van Dam et
/// al., "Computer Graphics", section 2.1.3), else the nearest point of an edge.
/// Conventions: as clipped_region.h. Complexity: O(vertices).

#include <cstdint>
#include <vector>

#include "alhazen/shapes/nearest/clipped_region.h"

namespace alhazen {

class FlatRegion {
  public:
    /// Loops of vertices in or near a plane, onto which they are projected; `normal` is unit.
    /// loop_ends: [loop] one past its last vertex.
    FlatRegion(std::vector<Vec3> vertices, std::vector<std::uint32_t> loop_ends, const Vec3& point,
               const Vec3& normal);

    [[nodiscard]] PointOnSurface nearest(const Vec3& from) const;
    [[nodiscard]] std::size_t bytes() const {
        return sizeof(*this) + vertices_.capacity() * sizeof(Vec3) +
               flat_.capacity() * sizeof(Vec2) + loop_ends_.capacity() * sizeof(std::uint32_t);
    }

  private:
    [[nodiscard]] bool holds(const Vec2& p) const;
    [[nodiscard]] Vec2 flat(const Vec3& p) const;

    std::vector<Vec3> vertices_;
    std::vector<Vec2> flat_;  ///< the vertices in coordinates of the plane
    std::vector<std::uint32_t> loop_ends_;
    Vec3 point_, normal_, x_axis_, y_axis_;
};

}  // namespace alhazen
