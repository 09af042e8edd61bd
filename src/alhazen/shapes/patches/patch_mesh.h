#pragma once
/// Bezier patches of one degree over shared control points.
///
/// Source: Newell, "The Utilization of Procedure Models in Digital Image Synthesis", PhD thesis,
/// University of Utah, 1975 (the teapot); the crossings: patch_tree.h.
/// Conventions: `patches` lists for each patch its (degree_u + 1) * (degree_v + 1) control points,
/// u-major, as indices into `points`. Two patches share a boundary curve if its control points are
/// equal (positions and weights, not indices). A mesh is closed if every boundary curve that is
/// more than a point is shared by an even number of patches: it is then a solid, crossed an even
/// number of times by every line, with normals outward. part = patch; u and v of a hit are those of
/// the patch, and its texture coordinates. Complexity: O(log patches) for a ray; memory: see
/// patch_tree.h.

#include <memory>

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/patches/bezier_net.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

struct PatchMesh {
    static constexpr const char* kName = "patch_mesh";
    static constexpr int kMaxHits = kManyHits;
    static constexpr bool kClosed = true;

    std::uint32_t degree_u = 3, degree_v = 3;
    std::vector<Vec3> points{};
    std::vector<double> weights{};         ///< one for each point, positive; empty: all 1
    std::vector<std::uint32_t> patches{};  ///< [patch][control point, u-major]

    std::shared_ptr<const PatchTree> tree{};  ///< derived
    bool is_closed = false;                   ///< derived
    std::vector<bool>
        inward{};  ///< derived, for closed meshes: patches whose du x dv points inward

    static constexpr auto kFields = std::make_tuple(
        optional_field("degree_u", &PatchMesh::degree_u, Unit::Count, Check::Shape),
        optional_field("degree_v", &PatchMesh::degree_v, Unit::Count, Check::Shape),
        field("points", &PatchMesh::points, Unit::Compound, Check::Shape),
        optional_field("weights", &PatchMesh::weights, Unit::Compound, Check::Shape),
        field("patches", &PatchMesh::patches, Unit::Compound, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    /// Also valid for a mesh that is not prepared; false for an invalid one.
    [[nodiscard]] bool closed() const;
    [[nodiscard]] Box3 box() const { return tree->box(); }
    [[nodiscard]] Interval extent(const Vec3& axis) const { return tree->extent(axis); }
    void intersect(const Ray& ray, ShapeHits& hits) const { tree->intersect(ray, hits); }
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

    /// Number of patches, and each patch as a net. Precondition: valid.
    [[nodiscard]] std::size_t patch_count() const;
    [[nodiscard]] BezierNet net(std::size_t patch) const;
};

[[nodiscard]] inline bool first_hit(const PatchMesh& shape, const Ray& ray, ShapeHit& hit) {
    return shape.tree->first_hit(ray, hit);
}
[[nodiscard]] inline std::uint32_t first_hits(const PatchMesh& shape,
                                              std::span<const Ray* const> rays, ShapeHit* hits) {
    return shape.tree->first_hits(rays, hits);
}

/// Area, and flux volume: the enclosed volume if the mesh is closed.
[[nodiscard]] PatchMeasures measures_of(const PatchMesh& mesh);

}  // namespace alhazen
