#pragma once
/// A polynomial in x, y and z, read from text such as "x^2*y + z^4 - 1" and evaluated over numbers
/// or, along a segment, over polynomials of one variable.
///
/// Source: Hanrahan, "Ray Tracing Algebraic Surfaces", SIGGRAPH 1983 (symbolic substitution of the
/// line); Farouki and Rajan, "Algorithms for polynomials in Bernstein form", Computer Aided
/// Geometric Design 5, 1988 (products are convolutions of coefficients times binomials). Differs:
/// the expression is kept as it is written, not expanded, so that products of factors cost and
/// round little. Conventions: + - * and powers by whole numbers; division by constants and sqrt of
/// constants, to 30 digits; parentheses. Functions are const and may be called from many threads.

#include <cstdint>
#include <string_view>
#include <vector>

#include "alhazen/shapes/core/solid_frame.h"

namespace alhazen {

class PolynomialExpression {
  public:
    static constexpr int kMaxDegree = 12;

    PolynomialExpression() = default;
    /// Throws Error (Scene) that says what is wrong at which column.
    explicit PolynomialExpression(std::string_view text);

    [[nodiscard]] int degree() const { return nodes_.empty() ? 0 : nodes_.back().degree; }
    /// How many roundings in a row the coefficients of `restricted` suffer, at most.
    [[nodiscard]] double roundings() const;
    /// The sum of the absolute terms where |x|, |y|, |z| are these.
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
        std::uint16_t first = 0;     ///< of its coefficients among those of all nodes
        DoubleDouble constant{};
    };
    /// Operands before operators, the last one is the whole.
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

    /// Coefficients of all nodes together.
    static constexpr int kMaxCoefficients = 1024;

  private:
    std::vector<Node> nodes_;
};

}  // namespace alhazen
