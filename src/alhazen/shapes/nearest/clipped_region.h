#pragma once
/// The nearest point of a quadric, or of what it bounds, between planes.
///
/// Source: Gill, Murray and Wright, "Practical Optimization", 1981, section 3.4 (the conditions of
/// first order with inequalities: a nearest point is stationary on the face, the edge or the corner
/// that it lies on).
/// Differs: all these points are made (stationary_points.h) and the nearest one of those that the
/// planes leave is taken; none is followed from a start, which could end at another one.
/// Conventions: in space, relative to an origin of the caller's near the region. f(x) = x A x +
/// 2 b x + c, inside is f < 0. Without a quadric f is below 0 everywhere.
/// Complexity: O(planes^4); for a capped cylinder some ten microseconds. Threads: const functions
/// may be called from many.

#include <optional>
#include <vector>

#include "alhazen/math/affine.h"
#include "alhazen/shapes/nearest/stationary_points.h"

namespace alhazen {

struct PointOnSurface {
    Vec3 point;
    Vec3 normal;  ///< unit
    double squared = 0;
};

/// The nearer one of two, which may be none.
inline void keep_nearer(std::optional<PointOnSurface>& best, const PointOnSurface& found) {
    if (!best || found.squared < best->squared) best = found;
}

class ClippedRegion {
  public:
    /// normal x <= offset; the normal is unit.
    struct Plane {
        Vec3 normal;
        double offset = 0;
    };
    static constexpr std::size_t kMostPlanes = 24;

    ClippedRegion() = default;
    /// The surface f = 0 and, where `capped`, the parts of the planes with f <= 0. `apex`: a point
    /// of the surface where the gradient is 0, whether the planes leave it or not.
    ClippedRegion(const Eigensystem& a, const Vec3& b, double c, std::vector<Plane> planes,
                  bool capped, const std::optional<Vec3>& apex = {});
    /// A convex polyhedron.
    explicit ClippedRegion(std::vector<Plane> planes);

    /// None where the planes leave nothing.
    [[nodiscard]] std::optional<PointOnSurface> nearest(const Vec3& from) const;
    /// The nearest point of the curve f = 0 in a plane, whatever the other planes; the normal is
    /// that of the plane. Precondition, of `value` and `planes` too: no apex.
    [[nodiscard]] std::optional<PointOnSurface> nearest_in_plane(const Vec3& from,
                                                                 const Plane& plane) const;
    [[nodiscard]] double value(const Vec3& x) const;
    [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }
    [[nodiscard]] std::size_t bytes() const {
        return sizeof(*this) + planes_.capacity() * sizeof(Plane);
    }

  private:
    class Search;
    /// The curve in a plane, in coordinates from a point of the plane.
    struct Conic {
        DiagonalQuadric form;
        Vec3 origin, x_axis, y_axis;
    };
    /// Of f in a plane, x and y are two unit vectors of which at a right angle.
    [[nodiscard]] Eigensystem own_in(const Vec3& x, const Vec3& y) const;
    [[nodiscard]] Conic conic_in(const Plane& plane) const;
    void append_conic_points(const Plane& plane, const Vec3& from, std::vector<Vec3>& points) const;
    [[nodiscard]] Vec3 half_gradient(const Vec3& x) const {
        return axes_ * form_.half_gradient(transpose_times(axes_, x));
    }
    /// v A w.
    [[nodiscard]] double second(const Vec3& v, const Vec3& w) const {
        return dot(transpose_times(axes_, v), form_.a * transpose_times(axes_, w));
    }
    /// What the rounding of f, and of x, is a part of.
    [[nodiscard]] double magnitude(const Vec3& x) const;
    /// Steps to f = 0 along `gradient`, projected to the plane where there is one.
    [[nodiscard]] Vec3 onto_surface(Vec3 x, const Plane* plane) const;

    bool has_quadric_ = false, capped_ = true;
    DiagonalQuadric form_;  ///< along `axes_`: of slender ones other coordinates lose digits
    Mat3 axes_;
    std::vector<Plane> planes_;
    Vec3 origin_;          ///< of all of these, from the caller's: the apex where there is one
    double rounding_ = 0;  ///< the size of what the offsets were rounded from
    bool has_apex_ = false;
};

}  // namespace alhazen
