#pragma once
/// A quadric, and the parameters where a line enters and leaves it.
///
/// Source: Kahan, "On the Cost of Floating-Point Computation Without Extra-Precise Arithmetic",
/// 2004 (discriminant and roots); the origin is shifted along the line as by Haines, Günther and
/// Akenine-Möller, Ray Tracing Gems, 2019, ch. 7.
/// Differs: every step carries its error bound; where the sign of the discriminant or the last
/// digits of t are uncertain, the computation is repeated in double-double, from the original ray.
/// Conventions: inside is f < 0; a tangent is no crossing. Roots are within 2 ulp of t plus 2^-41
/// of the solid's size, usually far better.

#include "alhazen/shapes/core/solid_frame.h"

namespace alhazen {

/// f(p) = xx x^2 + yy y^2 + zz z^2 + 2 (xy x y + yz y z + zx z x) + 2 (x x + y y + z z) + c.
struct QuadricForm {
    double xx = 1, yy = 1, zz = 1, xy = 0, yz = 0, zx = 0, x = 0, y = 0, z = 0, c = -1;

    /// Half the gradient without its constant part.
    template <class Real>
    [[nodiscard]] Point3<Real> times(const Point3<Real>& p) const {
        return {Real(xx) * p.x + Real(xy) * p.y + Real(zx) * p.z,
                Real(xy) * p.x + Real(yy) * p.y + Real(yz) * p.z,
                Real(zx) * p.x + Real(yz) * p.y + Real(zz) * p.z};
    }
    template <class Real>
    [[nodiscard]] Real value(const Point3<Real>& p) const {
        const Point3<Real> half = times(p);
        return (half.x + Real(2.0 * x)) * p.x + (half.y + Real(2.0 * y)) * p.y +
               (half.z + Real(2.0 * z)) * p.z + Real(c);
    }
    [[nodiscard]] Vec3 gradient(const Vec3& p) const {
        const Point3<double> half = times(Point3<double>{p.x, p.y, p.z});
        return 2.0 * Vec3{half.x + x, half.y + y, half.z + z};
    }
    friend bool operator==(const QuadricForm&, const QuadricForm&) = default;
};

/// Where a line changes sides: count 0, 1 or 2, ascending; `inside_first` at t = -infinity.
struct QuadricSpans {
    int count = 0;
    bool inside_first = false;
    double t[2]{};
};

/// The quadric with the norms for its error bounds.
class QuadricLine {
  public:
    QuadricLine() = default;
    /// `size`: approximate radius of the solid around the frame's origin, in the frame's units;
    /// lines are shifted to within it.
    QuadricLine(const QuadricForm& form, double size);

    [[nodiscard]] QuadricSpans spans(const SolidFrame& frame, const Ray& ray) const;
    [[nodiscard]] const QuadricForm& form() const { return form_; }

  private:
    [[nodiscard]] bool fast_spans(const SolidFrame& frame, const Ray& ray, QuadricSpans& s) const;
    [[nodiscard]] QuadricSpans precise_spans(const SolidFrame& frame, const Ray& ray) const;

    QuadricForm form_;
    double second_norm_ = 1;  ///< upper bound of the eigenvalues of the second-order part
    double first_norm_ = 0;   ///< length of (x, y, z)
    double size_ = 1;
};

}  // namespace alhazen
