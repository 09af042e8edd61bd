#include "alhazen/math/quadratic.h"

#include <utility>

namespace alhazen {

QuadraticRoots solve_half_b_quadratic(double a, double b, double c) {
    if (a == 0.0) {
        if (b == 0.0) return {};
        const double t = -c / (2.0 * b);
        return {1, t, t};
    }
    const double discriminant = difference_of_products(b, b, a, c);
    if (!(discriminant >= 0.0)) return {};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    double t0 = q / a;
    double t1 = q == 0.0 ? t0 : c / q;  // q == 0 only for b == c == 0: both roots are 0
    if (t0 > t1) std::swap(t0, t1);
    return {2, t0, t1};
}

}  // namespace alhazen
