#pragma once
/// A superellipsoid: (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) < 1 in the frame of three semi-axes.
///
/// Source: Barr, "Superquadrics and Angle-Preserving Transformations", IEEE CG&A 1(1), 1981; Kalra
/// and Barr, "Guaranteed Ray Intersections with Implicit Surfaces", SIGGRAPH 1989 (bounds of a
/// function and of its slope over an interval).
/// Differs: between the planes x = 0, y = 0 and z = 0 every term is monotone along the line, so
/// interval arithmetic is exact at the ends; where the slope has one sign the ends decide, else the
/// interval is halved. Where double cannot distinguish inside from outside, double-double does, on
/// the original ray.
/// Conventions: exponents of 1 make an ellipsoid, towards 0 a box, 2 an octahedron, above 2 a star.
/// u runs around `axis_c` from `axis_a` (0 to 1), v is the angle above its equator, from -axis_c
/// (0) to +axis_c (1). The surface is defined by the stored frame, p and q. A line that grazes
/// within 2^-92 (p + q) of the function's value 1, or is inside for less than 2^-48 of its length,
/// may be reported as a miss or with both crossings.

#include "alhazen/shapes/core/solid_frame.h"

namespace alhazen {

struct Superellipsoid {
    static constexpr const char* kName = "superellipsoid";
    static constexpr int kMaxHits = 16;
    static constexpr bool kClosed = true;

    Vec3 center{0, 0, 0};
    Vec3 axis_a{1, 0, 0}, axis_b{0, 1, 0}, axis_c{0, 0, 1};  ///< from the centre to the surface
    double east = 1;      ///< e: exponent of the equator and the cross-sections parallel to it
    double north = 1;     ///< n: exponent of the sections through axis_c
    SolidFrame frame{};   ///< derived
    double p = 2, q = 2;  ///< derived: 2 / e and 2 / n

    static constexpr auto kFields =
        std::make_tuple(field("center", &Superellipsoid::center, Unit::Point, Check::Point),
                        field("axis_a", &Superellipsoid::axis_a, Unit::Vector, Check::Shape),
                        field("axis_b", &Superellipsoid::axis_b, Unit::Vector, Check::Shape),
                        field("axis_c", &Superellipsoid::axis_c, Unit::Vector, Check::Shape),
                        field("east", &Superellipsoid::east, Unit::Number, Check::Shape),
                        field("north", &Superellipsoid::north, Unit::Number, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
