#pragma once
/// A general quadric, f < 0 for a polynomial f of degree 2 with ten coefficients, unclipped or
/// clipped by a box and by planes, with or without caps.
///
/// Source: clipped_quadric.h.
/// Conventions: part 0 the quadric, 1 to 6 the faces -x +x -y +y -z +z of the box, 7 and above the
/// planes. u runs around the z axis from +x (0 to 1), v is the angle above the xy plane, from -z
/// (0) to +z (1). Normals point along the gradient. Without bounds it is an unbounded solid.

#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

struct Quadric {
    static constexpr const char* kName = "quadric";
    static constexpr int kMaxHits = ClippedQuadric::kMaxHits;
    static constexpr bool kClosed = true;

    Vec3 squares{1, 1, 1};   ///< coefficients of x^2, y^2, z^2
    Vec3 products{0, 0, 0};  ///< coefficients of x y, y z, z x
    Vec3 linear{0, 0, 0};    ///< coefficients of x, y, z
    double constant = -1;
    Box3 clip_box{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
    std::vector<ClipPlane> clip_planes;  ///< cut off the side that their normals point to
    bool capped = true;
    ClippedQuadric solid{};  ///< derived

    static constexpr auto kFields = std::make_tuple(
        field("squares", &Quadric::squares, Unit::Number, Check::Point),
        field("products", &Quadric::products, Unit::Number, Check::Point),
        field("linear", &Quadric::linear, Unit::Number, Check::Point),
        field("constant", &Quadric::constant, Unit::Number, Check::Shape),
        optional_field("clip_box", &Quadric::clip_box, Unit::Compound, Check::Shape),
        optional_field("clip_planes", &Quadric::clip_planes, Unit::Compound, Check::Shape),
        optional_field("capped", &Quadric::capped, Unit::Flag, Check::None));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return capped; }
    [[nodiscard]] Box3 box() const { return clip_box; }
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const { return solid.intersect(ray, hits); }
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const {
        return solid.surface(ray, hit);
    }
    [[nodiscard]] bool inside_at_minus_infinity(const Ray& ray) const {
        return capped && solid.inside_at_minus_infinity(ray);
    }
};

}  // namespace alhazen
