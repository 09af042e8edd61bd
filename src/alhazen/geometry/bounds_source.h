#pragma once
/// The interface through which builders get the bounds of primitives, and hints for ordering rays
/// and primitives. The only virtual interface of the build phase; traversal never calls it.

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "alhazen/geometry/box.h"

namespace alhazen {

struct BoundingSphere {
    Vec3 center;
    double radius = 0;
};

/// A point where many rays start or end, such as a light, known in advance so that data for these
/// rays can be precomputed.
struct RayEnd {
    Vec3 place;                ///< the point or, at infinity, the unit direction towards it
    bool at_infinity = false;  ///< all its rays are parallel
};

class BoundsSource {
  public:
    virtual ~BoundsSource() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// A box that contains primitive `i`: finite, never empty, rounded outward.
    [[nodiscard]] virtual Box3 box(std::size_t i) const = 0;
    /// Range of dot(axis, p) over the points p of primitive `i`. Default: the range over its box.
    [[nodiscard]] virtual Interval extent(std::size_t i, const Vec3& axis) const;
    /// A sphere that contains primitive `i`. Default: the one around its box.
    [[nodiscard]] virtual BoundingSphere sphere(std::size_t i) const;
    /// True if primitive `i` may have a point in `cell` (conservative). Default: a test of its box.
    [[nodiscard]] virtual bool overlaps(std::size_t i, const Box3& cell) const;
    /// A box that contains the part of primitive `i` inside `cell`; empty if there is none.
    /// Default: the intersection of the two boxes.
    [[nodiscard]] virtual Box3 clipped_box(std::size_t i, const Box3& cell) const;
    /// The vertices of primitive `i` if it is a plain triangle. Default: none.
    [[nodiscard]] virtual std::optional<std::array<Vec3, 3>> triangle(std::size_t i) const;
    /// True if primitive `i` blocks every shadow ray of every kind wherever it is hit. Default:
    /// false.
    [[nodiscard]] virtual bool blocks_light(std::size_t i) const;
    /// The known ends of rays. A hint: rays may also start and end elsewhere. Default: none.
    [[nodiscard]] virtual std::span<const RayEnd> ray_ends() const;
};

/// The bounding sphere of a box.
[[nodiscard]] BoundingSphere bounding_sphere(const Box3& box);

/// Range of dot(axis, p) over the points of a box.
[[nodiscard]] Interval extent(const Box3& box, const Vec3& axis);

}  // namespace alhazen
