#pragma once
/// A truncated general cone: the hull between two parallel ellipses of any axes.
///
/// Source: Weiss, "Geometry primitives of the GIFT code", 1966, and their use in BRL-CAD (the TGC:
/// base vertex, height, semi-axes of both ends); polynomial_solid.h.
/// Differs: the semi-axes of one end need not be perpendicular to each other, only parallel to
/// those of the other end. A quartic x^2 b(z)^2 + y^2 a(z)^2 < a(z)^2 b(z)^2 where the ratios of
/// the two ends differ, else the quadric of an elliptic cone or cylinder.
/// Conventions: as for elliptic_cylinder.h. One end may shrink to a line or a point, not both.

#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

struct Tgc {
    static constexpr const char* kName = "tgc";
    static constexpr int kMaxHits = 6;
    static constexpr bool kClosed = true;

    Vec3 base{0, 0, 0}, height{0, 0, 1};    ///< centre of the base; vector to that of the top
    Vec3 axis_a{1, 0, 0}, axis_b{0, 1, 0};  ///< semi-axes of the base
    Vec3 axis_c{1, 0, 0},
        axis_d{0, 1, 0};  ///< semi-axes of the top, parallel to a, b; any length or zero
    bool capped = true;
    ClippedQuadric solid{};                 ///< derived: frame, clip, and the quadric if it is one
    bool quartic = false;                   ///< derived
    double a0 = 1, a1 = 1, b0 = 1, b1 = 1;  ///< derived: semi-axes of base and top in the frame

    static constexpr auto kFields =
        std::make_tuple(field("base", &Tgc::base, Unit::Point, Check::Point),
                        field("height", &Tgc::height, Unit::Vector, Check::Vector),
                        field("axis_a", &Tgc::axis_a, Unit::Vector, Check::Point),
                        field("axis_b", &Tgc::axis_b, Unit::Vector, Check::Point),
                        field("axis_c", &Tgc::axis_c, Unit::Vector, Check::Point),
                        field("axis_d", &Tgc::axis_d, Unit::Vector, Check::Point),
                        optional_field("capped", &Tgc::capped, Unit::Flag, Check::None));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return capped; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

/// The first crossing (shapes/core/first_hit.h).
[[nodiscard]] bool first_hit(const Tgc& shape, const Ray& ray, ShapeHit& hit);

}  // namespace alhazen
