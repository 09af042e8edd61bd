#pragma once
/// Affine transforms from 4 x 4 matrices of files.
///
/// Conventions: row-major, for column vectors. The last number divides all others. A last row that
/// is then (0, 0, 0, 1) up to kLastRowRounding is taken as exactly that: editors compose and invert
/// matrices in floating point and write the rounded result.

#include <array>
#include <cmath>
#include <cstdint>

#include "alhazen/math/affine.h"

namespace alhazen {

enum class LastRow : std::uint8_t {
    Exact,        ///< (0, 0, 0, w)
    Rounded,      ///< (0, 0, 0, w) up to rounding
    Perspective,  ///< not that of an affine transform, or w = 0
};

/// Bound on the first three numbers of the last row, relative to the fourth.
inline constexpr double kLastRowRounding = 1e-5;

struct HomogeneousMatrix {
    Affine transform;  ///< identity for LastRow::Perspective
    LastRow last_row = LastRow::Perspective;

    explicit HomogeneousMatrix(const std::array<double, 16>& m) {
        const double w = m[15];
        const double bound = kLastRowRounding * std::fabs(w);
        bool exact = true;
        for (std::size_t i = 12; i < 15; ++i) {
            if (!(std::fabs(m[i]) <= bound)) return;  // also for NaN
            exact = exact && m[i] == 0.0;
        }
        if (w == 0.0) return;
        last_row = exact ? LastRow::Exact : LastRow::Rounded;
        const double s = 1.0 / w;
        transform = {
            {s * Vec3{m[0], m[4], m[8]}, s * Vec3{m[1], m[5], m[9]}, s * Vec3{m[2], m[6], m[10]}},
            s * Vec3{m[3], m[7], m[11]}};
    }
};

}  // namespace alhazen
