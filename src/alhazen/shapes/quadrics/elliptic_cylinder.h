#pragma once
/// An elliptic cylinder, right or oblique, with or without flat ends.
///
/// Source: clipped_quadric.h: x^2 + y^2 < 1 between z = 0 and 1 in the frame of the two semi-axes
/// and the vector from base to top.
/// Conventions: part 0 the side, 5 the end at `base`, 6 the end at `top`. u runs around from
/// `axis_a`, v from base (0) to top (1), on the ends from the centre (0) to the rim (1).

#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

struct EllipticCylinder {
    static constexpr const char* kName = "elliptic_cylinder";
    static constexpr int kMaxHits = ClippedQuadric::kMaxHits;
    static constexpr bool kClosed = true;

    Vec3 base{0, 0, 0}, top{0, 0, 1};       ///< centres of the ends
    Vec3 axis_a{1, 0, 0}, axis_b{0, 1, 0};  ///< semi-axes of both ends
    bool capped = true;
    ClippedQuadric solid{};  ///< derived

    static constexpr auto kFields = std::make_tuple(
        field("base", &EllipticCylinder::base, Unit::Point, Check::Point),
        field("top", &EllipticCylinder::top, Unit::Point, Check::Point),
        field("axis_a", &EllipticCylinder::axis_a, Unit::Vector, Check::Shape),
        field("axis_b", &EllipticCylinder::axis_b, Unit::Vector, Check::Shape),
        optional_field("capped", &EllipticCylinder::capped, Unit::Flag, Check::None));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return capped; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const { return solid.intersect(ray, hits); }
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const {
        return solid.surface(ray, hit);
    }
};

/// Box and extent of a filled ellipse, rounded outward.
[[nodiscard]] Box3 ellipse_box(const Vec3& center, const Vec3& a, const Vec3& b);
[[nodiscard]] Interval ellipse_extent(const Vec3& axis, const Vec3& center, const Vec3& a,
                                      const Vec3& b);

}  // namespace alhazen
