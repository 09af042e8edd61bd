#include "alhazen/shapes/nearest/stationary_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr double kFar = 1e60;      ///< stands for an infinite multiplier
constexpr double kBeside = 1e-60;  ///< offset from a pole
constexpr double kSame = 1e-13;    ///< relative difference below which eigenvalues are merged

/// Maps doubles to integers in the same order.
std::int64_t ordinal(double x) {
    const auto bits = std::bit_cast<std::int64_t>(std::abs(x));
    return x < 0.0 ? -bits : bits;
}
double of_ordinal(std::int64_t n) {
    return n < 0 ? -std::bit_cast<double>(-n) : std::bit_cast<double>(n);
}
/// The median of the doubles between `lo` and `hi`.
double middle(double lo, double hi) {
    const std::int64_t a = ordinal(lo), b = ordinal(hi);
    return of_ordinal(a / 2 + b / 2 + (a % 2 + b % 2) / 2);
}

class Multipliers {
  public:
    Multipliers(const DiagonalQuadric& q, const Vec3& from, std::vector<Vec3>& points)
        : q_(q),
          from_(from),
          g_(q.half_gradient(from)),
          own_((q.a * from + 2.0 * q.b) * from),
          points_(points) {}

    void run() {
        std::vector<int> axes;  // with a pole, the lowest pole first
        for (int i = 0; i < q_.dimensions; ++i) {
            if (std::abs(q_.a[i]) > 1.0 / kFar) axes.push_back(i);
        }
        std::sort(axes.begin(), axes.end(), [&](int i, int k) { return pole(i) < pole(k); });
        if (axes.empty()) {
            between({kNoPole, -kFar}, {kNoPole, kFar});
        } else {
            between({axes.front(), -kFar}, {axes.front(), -kBeside});
            for (std::size_t i = 1; i < axes.size(); ++i) {
                const double half = 0.5 * (pole(axes[i]) - pole(axes[i - 1]));
                if (!(half > kBeside)) continue;
                between({axes[i - 1], kBeside}, {axes[i - 1], half});
                between({axes[i], -half}, {axes[i], -kBeside});
            }
            between({axes.back(), kBeside}, {axes.back(), kFar});
        }
        for (int i = 0; i < q_.dimensions; ++i) free_along(i);
    }

  private:
    static constexpr int kNoPole = -1;

    /// A multiplier as an offset from the pole of an axis, which may be smaller than the spacing of
    /// doubles at the pole.
    struct Multiplier {
        int axis = kNoPole;
        double offset = 0;
    };

    [[nodiscard]] double pole(int axis) const { return axis == kNoPole ? 0.0 : -1.0 / q_.a[axis]; }
    [[nodiscard]] double value(const Multiplier& m) const { return pole(m.axis) + m.offset; }
    /// 1 + m a_i.
    [[nodiscard]] double divisor(const Multiplier& m, int i) const {
        const double a = q_.a[i];
        if (m.axis == kNoPole) return 1.0 + m.offset * a;
        const double of_pole = q_.a[m.axis];
        return (of_pole - a) / of_pole + m.offset * a;
    }
    /// True if the point of a multiplier with this divisor is far from `from`: the difference of
    /// the coordinates is then rounded more than the coordinates.
    [[nodiscard]] static bool leads_far(double d) { return std::abs(d) > 2.0; }
    /// Coordinate i of the point of the multiplier m, which has divisor d along axis i.
    [[nodiscard]] double coordinate(double m, double d, int i) const {
        if (g_[i] == 0.0) return from_[i];
        return leads_far(d) ? (from_[i] - m * q_.b[i]) / d : from_[i] - m * (g_[i] / d);
    }
    /// f at the point of a multiplier.
    [[nodiscard]] double constraint(const Multiplier& m) const {
        double sum = q_.c;
        for (int i = 0; i < q_.dimensions; ++i) {
            const double d = divisor(m, i);
            if (g_[i] == 0.0) {
                sum += own_[i];
            } else if (leads_far(d)) {
                const double x = coordinate(value(m), d, i);
                sum += (q_.a[i] * x + 2.0 * q_.b[i]) * x;
            } else {
                sum += own_[i] - g_[i] / d * g_[i] * value(m) * ((1.0 + d) / d);
            }
        }
        return sum;
    }
    /// Derivative of `constraint`, times -1/2.
    [[nodiscard]] double slope(const Multiplier& m) const {
        double sum = 0.0;
        for (int i = 0; i < q_.dimensions; ++i) {
            if (g_[i] == 0.0) continue;
            const double d = divisor(m, i);
            sum += (g_[i] / d) * (g_[i] / d) / d;
        }
        return sum;
    }
    void add(const Multiplier& m) {
        Vec3 x = from_;
        for (int i = 0; i < q_.dimensions; ++i) x[i] = coordinate(value(m), divisor(m, i), i);
        if (is_finite(x)) points_.push_back(x);
    }
    /// A zero of f between two multipliers of one axis at which its signs differ.
    template <class F>
    [[nodiscard]] Multiplier bisect(Multiplier lo, Multiplier hi, F f) const {
        const bool rises = f(hi) > 0.0;
        for (double m = middle(lo.offset, hi.offset); m > lo.offset && m < hi.offset;
             m = middle(lo.offset, hi.offset)) {
            ((f(Multiplier{lo.axis, m}) > 0.0) == rises ? hi : lo).offset = m;
        }
        return std::abs(f(lo)) < std::abs(f(hi)) ? lo : hi;
    }
    /// The multiplier where the slope changes its sign; empty if it does not.
    [[nodiscard]] std::optional<Multiplier> turn(const Multiplier& lo, const Multiplier& hi) const {
        const auto f = [&](const Multiplier& m) { return slope(m); };
        if ((f(lo) > 0.0) == (f(hi) > 0.0)) return std::nullopt;
        return bisect(lo, hi, f);
    }
    void between(const Multiplier& lo, const Multiplier& hi) {
        const std::optional<Multiplier> top = turn(lo, hi);
        if (!top) return monotone(lo, hi);
        add(*top);  // a double root within rounding
        monotone(lo, *top);
        monotone(*top, hi);
    }
    void monotone(const Multiplier& lo, const Multiplier& hi) {
        const auto f = [&](const Multiplier& m) { return constraint(m); };
        if ((f(lo) > 0.0) != (f(hi) > 0.0)) add(bisect(lo, hi, f));
    }
    [[nodiscard]] bool is_same(int i, int k) const {
        return std::abs(q_.a[i] - q_.a[k]) <=
               kSame * std::max(std::abs(q_.a[i]), std::abs(q_.a[k]));
    }
    /// The hard case: no force along axis i, at its pole. Coordinate i follows from f = 0.
    void free_along(int i) {
        if (q_.a[i] == 0.0) return;
        const double m = -1.0 / q_.a[i];
        Vec3 x = from_;
        for (int k = 0; k < q_.dimensions; ++k) {
            if (is_same(i, k)) {
                x[k] = -q_.b[k] / q_.a[k];
            } else {
                x[k] = coordinate(m, 1.0 + m * q_.a[k], k);
            }
        }
        const double squared = -q_.value(x) / q_.a[i];
        if (!(squared >= 0.0) || !is_finite(x)) return;
        const double away = std::sqrt(squared), center = x[i];
        for (const double side : {-1.0, 1.0}) {
            x[i] = center + side * away;
            points_.push_back(x);
        }
    }

