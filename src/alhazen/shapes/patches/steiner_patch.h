#pragma once
/// A Steiner patch: a rational quadratic Bezier triangle.
///
/// Source: Sederberg and Anderson, "Ray Tracing of Steiner Patches", SIGGRAPH 1984; the crossings
/// by its implicit quartic: steiner_implicit.h.
/// Differs: `intersect` finds the crossings of the same surface as a rational patch of degree 2 by
/// 2 (patch_tree.h), with certainty: no crossing is missed near the patch's double lines, folds and
/// borders, and planar patches and quadrics, which have no quartic, are covered.
/// Conventions: points and weights in the order 200, 110, 020, 101, 011, 002 of the exponents of
/// (1-u-v), u, v; so that (u, v) = (0, 0) is the first, (1, 0) the third and (0, 1) the last point.
/// part = 0; u and v of a hit are its texture coordinates. The normal is along du x dv. A line in
/// the surface crosses it at most four times.

#include <memory>

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

class PatchTree;

struct SteinerPatch {
    static constexpr const char* kName = "steiner_patch";
    static constexpr int kMaxHits = 4;
    static constexpr bool kClosed = false;

    std::vector<Vec3> points{};     ///< 6
    std::vector<double> weights{};  ///< 6, positive; empty: all 1

    std::shared_ptr<const PatchTree> tree{};  ///< derived: over (s, t), u = s (1 - t), v = t
    Box3 bounds{};                            ///< derived: of the control points

    static constexpr auto kFields = std::make_tuple(
        field("points", &SteinerPatch::points, Unit::Compound, Check::Shape),
        optional_field("weights", &SteinerPatch::weights, Unit::Compound, Check::Shape));

    /// As a patch of degree 2 by 2 whose edge v = 1 is a point: (s, t) -> (s (1 - t), t).
    [[nodiscard]] BezierNet net() const;
    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const { return bounds; }
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

    /// The control points with their weights. Precondition: valid.
    [[nodiscard]] std::array<HomogeneousPoint, 6> control_points() const;
};

[[nodiscard]] bool first_hit(const SteinerPatch& shape, const Ray& ray, ShapeHit& hit);

/// The point of a quadratic triangle with its derivatives by u and v, homogeneous.
struct SteinerValue {
    HomogeneousPoint s, s_u, s_v;
};
[[nodiscard]] SteinerValue steiner_value(const std::array<HomogeneousPoint, 6>& points, double u,
                                         double v);

}  // namespace alhazen
