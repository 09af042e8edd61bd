#pragma once
/// The implicit equation of a Steiner patch, and its ray intersection.
///
/// Source: Sederberg and Anderson, "Ray Tracing of Steiner Patches", SIGGRAPH 1984 (the ray in the
/// implicit quartic, the parameters by inversion); Sederberg and Chen, "Implicitization using
/// moving curves and surfaces", SIGGRAPH 1995 (the quartic as a determinant).
/// Differs: the quartic is not expanded. It is det M(x, y, z, w) of two moving planes and a moving
/// quadric, all linear in the parameters (r, u, v), r = 1 - u - v, that vanish on the patch: M (r,
/// u, v) = 0. A surface with one base point has three moving planes: it is a cubic. Planar patches
/// and quadrics have more: `usable` is false. The roots are sign changes of the polynomial in
/// Bernstein form; the kernel of M gives their parameters, which Newton's method on the patch
/// refines.
/// Conventions: a root of even multiplicity (a tangent within rounding, or exactly on a double
/// line) is not reported. Crossings at the patch's border may be on either side. Hits are ascending
/// in t.
/// Complexity: construction takes some milliseconds; 2 kB.

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
    /// The value of the equation, up to a factor, in units of about the size of the patch.
    /// Precondition: usable.
    [[nodiscard]] double value(const Vec3& p) const;
    /// Writes the crossings, ascending. Precondition: usable.
    int crossings(const Ray& ray, ShapeHit* hits) const;

  private:
    struct Line;
    /// A moving plane, linear in (x, y, z, w): the four coefficients for each of r, u, v.
    using MovingPlane = std::array<std::array<double, 4>, 3>;
    /// A moving quadric: coefficients of x^2, xy, xz, xw, y^2, yz, yw, z^2, zw, w^2.
    using MovingQuadric = std::array<std::array<double, 10>, 3>;

    void make_planes();
    void make_quadric();
    void polynomial(const Line& line, std::array<double, 5>& f) const;
    [[nodiscard]] bool invert(const Vec3& p, double& u, double& v) const;
    [[nodiscard]] bool polish(const Line& line, double& u, double& v, double& along) const;

    int degree_ = 0;
    Vec3 center_;
    double scale_ = 1;
    std::array<HomogeneousPoint, 6> points_;  ///< relative to the centre, of size 1
    std::array<MovingPlane, 3> planes_{};     ///< the third only if the degree is 3
    MovingQuadric quadric_{};
};

}  // namespace alhazen
