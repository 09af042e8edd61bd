#pragma once
/// An elliptic paraboloid from its apex to a flat rim, right or oblique.
///
/// Source: clipped_quadric.h: x^2 + y^2 < z up to z = 1 in the frame of the rim's semi-axes and the
/// vector from the apex to the rim's centre.
/// Conventions: part 0 the bowl, 6 the rim's plane. u runs around from `axis_a`, v from the apex
/// (0) to the rim (1).

#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

struct Paraboloid {
    static constexpr const char* kName = "paraboloid";
    static constexpr int kMaxHits = ClippedQuadric::kMaxHits;
    static constexpr bool kClosed = true;

    Vec3 apex{0, 0, 0}, rim{0, 0, 1};       ///< rim: its centre
    Vec3 axis_a{1, 0, 0}, axis_b{0, 1, 0};  ///< semi-axes of the rim
    bool capped = true;
    ClippedQuadric solid{};  ///< derived

    static constexpr auto kFields =
        std::make_tuple(field("apex", &Paraboloid::apex, Unit::Point, Check::Point),
                        field("rim", &Paraboloid::rim, Unit::Point, Check::Point),
                        field("axis_a", &Paraboloid::axis_a, Unit::Vector, Check::Shape),
                        field("axis_b", &Paraboloid::axis_b, Unit::Vector, Check::Shape),
                        optional_field("capped", &Paraboloid::capped, Unit::Flag, Check::None));

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
