#include "alhazen/math/affine.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

Mat3 inverse(const Mat3& m) {
    // Rows of the adjugate are the cross products of the columns.
    const Vec3 r0 = cross(m.y_axis, m.z_axis);
    const Vec3 r1 = cross(m.z_axis, m.x_axis);
    const Vec3 r2 = cross(m.x_axis, m.y_axis);
    const double det = dot(m.x_axis, r0);
    return {Vec3{r0.x, r1.x, r2.x} / det, Vec3{r0.y, r1.y, r2.y} / det,
            Vec3{r0.z, r1.z, r2.z} / det};
}

double stretch_bound(const Mat3& m) {
    const Vec3 columns[3] = {m.x_axis, m.y_axis, m.z_axis};
    double most = 0;
    for (const Vec3& a : columns) {
        double sum = 0;
        for (const Vec3& b : columns) sum += std::abs(dot(a, b));
        most = std::max(most, sum);
    }
    return (1.0 + 1e-15) * std::sqrt(most);
}

Affine Affine::scale(const Vec3& factors) {
    return {{{factors.x, 0, 0}, {0, factors.y, 0}, {0, 0, factors.z}}, {}};
}

Affine Affine::rotate(const Vec3& axis, double radians) {
    const Vec3 a = normalize(axis);
    const double c = std::cos(radians);
    const double s = std::sin(radians);
    // Rodrigues' rotation formula, applied to the three unit vectors.
    const auto turn = [&](const Vec3& v) {
        return c * v + s * cross(a, v) + (1.0 - c) * dot(a, v) * a;
    };
    return {{turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})}, {}};
}

Affine inverse(const Affine& m) {
    const Mat3 linear = inverse(m.linear);
    return {linear, -(linear * m.translation)};
}

bool is_invertible(const Affine& m) {
    const auto finite = [](const Affine& t) {
        return is_finite(t.linear.x_axis) && is_finite(t.linear.y_axis) &&
               is_finite(t.linear.z_axis) && is_finite(t.translation);
    };
    const double det = determinant(m.linear);
    return finite(m) && std::isfinite(det) && det != 0.0 && finite(inverse(m));
}

}  // namespace alhazen
