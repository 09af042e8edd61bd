#pragma once
/// A two-sheet elliptic hyperboloid between two equal rims: two bowls, apex to apex.
///
/// Source: clipped_quadric.h: (1 - w^2) (x^2 + y^2) < z^2 - w^2 for z from -1 to 1, w = gap, in the
/// frame of the rims' semi-axes and half the vector from one rim to the other.
/// Conventions: part 0 the surface, 5 the end at `base`, 6 the end at `top`. u runs around from
/// `axis_a`, v from base (0) to top (1).

#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

struct TwoSheetHyperboloid {
    static constexpr const char* kName = "two_sheet_hyperboloid";
    static constexpr int kMaxHits = ClippedQuadric::kMaxHits;
    static constexpr bool kClosed = true;

    Vec3 base{0, 0, -1}, top{0, 0, 1};      ///< centres of the rims
    Vec3 axis_a{1, 0, 0}, axis_b{0, 1, 0};  ///< semi-axes of both rims
    double gap = 0.25;  ///< distance of the apices relative to that of the rims, in (0, 1)
    bool capped = true;
    ClippedQuadric solid{};  ///< derived

    static constexpr auto kFields = std::make_tuple(
        field("base", &TwoSheetHyperboloid::base, Unit::Point, Check::Point),
        field("top", &TwoSheetHyperboloid::top, Unit::Point, Check::Point),
        field("axis_a", &TwoSheetHyperboloid::axis_a, Unit::Vector, Check::Shape),
        field("axis_b", &TwoSheetHyperboloid::axis_b, Unit::Vector, Check::Shape),
        field("gap", &TwoSheetHyperboloid::gap, Unit::Number, Check::Shape),
        optional_field("capped", &TwoSheetHyperboloid::capped, Unit::Flag, Check::None));

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
