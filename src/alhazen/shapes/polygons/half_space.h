#pragma once
/// All space on one side of a plane: an unbounded solid.
///
/// Source: Roth, "Ray Casting for Modeling Solids", Computer Graphics and Image Processing 18,
/// 1982.
/// Conventions: `normal` points out of the solid and need not be unit. uv are coordinates along two
/// unit vectors in the plane from `point`, as for `plane`. A line in the plane is inside or
/// outside by `keeps_face`, and has no crossing.

#include "alhazen/shapes/polygons/plane.h"

namespace alhazen {

struct HalfSpace {
    static constexpr const char* kName = "half_space";
    static constexpr int kMaxHits = 1;
    static constexpr bool kClosed = true;

    Vec3 point{0, 0, 0};
    Vec3 normal{0, 0, 1};
    Plane face{};  ///< derived: set by prepare

    static constexpr auto kFields =
        std::make_tuple(field("point", &HalfSpace::point, Unit::Point, Check::Point),
                        field("normal", &HalfSpace::normal, Unit::Direction, Check::Vector));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
    [[nodiscard]] bool inside_at_minus_infinity(const Ray& ray) const;
};

}  // namespace alhazen
