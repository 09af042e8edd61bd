#pragma once
/// What a builder may ask about the things it builds over: bounds, and what little else helps to
/// sort rays and things.
///
/// The one virtual interface of the build phase; traversal never calls it.

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

/// Where many rays end or begin, such as a light: known beforehand, so that something can be
/// prepared for these rays.
struct RayEnd {
    Vec3 place;                ///< or, at infinity, the unit direction towards it
    bool at_infinity = false;  ///< all its rays are parallel
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
    /// The vertices of primitive `i` where it is a triangle and nothing else. By default nothing.
    [[nodiscard]] virtual std::optional<std::array<Vec3, 3>> triangle(std::size_t i) const;
    /// True when primitive `i` stops every ray that asks for what is in the light's way, of
    /// whatever kind, wherever it is hit. By default not.
    [[nodiscard]] virtual bool blocks_light(std::size_t i) const;
    /// By default none. A hint: rays are free to go elsewhere.
    [[nodiscard]] virtual std::span<const RayEnd> ray_ends() const;
};

/// The sphere around a box.
[[nodiscard]] BoundingSphere bounding_sphere(const Box3& box);

/// Range of dot(axis, p) over the points of a box.
[[nodiscard]] Interval extent(const Box3& box, const Vec3& axis);

}  // namespace alhazen
