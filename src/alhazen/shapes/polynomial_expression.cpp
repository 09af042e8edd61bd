#include "alhazen/shapes/polynomial_expression.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "alhazen/base/instruction_sets.h"
#include "alhazen/shapes/polynomial_parser.h"

namespace alhazen {

namespace {

using Op = PolynomialExpression::Op;
using Node = PolynomialExpression::Node;

constexpr std::size_t kRows = PolynomialExpression::kMaxDegree + 1;

/// [n][k] n over k.
constexpr std::array<std::array<double, kRows>, kRows> kBinomials = [] {
    std::array<std::array<double, kRows>, kRows> table{};
    for (std::size_t n = 0; n < kRows; ++n) {
        table[n][0] = 1.0;
        for (std::size_t k = 1; k <= n; ++k) {
            table[n][k] = table[n - 1][k - 1] + (k < n ? table[n - 1][k] : 0.0);
        }
    }
    return table;
}();

template <class Real>
Real constant_as(const DoubleDouble& c) {
    if constexpr (std::is_same_v<Real, double>) {
        return c.high;
    } else {
        return c;
    }
}

/// out = u v, of degrees m and n.
template <class Real>
void multiply(const Real* u, int m, const Real* v, int n, Real* out) {
    if (m == 1 && n == 1) {
        out[0] = u[0] * v[0];
        out[1] = u[0] * v[1] + u[1] * v[0];
        out[2] = u[1] * v[1];
        return;
    }
    if (m == 2 && n == 2) {
        out[0] = u[0] * v[0];
        out[1] = u[0] * v[1] + u[1] * v[0];
        out[2] = u[0] * v[2] + u[1] * v[1] + u[2] * v[0];
        out[3] = u[1] * v[2] + u[2] * v[1];
        out[4] = u[2] * v[2];
        return;
    }
    for (int k = 0; k <= n; ++k) out[k] = u[0] * v[k];
    for (int i = 1; i <= m; ++i) {
        for (int k = 0; k < n; ++k) out[i + k] += u[i] * v[k];
        out[i + n] = u[i] * v[n];
    }
}

/// out += sign * a, raised from degree m to n: times ((1 - u) + u)^(n - m).
template <class Real>
void add_raised(const Real* a, int m, int n, double sign, Real* out) {
    const double* row = kBinomials[static_cast<std::size_t>(n - m)].data();
    for (int i = 0; i <= m; ++i) {
        for (int k = 0; k <= n - m; ++k) out[i + k] += Real(sign * row[k]) * a[i];
    }
}

/// out = u + sign v, of degrees m and n.
template <class Real>
void add(const Real* u, int m, const Real* v, int n, double sign, Real* out) {
    if (m == n) {
        for (int i = 0; i <= n; ++i) out[i] = sign > 0.0 ? u[i] + v[i] : u[i] - v[i];
    } else if (m > n) {
        std::copy_n(u, m + 1, out);
        add_raised(v, n, m, sign, out);
    } else {
        for (int i = 0; i <= n; ++i) out[i] = sign > 0.0 ? v[i] : -v[i];
        add_raised(u, m, n, 1.0, out);
    }
}

template <class Real>
Real divided(const Real& a, double by) {
    if constexpr (std::is_same_v<Real, double>) {
        return a / by;
    } else {
        return quotient(a, Real(by));
    }
}

}  // namespace

PolynomialExpression::PolynomialExpression(std::string_view text)
    : nodes_(parse_polynomial(text)) {}

double PolynomialExpression::roundings() const {
    std::vector<double> of(nodes_.size(), 0.0);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& n = nodes_[i];
        if (n.op == Op::Constant) of[i] = 1.0;
        if (n.op < Op::Add) continue;
        const int a = nodes_[n.a].degree, b = nodes_[n.b].degree;
        if (n.op == Op::Multiply) {
            of[i] = of[n.a] + of[n.b] + std::min(a, b) + 2.0;
        } else {
            of[i] = std::max(of[n.a], of[n.b]) + std::abs(a - b) + 3.0;
        }
    }
    return of.empty() ? 0.0 : of.back() + 2.0;
}

double PolynomialExpression::magnitude(const Vec3& reach) const {
    std::vector<double> of(nodes_.size(), 0.0);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& n = nodes_[i];
        switch (n.op) {
            case Op::Constant:
                of[i] = std::abs(n.constant.high);
                break;
            case Op::X:
                of[i] = reach.x;
                break;
            case Op::Y:
                of[i] = reach.y;
                break;
            case Op::Z:
                of[i] = reach.z;
                break;
            case Op::Add:
            case Op::Subtract:
                of[i] = of[n.a] + of[n.b];
                break;
            case Op::Multiply:
                of[i] = of[n.a] * of[n.b];
                break;
        }
    }
    return of.empty() ? 0.0 : of.back();
}

namespace {

/// Room for as many values as an expression may have nodes or coefficients; they are not set.
template <class T>
class Values {
  public:
    T* data() { return reinterpret_cast<T*>(bytes_); }
    T& operator[](std::size_t i) { return data()[i]; }

