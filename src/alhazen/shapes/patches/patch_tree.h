#pragma once
/// An acceleration structure over rational Bezier patches: the ray intersection of bezier_patch,
/// patch_mesh and nurbs_surface.
///
/// Source: Toth, "On Ray Tracing Parametric Surfaces", SIGGRAPH 1985; Barth and Stuerzlinger,
/// "Efficient Ray Tracing for Bezier and B-Spline Surfaces", 1993; see docs/design/patches.md.
/// Conventions: hits are ascending in t; part = `BezierPiece::part`, unique; u and v are mapped
/// from the unit square of the piece to [lo, hi]. Two crossings closer than rounding are both
/// reported or both omitted. A line through a border that two pieces share crosses exactly one of
/// them.
/// Complexity: O(log pieces) for a ray; at most 4 kB per bicubic piece.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/patches/patch_pieces.h"

namespace alhazen {

class PatchIndex;  // the leaves, and the boxes around them

class PatchTree {
  public:
    /// Precondition: parts ascend.
    explicit PatchTree(PatchPieces pieces);
    explicit PatchTree(const std::vector<BezierPiece>& pieces) : PatchTree(PatchPieces(pieces)) {}

    [[nodiscard]] const Box3& box() const { return box_; }
    /// The largest distance by which a crossing at a border may lie outside of its patch.
    [[nodiscard]] double reach() const { return reach_; }
    /// Range of dot(axis, p) over the control points, rounded outward.
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    /// Appends all crossings with the ray.
    void intersect(const Ray& ray, ShapeHits& hits) const;
    /// The first crossing; equal to the first of `intersect`.
    [[nodiscard]] bool first_hit(const Ray& ray, ShapeHit& hit) const;
    /// The first crossings of one to kMostPatchRays rays; returns the set of rays that hit.
    [[nodiscard]] std::uint32_t first_hits(std::span<const Ray* const> rays, ShapeHit* hits) const;
    /// The surface at a crossing, with its parameters as texture coordinates.
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

    [[nodiscard]] const PatchPieces& pieces() const { return pieces_; }
    [[nodiscard]] std::size_t bytes() const;

  private:
    PatchPieces pieces_;
    Box3 box_;
    double reach_ = 0;
    std::shared_ptr<const PatchIndex> index_;
};

}  // namespace alhazen
