#pragma once
/// Triangles and rectangles as seen from a point, with directions sampled uniformly by solid angle.
///
/// Source: Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed.
/// Eng. 30(2), 1983; Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995; Urena,
/// Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013.
/// Differs: the sine and cosine of the angle of a triangle come from the products of its corners.
/// The solid angle of a rectangle is the angle of a product of complex numbers, one for each
/// corner: that of the part between x = 0 and a corner (x, y) is the angle of (distance, x y), in
/// units of the height. Its sine and cosine, not those of the angles at the corners, determine a
/// point.
/// Conventions: corners are relative to the point of view; `solid_angle` is 0 for degenerate
/// polygons and those seen edge on; its error is about 1e-15. Solid angles below about 1e-6 should
/// be sampled by area. Either side may face the point.
/// Threads: const functions may be called from many.

#include <array>

#include "alhazen/math/vec.h"

namespace alhazen {

class SphericalTriangle {
  public:
    SphericalTriangle(const Vec3& a, const Vec3& b, const Vec3& c);

    [[nodiscard]] double solid_angle() const { return solid_angle_; }
    /// A unit direction for `u` in the unit square. The solid angle must be above 0.
    [[nodiscard]] Vec3 direction(const Vec2& u) const;

  private:
    std::array<Vec3, 3> corners_;      ///< unit
    double ab_ = 0, bc_ = 0, ca_ = 0;  ///< dot products of corners
    double triple_ = 0, solid_angle_ = 0;
};

/// Axes and lengths of a rectangle, independent of the point of view.
struct RectangleSides {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< unit: along the edges, normal
    double width = 1, height = 1;

    /// The edges must be perpendicular.
    [[nodiscard]] static RectangleSides of(const Vec3& edge_u, const Vec3& edge_v);
};

class SphericalRectangle {
  public:
    SphericalRectangle(const Vec3& corner, const RectangleSides& sides);

    [[nodiscard]] double solid_angle() const { return solid_angle_; }
    /// The point for `u` in the unit square, relative to the point of view.
    [[nodiscard]] Vec3 point(const Vec2& u) const;

    /// Instead of squares that vanish by rounding.
    static constexpr double kTiny = 1e-300;

  private:
    Vec3 x_, y_, z_;                 ///< unit; the rectangle is in the plane z = z0 < 0
    double x0_, x1_, y0_, y1_, z0_;  ///< of the rectangle
    Vec2 start_;  ///< cosine and sine of the solid angle from x = 0 to x0; negative for x0 < 0
    /// In units of the height: distances of the points (0, y0) and (0, y1), and each times the
    /// other y.
    double w0_ = 0, w1_ = 0, w0_y1_ = 0, w1_y0_ = 0;
    double solid_angle_ = 0;
};

}  // namespace alhazen
