#pragma once
/// A flat disc, with a round hole when `inner_radius` > 0.
///
/// Conventions: `normal` need not be unit. u runs around the normal (0 to 1), v from the inner
/// radius (0) to the outer (1). Both sides are hit; both rims belong to the disc.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct Disc {
    static constexpr const char* kName = "disc";
    static constexpr int kMaxHits = 1;
    static constexpr bool kClosed = false;

    Vec3 center{0, 0, 0};
    Vec3 normal{0, 0, 1};
    double radius = 1;
    double inner_radius = 0;
    Vec3 unit_normal{0, 0, 1};  ///< derived: set by prepare
    Vec3 u_axis{1, 0, 0};       ///< derived: unit, in the plane; u counts from here

    static constexpr auto kFields = std::make_tuple(
        field("center", &Disc::center, Unit::Point, Check::Point),
        field("normal", &Disc::normal, Unit::Direction, Check::Vector),
        field("radius", &Disc::radius, Unit::Length, Check::Length),
        optional_field("inner_radius", &Disc::inner_radius, Unit::Length, Check::LengthOrZero));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
