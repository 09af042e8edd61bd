#pragma once
/// A circular cylinder between two points, open or with caps.
///
/// Conventions: part 0 the side, 1 the cap at `base`, 2 the cap at `top`. u runs around the axis (0
/// to 1), v along it from `base` (0) to `top` (1); on caps v runs from the axis (0) to the rim (1).

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/quadrics/frustum.h"

namespace alhazen {

struct Cylinder {
    static constexpr const char* kName = "cylinder";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = true;

    Vec3 base{0, 0, 0};
    Vec3 top{0, 0, 1};
    double radius = 1;
    bool capped = true;
    Frustum frustum{};  ///< derived: set by prepare

    static constexpr auto kFields =
        std::make_tuple(field("base", &Cylinder::base, Unit::Point, Check::Point),
                        field("top", &Cylinder::top, Unit::Point, Check::Point),
                        field("radius", &Cylinder::radius, Unit::Length, Check::Length),
                        optional_field("capped", &Cylinder::capped, Unit::Flag, Check::None));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return capped; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
