#pragma once
/// The bilinear patch of four points: (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11.
///
/// Source: Reshetov, "Cool Patches: A Geometric Approach to Ray/Bilinear Patch Intersections", Ray
/// Tracing Gems, 2019, chapter 8 (GARP).
/// Conventions: part = 0; u and v of a hit are its texture coordinates. The normal is along du x
/// dv.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct BilinearPatch {
    static constexpr const char* kName = "bilinear_patch";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = false;

    Vec3 p00{0, 0, 0}, p10{1, 0, 0}, p01{0, 1, 0}, p11{1, 1, 0};

    static constexpr auto kFields =
        std::make_tuple(field("p00", &BilinearPatch::p00, Unit::Point, Check::Point),
                        field("p10", &BilinearPatch::p10, Unit::Point, Check::Point),
                        field("p01", &BilinearPatch::p01, Unit::Point, Check::Point),
                        field("p11", &BilinearPatch::p11, Unit::Point, Check::Point));

    void prepare() {}
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
