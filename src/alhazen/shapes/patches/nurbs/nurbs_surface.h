#pragma once
/// A NURBS surface with trimming loops, stored as its exact rational Bezier pieces.
///
/// Source: Piegl and Tiller, "The NURBS Book", 2nd ed., Springer, 1997, chapters 4 and 5 (knot
/// insertion, decomposition); Martin, Cohen, Fish and Shirley, "Practical Ray Tracing of Trimmed
/// NURBS Surfaces", Journal of Graphics Tools 5(1), 2000 (trimming by parity in the parameter
/// plane).
/// Conventions: control points are u-major: [i * n + j] with n = knots_v.size() - degree_v - 1. The
/// domain is [knots[degree], knots[size - degree - 1]] in each direction. u and v of a hit are
/// parameters in the domain; texture coordinates are these mapped to [0, 1]. part = Bezier piece.
/// The kept part is the odd-even region of the trimming loops (trim_region.h); without loops it is
/// the whole surface. A loop along the border of the domain keeps the border.

#include <memory>

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

/// A part of a trimming loop in the parameter plane: a rational B-spline curve; without knots a
/// polyline if the degree is 1, else one Bezier curve of degree points.size() - 1.
struct TrimCurve {
    std::uint32_t degree = 1;
    std::vector<double> knots{};
    std::vector<Vec2> points{};
    std::vector<double> weights{};  ///< one for each point, positive; empty: all 1
    friend bool operator==(const TrimCurve&, const TrimCurve&) = default;
};
/// Consecutive curves; the last one ends where the first begins.
using TrimLoop = std::vector<TrimCurve>;

class TrimRegion;

struct NurbsSurface {
    static constexpr const char* kName = "nurbs_surface";
    static constexpr int kMaxHits = kManyHits;
    static constexpr bool kClosed = false;

    std::uint32_t degree_u = 3, degree_v = 3;  ///< 1 to 7
    std::vector<double> knots_u{}, knots_v{};  ///< ascending
    std::vector<Vec3> points{};
    std::vector<double> weights{};  ///< one for each point, positive; empty: all 1
    std::vector<TrimLoop> trims{};

    std::shared_ptr<const PatchTree> tree{};     ///< derived
    std::shared_ptr<const TrimRegion> region{};  ///< derived; null without loops

    static constexpr auto kFields = std::make_tuple(
        optional_field("degree_u", &NurbsSurface::degree_u, Unit::Count, Check::Shape),
        optional_field("degree_v", &NurbsSurface::degree_v, Unit::Count, Check::Shape),
        field("knots_u", &NurbsSurface::knots_u, Unit::Compound, Check::Shape),
        field("knots_v", &NurbsSurface::knots_v, Unit::Compound, Check::Shape),
        field("points", &NurbsSurface::points, Unit::Compound, Check::Shape),
        optional_field("weights", &NurbsSurface::weights, Unit::Compound, Check::Shape),
        optional_field("trims", &NurbsSurface::trims, Unit::Compound, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const { return tree->box(); }
    [[nodiscard]] Interval extent(const Vec3& axis) const { return tree->extent(axis); }
    void intersect(const Ray& ray, ShapeHits& hits) const;
    /// True if the point lies in the kept part.
    [[nodiscard]] bool keeps(const ShapeHit& hit) const;
    /// The same for texture coordinates.
    [[nodiscard]] bool keeps_uv(const Vec2& uv) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

[[nodiscard]] bool first_hit(const NurbsSurface& shape, const Ray& ray, ShapeHit& hit);

}  // namespace alhazen
