#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {

void bernstein_values(int degree, double t, double* values, double* derivatives) {
    const double s = 1.0 - t;
    values[0] = 1.0;
    for (int n = 1; n <= degree; ++n) {
        if (n == degree) {
            derivatives[0] = -n * values[0];
            for (int i = 1; i < n; ++i) derivatives[i] = n * (values[i - 1] - values[i]);
            derivatives[n] = n * values[n - 1];
        }
        values[n] = t * values[n - 1];
        for (int i = n - 1; i > 0; --i) values[i] = s * values[i] + t * values[i - 1];
        values[0] = s * values[0];
    }
}

namespace {

struct HomogeneousValue {
    HomogeneousPoint s{0, 0, 0, 0}, s_u{0, 0, 0, 0}, s_v{0, 0, 0, 0};
};

/// Degrees of zero: read from the net; else known when it is compiled.
template <int kDegree>
HomogeneousValue value_of_degree(const BezierNet& net, double u, double v) {
    const int degree_u = kDegree != 0 ? kDegree : net.degree_u;
    const int degree_v = kDegree != 0 ? kDegree : net.degree_v;
    double bu[kMaxPatchOrder], bv[kMaxPatchOrder], cu[kMaxPatchOrder], cv[kMaxPatchOrder];
    bernstein_values(degree_u, u, bu, cu);
    bernstein_values(degree_v, v, bv, cv);
    HomogeneousValue sum;
    for (int i = 0; i <= degree_u; ++i) {
        HomogeneousPoint row{0, 0, 0, 0}, row_v{0, 0, 0, 0};
        const HomogeneousPoint* points = &net.points[static_cast<std::size_t>(i * (degree_v + 1))];
        for (int j = 0; j <= degree_v; ++j) {
            row = row + bv[j] * points[j];
            row_v = row_v + cv[j] * points[j];
        }
        sum.s = sum.s + bu[i] * row;
        sum.s_u = sum.s_u + cu[i] * row;
        sum.s_v = sum.s_v + bu[i] * row_v;
    }
    return sum;
}

HomogeneousValue value_of(const BezierNet& net, double u, double v) {
    if (net.degree_u == 3 && net.degree_v == 3) return value_of_degree<3>(net, u, v);
    return value_of_degree<0>(net, u, v);
}

Vec3 numerator_of(const HomogeneousPoint& p) {
    return {p.x, p.y, p.z};
}

}  // namespace

PatchValue patch_value(const BezierNet& net, double u, double v) {
    const HomogeneousValue at = value_of(net, u, v);
    PatchValue value;
    value.weight = at.s.w;
    value.point = numerator_of(at.s) / at.s.w;
    value.du = (numerator_of(at.s_u) - at.s_u.w * value.point) / at.s.w;
    value.dv = (numerator_of(at.s_v) - at.s_v.w * value.point) / at.s.w;
    return value;
}

PatchValue weighted_value(const BezierNet& net, const Vec3& origin, double u, double v) {
    const HomogeneousValue at = value_of(net, u, v);
    return {numerator_of(at.s) - at.s.w * origin, numerator_of(at.s_u) - at.s_u.w * origin,
            numerator_of(at.s_v) - at.s_v.w * origin, at.s.w};
}

}  // namespace alhazen
