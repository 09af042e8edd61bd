#pragma once
/// A solid box with sides along the axes of its frame.
///
/// Source: Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs).
/// Differs: the sign of the direction selects the faces; a ray in the plane of a face is inside or
/// outside by `keeps_face`, so that it never has a single crossing.
/// Conventions: part = 0..5 for the faces -x +x -y +y -z +z. On each face v runs from 0 to 1 along
/// the higher of the other two axes, u along the lower one, from 0 to 1 on the high face and from 1
/// to 0 on the low one, as in the programs for which textured .ray scenes were made.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct BoxShape {
    static constexpr const char* kName = "box";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = true;

    Vec3 lo{-0.5, -0.5, -0.5};
    Vec3 hi{0.5, 0.5, 0.5};

    static constexpr auto kFields =
        std::make_tuple(field("lo", &BoxShape::lo, Unit::Point, Check::Point),
                        field("hi", &BoxShape::hi, Unit::Point, Check::Point));

    void prepare() {}
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
