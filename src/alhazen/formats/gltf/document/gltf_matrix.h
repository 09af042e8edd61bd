#pragma once
/// Column-major 4 x 4 matrices of glTF.

#include <cmath>

#include "alhazen/formats/core/homogeneous_matrix.h"

namespace alhazen::gltf {

/// Converts a matrix for `HomogeneousMatrix`. The specification requires the last row (0, 0, 0, 1):
/// a matrix with another last row, up to rounding, has no transform.
[[nodiscard]] inline HomogeneousMatrix matrix_of(const double* m) {
    HomogeneousMatrix matrix({m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10],
                              m[14], m[3], m[7], m[11], m[15]});
    if (matrix.last_row == LastRow::Exact && m[15] != 1.0) matrix.last_row = LastRow::Rounded;
    constexpr double kScaleRounding = 1e-3;
    if (!(std::fabs(m[15] - 1.0) <= kScaleRounding)) matrix.last_row = LastRow::Perspective;
    return matrix;
}

inline constexpr const char* kRoundedMatrices =
    "the last row of a matrix is rounded; it and others are taken as 0, 0, 0, 1 after division by "
    "the last number";

}  // namespace alhazen::gltf
