#pragma once
/// A flat parallelogram: corner + u * edge_u + v * edge_v, u and v in [0, 1].
///
/// Conventions: the normal is along edge_u x edge_v; uv are the edge parameters. Both sides are
/// hit.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct Rectangle {
    static constexpr const char* kName = "rectangle";
    static constexpr int kMaxHits = 1;
    static constexpr bool kClosed = false;

    Vec3 corner{-0.5, -0.5, 0};
    Vec3 edge_u{1, 0, 0};
    Vec3 edge_v{0, 1, 0};
    Vec3 unit_normal{0, 0, 1};  ///< derived: set by prepare
    Vec3 u_of{1, 0, 0};         ///< derived: u = dot(u_of, p - corner) on the plane
    Vec3 v_of{0, 1, 0};         ///< derived: the same for v

    static constexpr auto kFields =
        std::make_tuple(field("corner", &Rectangle::corner, Unit::Point, Check::Point),
                        field("edge_u", &Rectangle::edge_u, Unit::Vector, Check::Vector),
                        field("edge_v", &Rectangle::edge_v, Unit::Vector, Check::Vector));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
