#pragma once
/// Rational Bezier patches prepared for rays: the crossings of bezier_patch, patch_mesh and
/// nurbs_surface.
///
/// Conventions: hits are ascending in t; part = `BezierPiece::part`, u and v are mapped from the
/// unit square of the piece to [lo, hi].

#include <memory>
#include <span>
#include <vector>

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// One rational Bezier patch of a surface.
struct BezierPiece {
    BezierNet net;
    std::uint32_t part = 0;
    Vec2 lo{0, 0}, hi{1, 1};  ///< the surface's parameters at the corners of the piece
};

class PatchTree {
  public:
    explicit PatchTree(std::vector<BezierPiece> pieces);

    [[nodiscard]] const Box3& box() const { return box_; }
    /// Range of dot(axis, p) over the control points, rounded outward.
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    /// Appends all crossings with the ray.
    void intersect(const Ray& ray, ShapeHits& hits) const;
    /// The surface at a crossing, with its parameters as texture coordinates.
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

    [[nodiscard]] std::span<const BezierPiece> pieces() const { return pieces_; }
    [[nodiscard]] std::size_t bytes() const;

  private:
    std::vector<BezierPiece> pieces_;
    Box3 box_;
};

}  // namespace alhazen
