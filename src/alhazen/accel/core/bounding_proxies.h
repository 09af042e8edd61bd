#pragma once
/// Bounding proxies of primitives: boxes, spheres, and the corners of flat polygons, for culling
/// sets of rays.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/bounds_source.h"

namespace alhazen {

/// The corners, in order, of a primitive that is a flat convex polygon (a triangle); empty for
/// others.
[[nodiscard]] inline std::vector<Vec3> outline_of(const BoundsSource& source, std::size_t i) {
    const auto corners = source.triangle(i);
    return corners ? std::vector<Vec3>(corners->begin(), corners->end()) : std::vector<Vec3>{};
}

class BoundingProxies {
  public:
    BoundingProxies() = default;
    explicit BoundingProxies(const BoundsSource& source) {
        bodies_.reserve(source.size());
        for (std::size_t i = 0; i < source.size(); ++i) {
            Body& body = bodies_.emplace_back(Body{source.box(i), source.sphere(i), 0, 0});
            const std::vector<Vec3> outline = outline_of(source, i);
            body.first = corners_.size();
            body.count = static_cast<std::uint32_t>(outline.size());
            corners_.insert(corners_.end(), outline.begin(), outline.end());
        }
    }

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(bodies_.size()); }
    [[nodiscard]] const Box3& box(std::uint32_t i) const { return bodies_[i].box; }
    [[nodiscard]] const BoundingSphere& sphere(std::uint32_t i) const { return bodies_[i].sphere; }
    /// The corners of a flat convex polygon; empty for all other primitives.
    [[nodiscard]] std::span<const Vec3> outline(std::uint32_t i) const {
        return {corners_.data() + bodies_[i].first, bodies_[i].count};
    }
    /// Range of dot(axis, p) over the points of a primitive; `steepness` is the length of the axis.
    [[nodiscard]] Interval extent(std::uint32_t i, const Vec3& axis, double steepness) const {
        const Body& body = bodies_[i];
        if (body.count > 0) {
            Interval range;
            for (const Vec3& p : outline(i)) range.include(dot(axis, p));
            return range;
        }
        const double middle = dot(axis, body.sphere.center);
        const double half = steepness * body.sphere.radius;
        return intersection(alhazen::extent(body.box, axis), {middle - half, middle + half});
    }
    [[nodiscard]] std::size_t memory_bytes() const {
        return bodies_.capacity() * sizeof(Body) + corners_.capacity() * sizeof(Vec3);
    }

  private:
    struct Body {
        Box3 box;
        BoundingSphere sphere;
        std::size_t first = 0;  ///< index of its first corner
        std::uint32_t count = 0;
    };
    std::vector<Body> bodies_;
    std::vector<Vec3> corners_;
};

}  // namespace alhazen
