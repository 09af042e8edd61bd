#pragma once
/// What a builder may ask about the things it builds over: nothing but bounds.
///
/// The one virtual interface of the build phase; traversal never calls it.

#include <cstddef>

#include "alhazen/geometry/box.h"

namespace alhazen {

struct BoundingSphere {
    Vec3 center;
    double radius = 0;
};

class BoundsSource {
  public:
    virtual ~BoundsSource() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// A box that holds primitive `i`: finite, never empty, rounded outward.
    [[nodiscard]] virtual Box3 box(std::size_t i) const = 0;
    /// Range of dot(axis, p) over the points p of primitive `i`. By default that of its box.
    [[nodiscard]] virtual Interval extent(std::size_t i, const Vec3& axis) const;
    /// A sphere that holds primitive `i`. By default the one around its box.
    [[nodiscard]] virtual BoundingSphere sphere(std::size_t i) const;
    /// Whether primitive `i` may have a point in `cell`; may say so of one that has none. By
    /// default that of its box.
    [[nodiscard]] virtual bool overlaps(std::size_t i, const Box3& cell) const;
    /// A box that holds the part of primitive `i` inside `cell`; empty when there is none. By
    /// default the intersection of the two boxes.
    [[nodiscard]] virtual Box3 clipped_box(std::size_t i, const Box3& cell) const;
};

/// Range of dot(axis, p) over the points of a box.
[[nodiscard]] Interval extent(const Box3& box, const Vec3& axis);

}  // namespace alhazen
