#pragma once
/// An unbounded plane.
///
/// Source: Foley, van Dam et al., "Computer Graphics", eq. 15.18-15.21.
/// Conventions: both sides are hit; `normal` need not be unit. uv are coordinates along two unit
/// vectors in the plane from `point`. A ray in the plane misses it.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct Plane {
    static constexpr const char* kName = "plane";
    static constexpr int kMaxHits = 1;
    static constexpr bool kClosed = false;

    Vec3 point{0, 0, 0};
    Vec3 normal{0, 0, 1};
    Vec3 unit_normal{0, 0, 1};  ///< derived: set by prepare
    Vec3 u_axis{1, 0, 0};       ///< derived: unit, in the plane

    static constexpr auto kFields =
        std::make_tuple(field("point", &Plane::point, Unit::Point, Check::Point),
                        field("normal", &Plane::normal, Unit::Direction, Check::Vector));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
