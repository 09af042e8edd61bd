#include "alhazen/shapes/algebraic/polynomial_expression.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "alhazen/base/instruction_sets.h"
#include "alhazen/math/bernstein_roots.h"
#include "alhazen/shapes/algebraic/polynomial_parser.h"

namespace alhazen {

namespace {

using Op = PolynomialExpression::Op;
using Node = PolynomialExpression::Node;

template <class Real>
Real constant_as(const DoubleDouble& c) {
    if constexpr (std::is_same_v<Real, double>) {
        return c.high;
    } else {
        return c;
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

#include "alhazen/shapes/algebraic/restricted_polynomial-inl.h"

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

/// Uninitialised storage for the largest number of nodes or coefficients of an expression.
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

Vec3 gradient_of_body(std::span<const Node> nodes, const Vec3& p) {
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
ALHAZEN_FOR_EACH_INSTRUCTION_SET(Vec3 gradient_of(std::span<const Node> nodes, const Vec3& p),
                                 gradient_of_body(nodes, p))

template <class Real>
void restrict_to(std::span<const Node> nodes, const Point3<Real>& p, const Point3<Real>& q,
                 Real* b) {
    Values<Real> all;
    restrict_nodes(nodes, p, q, all.data(), b);
}

ALHAZEN_FOR_EACH_INSTRUCTION_SET(double value_in_double(std::span<const Node> nodes,
                                                        const Point3<double>& p),
                                 value_of(nodes, p))
ALHAZEN_FOR_EACH_INSTRUCTION_SET(DoubleDouble value_in_double_double(std::span<const Node> nodes,
                                                                     const Point3<DoubleDouble>& p),
                                 value_of(nodes, p))
ALHAZEN_FOR_EACH_INSTRUCTION_SET(void restrict_in_double(std::span<const Node> nodes,
                                                         const Point3<double>& p,
                                                         const Point3<double>& q, double* b),
                                 restrict_to(nodes, p, q, b))
ALHAZEN_FOR_EACH_INSTRUCTION_SET(void restrict_in_double_double(std::span<const Node> nodes,
                                                                const Point3<DoubleDouble>& p,
                                                                const Point3<DoubleDouble>& q,
                                                                DoubleDouble* b),
                                 restrict_to(nodes, p, q, b))

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
