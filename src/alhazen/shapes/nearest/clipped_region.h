#pragma once
/// The nearest point of a quadric, or of the solid that it bounds, clipped by planes.
///
/// Source: Gill, Murray and Wright, "Practical Optimization", 1981, section 3.4 (first-order
/// conditions with inequalities: a nearest point is stationary on the face, the edge or the corner
/// where it lies).
/// Differs: computes all stationary points (stationary_points.h) and takes the nearest one inside
/// the planes. No iteration from a starting point, which could end at a local minimum.
/// Conventions: world space, relative to an origin of the caller's near the region. f(x) = x A x +
/// 2 b x + c, inside is f < 0. Without a quadric f is negative everywhere.
/// Complexity: O(planes^4); some ten microseconds for a capped cylinder. Threads: const functions
/// may be called concurrently.

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

/// Replaces `best` if `found` is nearer or `best` is empty.
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
    /// The surface f = 0 and, if `capped`, the parts of the planes with f <= 0. `apex`: a point of
    /// the surface with gradient 0, inside the planes or not.
    ClippedRegion(const Eigensystem& a, const Vec3& b, double c, std::vector<Plane> planes,
                  bool capped, const std::optional<Vec3>& apex = {});
    /// A convex polyhedron.
    explicit ClippedRegion(std::vector<Plane> planes);

    /// Empty if the planes leave nothing.
    [[nodiscard]] std::optional<PointOnSurface> nearest(const Vec3& from) const;
    /// The nearest point of the curve f = 0 in a plane, regardless of the other planes; the normal
    /// is that of the plane. Precondition, also of `value` and `planes`: no apex.
    [[nodiscard]] std::optional<PointOnSurface> nearest_in_plane(const Vec3& from,
                                                                 const Plane& plane) const;
    [[nodiscard]] double value(const Vec3& x) const;
    [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }
    [[nodiscard]] std::size_t bytes() const {
        return sizeof(*this) + planes_.capacity() * sizeof(Plane);
    }

  private:
    class Search;
    /// The intersection curve with a plane, in coordinates relative to a point of the plane.
    struct Conic {
        DiagonalQuadric form;
        Vec3 origin, x_axis, y_axis;
    };
    /// Eigensystem of f in a plane spanned by the perpendicular unit vectors x and y.
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
    /// Magnitude to which the rounding of f and of x is relative.
    [[nodiscard]] double magnitude(const Vec3& x) const;
    /// Iterates to f = 0 along `gradient`, projected to `plane` if not null.
    [[nodiscard]] Vec3 onto_surface(Vec3 x, const Plane* plane) const;

    bool has_quadric_ = false, capped_ = true;
    DiagonalQuadric form_;  ///< along `axes_`: for slender quadrics other coordinates lose digits
    Mat3 axes_;
    std::vector<Plane> planes_;
    Vec3 origin_;          ///< relative to the caller's origin: the apex if there is one
    double rounding_ = 0;  ///< magnitude of the numbers from which the offsets were rounded
    bool has_apex_ = false;
};

}  // namespace alhazen
