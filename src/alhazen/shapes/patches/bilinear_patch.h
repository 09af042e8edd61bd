#pragma once
/// The bilinear patch of four points: (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11.
///
/// Source: Reshetov, "Cool Patches: A Geometric Approach to Ray/Bilinear Patch Intersections", Ray
/// Tracing Gems, 2019, chapter 8 (GARP: the rulings that the ray meets are the roots of a quadratic
/// of triple products); the shear and the signs of edges: geometry/watertight_triangle.h.
/// Differs: (1) Triple products with the ray are edge functions in the sheared plane. (2) The
/// quadratic is in Bernstein form with homogeneous roots: a linear equation is no special case.
/// (3) The number of crossings follows from the winding number of the four edges around the ray,
/// an exact sign, not from the rounded parameters. (4) A step of Newton's method on the patch.
/// Conventions: part = 0; u and v of a hit are its texture coordinates. The normal is along du x
/// dv. Coincident corners are allowed. The ray is displaced symbolically by (e, e^2), e -> 0, as
/// for triangles. It crosses the patch an odd number of times, which is once, if the edges wind
/// around it, else twice or not at all. An edge counts by its two ends alone; hence a line never
/// leaks between bilinear patches, or patches and triangles, that share an edge or a corner bit for
/// bit, and crosses a closed mesh of them evenly. A ray in the plane of a planar patch, and a patch
/// whose points lie on a line within rounding: no crossing; for the latter nothing is promised
/// about its neighbours. A ray along a ruling crosses at one of its points, at two, or not at all.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct BilinearPatch {
    static constexpr const char* kName = "bilinear_patch";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = false;

    Vec3 p00{0, 0, 0}, p10{1, 0, 0}, p01{0, 1, 0}, p11{1, 1, 0};

    bool is_line = false;  ///< derived: within rounding

    static constexpr auto kFields =
        std::make_tuple(field("p00", &BilinearPatch::p00, Unit::Point, Check::Point),
                        field("p10", &BilinearPatch::p10, Unit::Point, Check::Point),
                        field("p01", &BilinearPatch::p01, Unit::Point, Check::Point),
                        field("p11", &BilinearPatch::p11, Unit::Point, Check::Point));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
