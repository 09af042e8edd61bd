#pragma once
/// A cone or frustum: circles of two radii around the ends of an axis, open or with caps.
///
/// Conventions: radii >= 0, not both zero; equal radii make a cylinder. part and uv as in Cylinder.

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/quadrics/frustum.h"

namespace alhazen {

struct Cone {
    static constexpr const char* kName = "cone";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = true;

    Vec3 base{0, 0, 0};
    Vec3 top{0, 0, 1};
    double base_radius = 1;
    double top_radius = 0;
    bool capped = true;
    Frustum frustum{};  ///< derived: set by prepare

    static constexpr auto kFields =
        std::make_tuple(field("base", &Cone::base, Unit::Point, Check::Point),
                        field("top", &Cone::top, Unit::Point, Check::Point),
                        field("base_radius", &Cone::base_radius, Unit::Length, Check::LengthOrZero),
                        field("top_radius", &Cone::top_radius, Unit::Length, Check::LengthOrZero),
                        optional_field("capped", &Cone::capped, Unit::Flag, Check::None));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return capped; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
