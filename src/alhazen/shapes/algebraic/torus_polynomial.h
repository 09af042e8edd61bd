#pragma once
/// The quartic of a torus whose circle has radius 1.
///
/// Source: see torus.h.
/// Conventions: internal to this folder.

#include <cmath>
#include <type_traits>

#include "alhazen/shapes/core/solid_frame.h"

namespace alhazen {

#include "alhazen/shapes/algebraic/torus_formula-inl.h"

/// Ratio of the clip to the torus; the ends of the clipped line are certainly outside.
inline constexpr double kTorusRoom = 1.0 + 1.0 / 64;

/// 1 / 3.
template <class Real>
Real third() {
    if constexpr (std::is_same_v<Real, double>) {
        return 1.0 / 3.0;
    } else {
        return DoubleDouble(1.0 / 3.0, 0x1.5555555555555p-56);
    }
}

/// (x^2 + y^2 + z^2 + k)^2 - 4 (x^2 + y^2), k = 1 - r^2.
struct TorusPolynomial {
    static constexpr int kDegree = 4;
    double r;

    template <class Real>
    [[nodiscard]] Real k() const {
        return (Real(1.0) - Real(r)) * (Real(1.0) + Real(r));
    }
    template <class Real>
    int coefficients(const Point3<Real>& p, const Point3<Real>& q, Real* b) const {
        torus_coefficients(p, q, k<Real>(), third<Real>(), b);
        return 4;
    }
    template <class Real>
    [[nodiscard]] Real value(const Point3<Real>& p) const {
        const Real across = p.x * p.x + p.y * p.y;
        const Real a = across + p.z * p.z + k<Real>();
        return a * a - Real(4.0) * across;
    }
    [[nodiscard]] Vec3 gradient(const Vec3& p) const {
        // Gradient of the squared distance to the circle, scaled to that of the quartic.
        const double across = std::hypot(p.x, p.y);
        if (!(across > 0.0)) return {0.0, 0.0, 4.0 * p.z * (p.z * p.z + k<double>())};
        const double radial = (across - 1.0) / across;
        const double other = (across + 1.0) * (across + 1.0) + p.z * p.z - r * r;
        const double own = (across - 1.0) * (across - 1.0) + p.z * p.z - r * r;
        // f = own * other.
        const Vec3 own_gradient{2.0 * p.x * radial, 2.0 * p.y * radial, 2.0 * p.z};
        const double outer = (across + 1.0) / across;
        const Vec3 other_gradient{2.0 * p.x * outer, 2.0 * p.y * outer, 2.0 * p.z};
        return other * own_gradient + own * other_gradient;
    }
    [[nodiscard]] double magnitude() const {
        const double reach = kTorusRoom * (1.0 + r);
        const double a = 3.0 * reach * reach + 1.0;
        return a * a + 8.0 * reach * reach;
    }
    [[nodiscard]] double roundings() const { return 16.0; }
};

}  // namespace alhazen
