#pragma once
/// The implicit equation of a Steiner patch, and crossings with a ray by it.
///
/// Source: Sederberg and Anderson, "Ray Tracing of Steiner Patches", SIGGRAPH 1984 (the ray in the
/// implicit quartic, the parameters by inversion); Sederberg and Chen, "Implicitization using
/// moving curves and surfaces", SIGGRAPH 1995 (the quartic as a determinant).
/// Differs: the quartic is not expanded. It is det M(x, y, z, w) of two moving planes and a moving
/// quadric, all three linear in the parameters (r, u, v), r = 1 - u - v, that vanish on the patch:
/// M (r, u, v) = 0. A surface with one base point has three moving planes: it is a cubic. Planar
/// patches and quadrics have more: `usable` is false. The roots are sign changes of the polynomial
/// in Bernstein form; the kernel of M inverts them; Newton's method on the patch polishes them.
/// Conventions: a root of even multiplicity (tangent to rounding, exactly on a double line) counts
/// as none. Crossings on the patch's border may be on either side. Hits are ascending in t.
/// Complexity: made in some milliseconds; 2 kB.

#include <array>

#include "alhazen/shapes/patches/steiner_patch.h"

namespace alhazen {

class SteinerImplicit {
  public:
    static constexpr int kMaxHits = 4;

    /// Precondition: valid.
    explicit SteinerImplicit(const SteinerPatch& patch);

    [[nodiscard]] bool usable() const { return degree_ != 0; }
    /// 4, 3 with a base point, 0 if not usable.
    [[nodiscard]] int degree() const { return degree_; }
    /// The equation, up to a factor, of about 1 in the size of the patch. Precondition: usable.
    [[nodiscard]] double value(const Vec3& p) const;
    /// Precondition: usable.
    int crossings(const Ray& ray, ShapeHit* hits) const;

  private:
    struct Line;
    /// Linear in (x, y, z, w): for each of r, u, v its four coefficients.
    using MovingPlane = std::array<std::array<double, 4>, 3>;
    /// Quadratic: x^2, xy, xz, xw, y^2, yz, yw, z^2, zw, w^2.
    using MovingQuadric = std::array<std::array<double, 10>, 3>;

    void make_planes();
    void make_quadric();
    void polynomial(const Line& line, std::array<double, 5>& f) const;
    [[nodiscard]] bool invert(const Vec3& p, double& u, double& v) const;
    [[nodiscard]] bool polish(const Line& line, double& u, double& v, double& along) const;

    int degree_ = 0;
    Vec3 center_;
    double scale_ = 1;
    std::array<HomogeneousPoint, 6> points_;  ///< about the centre, of size 1
    std::array<MovingPlane, 3> planes_{};     ///< the third one if the degree is 3
    MovingQuadric quadric_{};
};

}  // namespace alhazen
