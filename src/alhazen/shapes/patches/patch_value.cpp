#include "alhazen/shapes/patches/patch_value.h"

#include "alhazen/shapes/patches/patch_lanes.h"

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

HomogeneousValue value_of(BezierView net, double u, double v) {
    if (net.degree_u == 3 && net.degree_v == 3) return patch_kernels().bicubic(net, u, v);
    double bu[kMaxPatchOrder], bv[kMaxPatchOrder], cu[kMaxPatchOrder], cv[kMaxPatchOrder];
    bernstein_values(net.degree_u, u, bu, cu);
    bernstein_values(net.degree_v, v, bv, cv);
    constexpr HomogeneousPoint kZero{0, 0, 0, 0};
    HomogeneousValue sum{kZero, kZero, kZero};
    for (int i = 0; i <= net.degree_u; ++i) {
        HomogeneousPoint row = kZero, row_v = kZero;
        for (int j = 0; j <= net.degree_v; ++j) {
            row = row + bv[j] * net.at(i, j);
            row_v = row_v + cv[j] * net.at(i, j);
        }
        sum.s = sum.s + bu[i] * row;
        sum.s_u = sum.s_u + cu[i] * row;
        sum.s_v = sum.s_v + bu[i] * row_v;
    }
    return sum;
}

Vec3 numerator_of(const HomogeneousPoint& p) {
    return {p.x, p.y, p.z};
}

}  // namespace

PatchValue patch_value(BezierView net, double u, double v) {
    const HomogeneousValue at = value_of(net, u, v);
    PatchValue value;
    value.weight = at.s.w;
    value.point = numerator_of(at.s) / at.s.w;
    value.du = (numerator_of(at.s_u) - at.s_u.w * value.point) / at.s.w;
    value.dv = (numerator_of(at.s_v) - at.s_v.w * value.point) / at.s.w;
    return value;
}

PatchValue weighted_value(BezierView net, const Vec3& origin, double u, double v) {
    const HomogeneousValue at = value_of(net, u, v);
    return {numerator_of(at.s) - at.s.w * origin, numerator_of(at.s_u) - at.s_u.w * origin,
            numerator_of(at.s_v) - at.s_v.w * origin, at.s.w};
}

}  // namespace alhazen
