#pragma once
/// An ellipsoid with any three semi-axes, not necessarily perpendicular.
///
/// Source: clipped_quadric.h: the unit sphere in the frame of the semi-axes.
/// Conventions: u runs around `axis_c` from `axis_a` (0 to 1), v from -axis_c (0) to +axis_c (1).

#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

struct Ellipsoid {
    static constexpr const char* kName = "ellipsoid";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = true;

    Vec3 center{0, 0, 0};
    Vec3 axis_a{1, 0, 0}, axis_b{0, 1, 0}, axis_c{0, 0, 1};  ///< from the centre to the surface
    ClippedQuadric solid{};                                  ///< derived

    static constexpr auto kFields =
        std::make_tuple(field("center", &Ellipsoid::center, Unit::Point, Check::Point),
                        field("axis_a", &Ellipsoid::axis_a, Unit::Vector, Check::Shape),
                        field("axis_b", &Ellipsoid::axis_b, Unit::Vector, Check::Shape),
                        field("axis_c", &Ellipsoid::axis_c, Unit::Vector, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

/// Reports axes that are zero or nearly coplanar.
void check_axes(FieldChecks& checks, const Mat3& axes, const char* x, const char* y, const char* z);

}  // namespace alhazen