  private:
    alignas(T) std::byte bytes_[PolynomialExpression::kMaxCoefficients * sizeof(T)];
};

template <class Real>
Real value_of(std::span<const Node> nodes, const Point3<Real>& p) {
    Values<Real> of;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        switch (n.op) {
            case Op::Constant:
                of[i] = constant_as<Real>(n.constant);
                break;
            case Op::X:
                of[i] = p.x;
                break;
            case Op::Y:
                of[i] = p.y;
                break;
            case Op::Z:
                of[i] = p.z;
                break;
            case Op::Add:
                of[i] = of[n.a] + of[n.b];
                break;
            case Op::Subtract:
                of[i] = of[n.a] - of[n.b];
                break;
            case Op::Multiply:
                of[i] = of[n.a] * of[n.b];
                break;
        }
    }
    return nodes.empty() ? Real(0.0) : of[nodes.size() - 1];
}

ALHAZEN_FOR_EACH_INSTRUCTION_SET
Vec3 gradient_of(std::span<const Node> nodes, const Vec3& p) {
    struct Value {
        double v;
        Vec3 g;
    };
    Values<Value> of;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        switch (n.op) {
            case Op::Constant:
                of[i] = {n.constant.high, {}};
                break;
            case Op::X:
                of[i] = {p.x, {1, 0, 0}};
                break;
            case Op::Y:
                of[i] = {p.y, {0, 1, 0}};
                break;
            case Op::Z:
                of[i] = {p.z, {0, 0, 1}};
                break;
            case Op::Add:
                of[i] = {of[n.a].v + of[n.b].v, of[n.a].g + of[n.b].g};
                break;
            case Op::Subtract:
                of[i] = {of[n.a].v - of[n.b].v, of[n.a].g - of[n.b].g};
                break;
            case Op::Multiply:
                of[i] = {of[n.a].v * of[n.b].v, of[n.b].v * of[n.a].g + of[n.a].v * of[n.b].g};
                break;
        }
    }
    return nodes.empty() ? Vec3{} : of[nodes.size() - 1].g;
}

template <class Real>
void restrict_to(std::span<const Node> nodes, const Point3<Real>& p, const Point3<Real>& q,
                 Real* b) {
    // Of every node the coefficients times binomials.
    Values<Real> all;
    for (const Node& n : nodes) {
        Real* out = all.data() + n.first;
        const auto ends = [&](const Real& at_p, const Real& at_q) {
            out[0] = at_p;
            out[1] = at_q;
        };
        switch (n.op) {
            case Op::Constant:
                out[0] = constant_as<Real>(n.constant);
                continue;
            case Op::X:
                ends(p.x, q.x);
                continue;
            case Op::Y:
                ends(p.y, q.y);
                continue;
            case Op::Z:
                ends(p.z, q.z);
                continue;
            default:
                break;
        }
        const Node &left = nodes[n.a], &right = nodes[n.b];
        const Real *u = all.data() + left.first, *v = all.data() + right.first;
        if (n.op == Op::Multiply) {
            multiply(u, left.degree, v, right.degree, out);
        } else {
            add(u, left.degree, v, right.degree, n.op == Op::Add ? 1.0 : -1.0, out);
        }
    }
    const Node& root = nodes.back();
    for (int i = 0; i <= root.degree; ++i) {
        b[i] =
            divided(all[static_cast<std::size_t>(root.first + i)],
                    kBinomials[static_cast<std::size_t>(root.degree)][static_cast<std::size_t>(i)]);
    }
}

ALHAZEN_FOR_EACH_INSTRUCTION_SET
double value_in_double(std::span<const Node> nodes, const Point3<double>& p) {
    return value_of(nodes, p);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET
DoubleDouble value_in_double_double(std::span<const Node> nodes, const Point3<DoubleDouble>& p) {
    return value_of(nodes, p);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET
void restrict_in_double(std::span<const Node> nodes, const Point3<double>& p,
                        const Point3<double>& q, double* b) {
    restrict_to(nodes, p, q, b);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET
void restrict_in_double_double(std::span<const Node> nodes, const Point3<DoubleDouble>& p,
                               const Point3<DoubleDouble>& q, DoubleDouble* b) {
    restrict_to(nodes, p, q, b);
}

}  // namespace

template <class Real>
Real PolynomialExpression::value(const Point3<Real>& p) const {
    if constexpr (std::is_same_v<Real, double>) {
        return value_in_double(nodes_, p);
    } else {
        return value_in_double_double(nodes_, p);
    }
}

Vec3 PolynomialExpression::gradient(const Vec3& p) const {
    return gradient_of(nodes_, p);
}

template <class Real>
void PolynomialExpression::restricted(const Point3<Real>& p, const Point3<Real>& q, Real* b) const {
    if constexpr (std::is_same_v<Real, double>) {
        restrict_in_double(nodes_, p, q, b);
    } else {
        restrict_in_double_double(nodes_, p, q, b);
    }
}

template double PolynomialExpression::value(const Point3<double>&) const;
template DoubleDouble PolynomialExpression::value(const Point3<DoubleDouble>&) const;
template void PolynomialExpression::restricted(const Point3<double>&, const Point3<double>&,
                                               double*) const;
template void PolynomialExpression::restricted(const Point3<DoubleDouble>&,
                                               const Point3<DoubleDouble>&, DoubleDouble*) const;

}  // namespace alhazen
