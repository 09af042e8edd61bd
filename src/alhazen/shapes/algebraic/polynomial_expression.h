#pragma once
/// A polynomial in x, y and z, read from text such as "x^2*y + z^4 - 1" and evaluated over numbers
/// or, along a segment, over polynomials of one variable.
///
/// Source: Hanrahan, "Ray Tracing Algebraic Surfaces", SIGGRAPH 1983 (symbolic substitution of the
/// line); Farouki and Rajan, "Algorithms for polynomials in Bernstein form", Computer Aided
/// Geometric Design 5, 1988 (products are convolutions of coefficients times binomials).
/// Differs: the expression is stored as written, not expanded: products of factors are cheap and
/// round little.
/// Conventions: + - * and powers by whole numbers; division by constants and sqrt of constants, to
/// 30 digits; parentheses. Threads: const functions may be called from many threads.

#include <cstdint>
#include <string_view>
#include <vector>

#include "alhazen/shapes/core/solid_frame.h"

namespace alhazen {

class PolynomialExpression {
  public:
    static constexpr int kMaxDegree = 12;

    PolynomialExpression() = default;
    /// Throws Error (Scene) with the message and the column.
    explicit PolynomialExpression(std::string_view text);

    [[nodiscard]] int degree() const { return nodes_.empty() ? 0 : nodes_.back().degree; }
    /// Largest number of consecutive roundings in the coefficients of `restricted`.
    [[nodiscard]] double roundings() const;
    /// The sum of the absolute terms at |x|, |y|, |z| = `reach`.
    [[nodiscard]] double magnitude(const Vec3& reach) const;

    template <class Real>
    [[nodiscard]] Real value(const Point3<Real>& p) const;
    [[nodiscard]] Vec3 gradient(const Vec3& p) const;
    /// Bernstein coefficients, degree() + 1 of them, on the segment from p to q.
    template <class Real>
    void restricted(const Point3<Real>& p, const Point3<Real>& q, Real* b) const;

    enum class Op : std::uint8_t { Constant, X, Y, Z, Add, Subtract, Multiply };
    struct Node {
        Op op = Op::Constant;
        int degree = 0;
        std::uint16_t a = 0, b = 0;  ///< operands: nodes before this one
        std::uint16_t first = 0;     ///< index of its first coefficient among those of all nodes
        DoubleDouble constant{};
    };
    /// Operands before operators; the last node is the whole expression.
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

    /// Largest number of coefficients of all nodes together.
    static constexpr int kMaxCoefficients = 1024;

  private:
    std::vector<Node> nodes_;
};

}  // namespace alhazen
