#pragma once
/// The points of a conic or a quadric where the distance to a point is stationary: all that can be
/// nearest.
///
/// Source: Moré, "Generalizations of the Trust Region Problem", Optimization Methods and Software
/// 2(3-4), 1993 (Lagrange's multiplier of a quadratic constraint, its hard case).
/// Differs: all multipliers are found, since a clip may take away the nearest point of the whole
/// surface. Between two poles the derivative of the constraint by the multiplier is a sum of
/// w_i / (1 + m a_i)^3, w_i > 0: times (1 + m a_1)^3 for the least a_1 it is monotone, so that it
/// has one zero at most and the constraint two, which bisections find. No polynomial is made.
/// Conventions: f(x) = x A x + 2 b x + c, in coordinates in which distances are those of space.
/// Complexity: some microseconds.

#include <array>
#include <optional>
#include <vector>

#include "alhazen/math/affine.h"

namespace alhazen {

/// Of a symmetric matrix: eigenvalues and unit eigenvectors, the columns of `axes`.
struct Eigensystem {
    Vec3 values;
    Mat3 axes;
};
/// `m` is symmetric.
/// Source: Golub and Van Loan, "Matrix Computations", 4th ed., section 8.5 (Jacobi's rotations).
[[nodiscard]] Eigensystem eigensystem(const Mat3& m);

/// Of the sum of signs_i rows_i rows_i^T, each eigenvalue to some roundings of itself. None where
/// rows of different signs are not at a right angle: there only the largest one is that exact.
/// Source: Demmel and Veselic, "Jacobi's Method is More Accurate than QR", SIAM Journal on Matrix
/// Analysis and Applications 13(4), 1992, section 4 (one-sided rotations).
[[nodiscard]] std::optional<Eigensystem> eigensystem_of_rows(std::array<Vec3, 3> rows,
                                                             const Vec3& signs);

/// f along its own axes: sum of a_i x_i^2 + 2 b_i x_i, plus c.
struct DiagonalQuadric {
    int dimensions = 3;  ///< 2 for a conic: the third coordinate is left out
    Vec3 a, b;
    double c = 0;

    [[nodiscard]] double value(const Vec3& x) const;
    [[nodiscard]] Vec3 half_gradient(const Vec3& x) const { return a * x + b; }
};

/// Appends points at or beside every stationary one, on the surface within some rounding; some
/// others, too, on the surface or not. Of a circle of points that are all as near there are four.
/// Points of the surface where the gradient is 0 (an apex) may be missing.
void append_stationary_points(const DiagonalQuadric& quadric, const Vec3& from,
                              std::vector<Vec3>& points);

}  // namespace alhazen
