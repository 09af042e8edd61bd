#pragma once
/// An elliptic cone or frustum, right or oblique, with similar cross-sections.
///
/// Source: clipped_quadric.h: x^2 + y^2 < (1 - (1 - s) z)^2 between z = 0 and 1 in the frame of the
/// semi-axes of the base and the vector from base to top; s = top_scale.
/// Conventions: as for elliptic_cylinder.h. For cross-sections of varying shape see tgc.h.

#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

struct EllipticCone {
    static constexpr const char* kName = "elliptic_cone";
    static constexpr int kMaxHits = ClippedQuadric::kMaxHits;
    static constexpr bool kClosed = true;

    Vec3 base{0, 0, 0}, top{0, 0, 1};       ///< centres of the ends
    Vec3 axis_a{1, 0, 0}, axis_b{0, 1, 0};  ///< semi-axes of the base
    double top_scale = 0;                   ///< size of the top relative to the base; 0: an apex
    bool capped = true;
    ClippedQuadric solid{};  ///< derived

    static constexpr auto kFields = std::make_tuple(
        field("base", &EllipticCone::base, Unit::Point, Check::Point),
        field("top", &EllipticCone::top, Unit::Point, Check::Point),
        field("axis_a", &EllipticCone::axis_a, Unit::Vector, Check::Shape),
        field("axis_b", &EllipticCone::axis_b, Unit::Vector, Check::Shape),
        optional_field("top_scale", &EllipticCone::top_scale, Unit::Number, Check::Shape),
        optional_field("capped", &EllipticCone::capped, Unit::Flag, Check::None));

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

}  // namespace alhazen
