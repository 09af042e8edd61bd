#pragma once
/// What is kept of primitives to find out, while rays are traced, which of them a set of rays may
/// meet: boxes and spheres around them, and the vertices of triangles.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/geometry/bounds_source.h"

namespace alhazen {

class BoundedBodies {
  public:
    BoundedBodies() = default;
    explicit BoundedBodies(const BoundsSource& source) {
        bodies_.reserve(source.size());
        for (std::size_t i = 0; i < source.size(); ++i) {
            Body& body = bodies_.emplace_back(Body{source.box(i), source.sphere(i)});
            if (const auto corners = source.triangle(i)) {
                body.triangle = static_cast<std::uint32_t>(triangles_.size());
                triangles_.push_back(*corners);
            }
        }
    }

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(bodies_.size()); }
    [[nodiscard]] const Box3& box(std::uint32_t i) const { return bodies_[i].box; }
    [[nodiscard]] const BoundingSphere& sphere(std::uint32_t i) const { return bodies_[i].sphere; }
    /// Null where it is none.
    [[nodiscard]] const std::array<Vec3, 3>* triangle(std::uint32_t i) const {
        return bodies_[i].triangle == kNone ? nullptr : &triangles_[bodies_[i].triangle];
    }
    /// Range of dot(axis, p) over the points of a primitive; `steepness` is the length of the axis.
    [[nodiscard]] Interval extent(std::uint32_t i, const Vec3& axis, double steepness) const {
        const Body& body = bodies_[i];
        if (body.triangle != kNone) {
            Interval range;
            for (const Vec3& p : triangles_[body.triangle]) range.include(dot(axis, p));
            return range;
        }
        const double middle = dot(axis, body.sphere.center);
        const double half = steepness * body.sphere.radius;
        return intersection(alhazen::extent(body.box, axis), {middle - half, middle + half});
    }
    [[nodiscard]] std::size_t memory_bytes() const {
        return bodies_.capacity() * sizeof(Body) + triangles_.capacity() * sizeof(triangles_[0]);
    }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    struct Body {
        Box3 box;
        BoundingSphere sphere;
        std::uint32_t triangle = kNone;
    };
    std::vector<Body> bodies_;
    std::vector<std::array<Vec3, 3>> triangles_;
};

}  // namespace alhazen
