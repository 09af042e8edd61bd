#pragma once
/// The kernel of cylinder and cone: a circular solid whose radius is linear along its axis.
///
/// Source: quadric by substitution, with the discriminant as a difference of two lengths
/// (Lagrange's identity), second root from the product of the roots (Vieta); Kay and Kajiya,
/// SIGGRAPH 1986 (intersection of intervals).
/// Differs: the solid is the intersection of one interval of the infinite quadric with one of the
/// slab between the caps, so a line crosses its surface twice or not at all by construction, rims
/// and apex included. A line that starts far away is first shifted to its point nearest the shape.
/// Conventions: part 0 the side, 1 the cap at `base`, 2 the cap at `top`. u runs around the axis, v
/// along it from `base`; on caps v runs from the axis (0) to the rim (1). A line in a cap's plane
/// is inside or outside by `keeps_face`, one along the side of a cylinder is outside. Open ends: a
/// crossing of the side belongs to the half-open range [base, top). Crossings are within rounding
/// of the box, however flat the frustum is.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct Frustum {
    Vec3 base{0, 0, 0}, top{0, 0, 1};
    double base_radius = 1, top_radius = 1;
    Vec3 center{0, 0, 0.5};                 ///< middle of the axis
    Vec3 axis{0, 0, 1};                     ///< unit, from base to top
    Vec3 x_axis{1, 0, 0}, y_axis{0, 1, 0};  ///< unit, perpendicular to the axis
    double half_height = 0.5;
    double middle_radius = 1;
    double slope = 0;                       ///< radius = middle_radius + slope * height
    double bounding_radius_squared = 1.25;  ///< around `center`

    Frustum() = default;
    Frustum(const Vec3& base, const Vec3& top, double base_radius, double top_radius);

    /// True if rounding of heights moves crossings of the side by more than rounding of the radius:
    /// they are then kept in the cylinder around the frustum.
    [[nodiscard]] bool is_flat() const { return std::abs(slope) > 1e3; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& direction) const;
    /// Crossings of the solid's surface, or of the side alone when not `capped`.
    int intersect(const Ray& ray, bool capped, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

  private:
    [[nodiscard]] ShapeSurface side_surface(const Vec3& from_center) const;
    [[nodiscard]] ShapeSurface cap_surface(const Vec3& p, bool at_top) const;
    [[nodiscard]] double turn(const Vec3& across) const;
};

}  // namespace alhazen
