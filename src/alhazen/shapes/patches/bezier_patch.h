#pragma once
/// A Bezier patch of degree 1 to 7 in each direction, rational or not.
///
/// Source: see bezier_net.h; the crossings: patch_tree.h.
/// Conventions: control points are u-major. part = 0; u and v of a hit are those of the patch, and
/// its texture coordinates. The normal is along du x dv.

#include <memory>
#include <string>

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/patches/bezier_net.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

struct BezierPatch {
    static constexpr const char* kName = "bezier_patch";
    static constexpr int kMaxHits = kManyHits;
    static constexpr bool kClosed = false;

    std::uint32_t degree_u = 3, degree_v = 3;
    std::vector<Vec3> points{};     ///< (degree_u + 1) * (degree_v + 1), u-major
    std::vector<double> weights{};  ///< one for each point, positive; empty: all 1

    std::shared_ptr<const PatchTree> tree{};  ///< derived

    static constexpr auto kFields = std::make_tuple(
        optional_field("degree_u", &BezierPatch::degree_u, Unit::Count, Check::Shape),
        optional_field("degree_v", &BezierPatch::degree_v, Unit::Count, Check::Shape),
        field("points", &BezierPatch::points, Unit::Compound, Check::Shape),
        optional_field("weights", &BezierPatch::weights, Unit::Compound, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const { return tree->box(); }
    [[nodiscard]] Interval extent(const Vec3& axis) const { return tree->extent(axis); }
    void intersect(const Ray& ray, ShapeHits& hits) const { tree->intersect(ray, hits); }
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

    /// The patch as a net. Precondition: valid.
    [[nodiscard]] BezierNet net() const;
};

[[nodiscard]] inline bool first_hit(const BezierPatch& shape, const Ray& ray, ShapeHit& hit) {
    return shape.tree->first_hit(ray, hit);
}
[[nodiscard]] inline std::uint32_t first_hits(const BezierPatch& shape,
                                              std::span<const Ray* const> rays, ShapeHit* hits) {
    return shape.tree->first_hits(rays, hits);
}

}  // namespace alhazen