    const DiagonalQuadric& q_;
    const Vec3 from_, g_;
    const Vec3 own_;  ///< contribution of the axes to f at `from`
    std::vector<Vec3>& points_;
};

}  // namespace

Eigensystem eigensystem(const Mat3& m) {
    double a[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; ++i) {
        a[i][0] = m.x_axis[i];
        a[i][1] = m.y_axis[i];
        a[i][2] = m.z_axis[i];
    }
    for (int sweep = 0; sweep < 30; ++sweep) {
        bool done = true;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (!(std::abs(a[p][q]) > 1e-17 * std::sqrt(std::abs(a[p][p] * a[q][q]))) ||
                    !(std::abs(a[p][q]) > 1e-300)) {
                    continue;
                }
                done = false;
                const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                const double t =
                    (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::hypot(theta, 1.0));
                const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
                for (int k = 0; k < 3; ++k) {
                    const double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y;
                    a[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; ++k) {
                    const double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y;
                    a[q][k] = s * x + c * y;
                    const double u = v[k][p], w = v[k][q];
                    v[k][p] = c * u - s * w;
                    v[k][q] = s * u + c * w;
                }
                a[p][q] = a[q][p] = 0.0;
            }
        }
        if (done) break;
    }
    return {
        {a[0][0], a[1][1], a[2][2]},
        {{v[0][0], v[1][0], v[2][0]}, {v[0][1], v[1][1], v[2][1]}, {v[0][2], v[1][2], v[2][2]}}};
}

std::optional<Eigensystem> eigensystem_of_rows(std::array<Vec3, 3> rows, const Vec3& signs) {
    constexpr double kRight = 4 * std::numeric_limits<double>::epsilon();
    std::array<double, 3> sizes{};
    bool done = false;
    for (int sweep = 0; sweep < 30 && !done; ++sweep) {
        done = true;
        for (int k = 0; k < 3; ++k) sizes[k] = signs[k] != 0.0 ? length(rows[k]) : 0.0;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (sizes[p] == 0.0 || sizes[q] == 0.0) continue;
                const double over = dot(rows[p] / sizes[p], rows[q] / sizes[q]);
                if (std::abs(over) <= kRight) continue;
                if (signs[p] != signs[q]) return std::nullopt;
                done = false;
                const double ratio = sizes[q] / sizes[p];
                const double theta = (ratio - 1.0 / ratio) / (2.0 * over);
                const double t =
                    (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::hypot(theta, 1.0));
                const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
                const Vec3 x = rows[p], y = rows[q];
                rows[p] = c * x - s * y;
                rows[q] = s * x + c * y;
                sizes[p] = length(rows[p]);
                sizes[q] = length(rows[q]);
            }
        }
    }
    if (!done) return std::nullopt;
    // Flat directions are perpendicular to the others.
    Eigensystem result{};
    std::array<Vec3*, 3> axes{&result.axes.x_axis, &result.axes.y_axis, &result.axes.z_axis};
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int k) { return sizes[i] > sizes[k]; });
    if (!(sizes[order[0]] > 0.0) || !std::isfinite(sizes[order[0]])) return std::nullopt;
    const auto axis = [&](int i) { return rows[order[i]] / sizes[order[i]]; };
    *axes[order[0]] = axis(0);
    *axes[order[1]] = sizes[order[1]] > 0.0 ? axis(1) : perpendicular(axis(0));
    *axes[order[2]] = sizes[order[2]] > 0.0 ? axis(2) : cross(*axes[order[0]], *axes[order[1]]);
    for (int k = 0; k < 3; ++k) result.values[k] = signs[k] * sizes[k] * sizes[k];
    return result;
}

double DiagonalQuadric::value(const Vec3& x) const {
    double sum = c;
    for (int i = 0; i < dimensions; ++i) sum += (a[i] * x[i] + 2.0 * b[i]) * x[i];
    return sum;
}

void append_stationary_points(const DiagonalQuadric& quadric, const Vec3& from,
                              std::vector<Vec3>& points) {
    Multipliers(quadric, from, points).run();
}

}  // namespace alhazen
