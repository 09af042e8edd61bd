#pragma once
/// The points of a conic or a quadric where the distance to a given point is stationary: the
/// candidates for the nearest point.
///
/// Source: Moré, "Generalizations of the Trust Region Problem", Optimization Methods and Software
/// 2(3-4), 1993 (the Lagrange multiplier of a quadratic constraint, and the hard case).
/// Differs: finds all multipliers, since a clip may remove the nearest point of the whole surface.
/// Between two poles the derivative of the constraint by the multiplier is a sum of w_i / (1 + m
/// a_i)^3, w_i > 0. Multiplied by (1 + m a_1)^3 for the least a_1 it is monotone, so that it has at
/// most one zero and the constraint at most two, found by bisection. No polynomial is formed.
/// Conventions: f(x) = x A x + 2 b x + c, in coordinates that preserve distances.
/// Complexity: some microseconds.

#include <array>
#include <optional>
#include <vector>

#include "alhazen/math/affine.h"

namespace alhazen {

/// Eigenvalues and unit eigenvectors, the columns of `axes`, of a symmetric matrix.
struct Eigensystem {
    Vec3 values;
    Mat3 axes;
};
/// `m` is symmetric.
/// Source: Golub and Van Loan, "Matrix Computations", 4th ed., section 8.5 (Jacobi's rotations).
[[nodiscard]] Eigensystem eigensystem(const Mat3& m);

/// Eigensystem of the sum of signs_i rows_i rows_i^T, with each eigenvalue accurate to some
/// roundings. Empty if rows of different signs are not perpendicular: then only the largest
/// eigenvalue is that accurate.
/// Source: Demmel and Veselic, "Jacobi's Method is More Accurate than QR", SIAM Journal on Matrix
/// Analysis and Applications 13(4), 1992, section 4 (one-sided rotations).
[[nodiscard]] std::optional<Eigensystem> eigensystem_of_rows(std::array<Vec3, 3> rows,
                                                             const Vec3& signs);

/// f along its own axes: sum of a_i x_i^2 + 2 b_i x_i, plus c.
struct DiagonalQuadric {
    int dimensions = 3;  ///< 2 for a conic: the third coordinate is ignored
    Vec3 a, b;
    double c = 0;

    [[nodiscard]] double value(const Vec3& x) const;
    [[nodiscard]] Vec3 half_gradient(const Vec3& x) const { return a * x + b; }
};

/// Appends points at or near every stationary point, on the surface within some roundings, and
/// possibly others, on the surface or not. A circle of equidistant points is represented by four.
/// Points of the surface with gradient 0 (an apex) may be missing.
void append_stationary_points(const DiagonalQuadric& quadric, const Vec3& from,
                              std::vector<Vec3>& points);

}  // namespace alhazen
