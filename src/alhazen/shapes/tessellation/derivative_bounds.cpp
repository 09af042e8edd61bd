#include "alhazen/shapes/tessellation/derivative_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace alhazen {

namespace {

Vec3 numerator_about(const HomogeneousPoint& p, const Vec3& center) {
    return Vec3{p.x, p.y, p.z} - p.w * center;
}

/// Largest |first or second difference| of positions about a centre, and of weights.
struct NetDifferences {
    double point = 0, weight = 0;

    void include(const HomogeneousPoint& d, const Vec3& center, double factor) {
        point = std::max(point, factor * length(numerator_about(d, center)));
        weight = std::max(weight, factor * std::abs(d.w));
    }
};

/// [n][k]
constexpr auto kBinomials = [] {
    std::array<std::array<double, kMaxPatchOrder>, kMaxPatchOrder> table{};
    for (std::size_t n = 0; n < table.size(); ++n) {
        table[n][0] = 1;
        for (std::size_t k = 1; k <= n; ++k) {
            table[n][k] = table[n - 1][k - 1] + (k < n ? table[n - 1][k] : 0);
        }
    }
    return table;
}();

/// A polynomial in u and v by its Bernstein coefficients times the binomials, u-major, so that
/// products are convolutions.
template <class T>
struct ScaledNet {
    int m = 0, n = 0;
    std::vector<T> c;

    ScaledNet(int degree_u, int degree_v)
        : m(degree_u), n(degree_v), c(static_cast<std::size_t>((m + 1) * (n + 1))) {}
    T& at(int i, int j) { return c[static_cast<std::size_t>(i * (n + 1) + j)]; }
    [[nodiscard]] const T& at(int i, int j) const {
        return c[static_cast<std::size_t>(i * (n + 1) + j)];
    }
    /// 1, of any degree.
    static ScaledNet one(int degree_u, int degree_v) {
        ScaledNet net(degree_u, degree_v);
        for (int i = 0; i <= degree_u; ++i) {
            for (int j = 0; j <= degree_v; ++j) {
                net.at(i, j) = binomial(degree_u, i) * binomial(degree_v, j);
            }
        }
        return net;
    }
    static double binomial(int n, int k) {
        return kBinomials[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
    }
};

template <class T>
ScaledNet<T> operator*(const ScaledNet<double>& a, const ScaledNet<T>& b) {
    ScaledNet<T> product(a.m + b.m, a.n + b.n);
    for (int i = 0; i <= a.m; ++i) {
        for (int j = 0; j <= a.n; ++j) {
            const double factor = a.at(i, j);
            for (int k = 0; k <= b.m; ++k) {
                for (int l = 0; l <= b.n; ++l) {
                    T& sum = product.at(i + k, j + l);
                    sum = sum + factor * b.at(k, l);
                }
            }
        }
    }
    return product;
}
template <class T>
ScaledNet<T> operator-(ScaledNet<T> a, const ScaledNet<T>& b) {
    for (std::size_t k = 0; k < a.c.size(); ++k) a.c[k] = a.c[k] - b.c[k];
    return a;
}

/// The numerator about a centre and the weight of a patch, or those of a derivative.
struct RationalParts {
    ScaledNet<Vec3> point;
    ScaledNet<double> weight;

    /// Differentiates `du` times by u, `dv` times by v.
    RationalParts(const BezierNet& net, const Vec3& center, int du, int dv)
        : point(net.degree_u - du, net.degree_v - dv), weight(point.m, point.n) {
        const auto value = [&](auto&& self, int i, int j, int u, int v) -> HomogeneousPoint {
            if (u > 0) return self(self, i + 1, j, u - 1, v) - self(self, i, j, u - 1, v);
            if (v > 0) return self(self, i, j + 1, u, v - 1) - self(self, i, j, u, v - 1);
            return net.at(i, j);
        };
        double factor = 1;
        for (int k = 0; k < du; ++k) factor *= net.degree_u - k;
        for (int k = 0; k < dv; ++k) factor *= net.degree_v - k;
        for (int i = 0; i <= point.m; ++i) {
            for (int j = 0; j <= point.n; ++j) {
                const double scale = factor * ScaledNet<double>::binomial(point.m, i) *
                                     ScaledNet<double>::binomial(point.n, j);
                const HomogeneousPoint d = scale * value(value, i, j, du, dv);
                point.at(i, j) = numerator_about(d, center);
                weight.at(i, j) = d.w;
            }
        }
    }
};

/// The bound of a second derivative by the control points of its numerator over those of w^3. The
/// numerator is w^2 P'' - w (p'' P + p' Q + q' P') + 2 p' q' P, with P' and p' of the first
/// parameter, Q and q' of the second. Terms of the quotient rule that cancel, as along the lines of
/// a cylinder, have no part in it.
double numerator_bound(const RationalParts& s, const RationalParts& first,
                       const RationalParts& second, const RationalParts& both) {
    const ScaledNet<double>& w = s.weight;
    ScaledNet<Vec3> sum = w * (w * both.point - both.weight * s.point -
                               first.weight * second.point - second.weight * first.point);
    const ScaledNet<Vec3> rest = (first.weight * second.weight) * s.point;
    for (std::size_t k = 0; k < sum.c.size(); ++k) sum.c[k] = sum.c[k] + 2.0 * rest.c[k];
    const ScaledNet<double> cube = w * (w * w);
    sum = ScaledNet<double>::one(cube.m - sum.m, cube.n - sum.n) * sum;
    double most = 0;
    for (std::size_t k = 0; k < sum.c.size(); ++k) {
        most = std::max(most, length(sum.c[k]) / cube.c[k]);
    }
    return most;
}

}  // namespace

PatchDerivativeBounds second_derivative_bounds(const BezierNet& net) {
    const Box3 box = control_box(net);
    const Vec3 center = box.center();
    const double reach = 0.5 * length(box.size());
    double least_weight = std::numeric_limits<double>::infinity();
    NetDifferences u, v, uu, uv, vv;
    const int m = net.degree_u, n = net.degree_v;
    for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) {
            const HomogeneousPoint& p = net.at(i, j);
            least_weight = std::min(least_weight, p.w);
            if (i < m) u.include(net.at(i + 1, j) - p, center, m);
            if (j < n) v.include(net.at(i, j + 1) - p, center, n);
            if (i + 1 < m) {
                uu.include(net.at(i + 2, j) - 2.0 * net.at(i + 1, j) + p, center, m * (m - 1.0));
            }
            if (j + 1 < n) {
                vv.include(net.at(i, j + 2) - 2.0 * net.at(i, j + 1) + p, center, n * (n - 1.0));
            }
            if (i < m && j < n) {
                uv.include(net.at(i + 1, j + 1) - net.at(i + 1, j) - net.at(i, j + 1) + p, center,
                           static_cast<double>(m) * n);
            }
        }
    }
    // Quotient rule for numerator / weight about the centre.
    const double first_u = (u.point + u.weight * reach) / least_weight;
    const double first_v = (v.point + v.weight * reach) / least_weight;
    PatchDerivativeBounds bounds{
        (uu.point + 2.0 * u.weight * first_u + uu.weight * reach) / least_weight,
        (uv.point + u.weight * first_v + v.weight * first_u + uv.weight * reach) / least_weight,
        (vv.point + 2.0 * v.weight * first_v + vv.weight * reach) / least_weight};
    if (u.weight > 0.0 || v.weight > 0.0) {
        const RationalParts s(net, center, 0, 0), su(net, center, 1, 0), sv(net, center, 0, 1);
        const auto tighten = [&](double& bound, const RationalParts& first,
                                 const RationalParts& second, int du, int dv) {
            // A polynomial of degree -1 is one without coefficients: 0.
            if (du > m + 1 || dv > n + 1 || bound == 0.0) return;
            const RationalParts both(net, center, du, dv);
            bound = std::min(bound, numerator_bound(s, first, second, both));
        };
        tighten(bounds.uu, su, su, 2, 0);
        tighten(bounds.uv, su, sv, 1, 1);
        tighten(bounds.vv, sv, sv, 0, 2);
    }
    return bounds;
}

Vec2 first_derivative_bounds(const BezierNet& net) {
    const Box3 box = control_box(net);
    const Vec3 center = box.center();
    const double reach = 0.5 * length(box.size());
    double least_weight = std::numeric_limits<double>::infinity();
    NetDifferences u, v;
    const int m = net.degree_u, n = net.degree_v;
    for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) {
            const HomogeneousPoint& p = net.at(i, j);
            least_weight = std::min(least_weight, p.w);
            if (i < m) u.include(net.at(i + 1, j) - p, center, m);
            if (j < n) v.include(net.at(i, j + 1) - p, center, n);
        }
    }
    return {(u.point + u.weight * reach) / least_weight,
            (v.point + v.weight * reach) / least_weight};
}

}  // namespace alhazen
