#pragma once
/// Bases of cubic curves, and the Bezier points of a segment.
///
/// Source: Pixar, "The RenderMan Interface", version 3.2, 2000, section 5.1 (bases);
/// Farin, "Curves and Surfaces for CAGD", chapters 4 to 8.
/// Conventions: a basis matrix is row-major, with rows for t^3, t^2, t, 1 and columns for the four
/// control points. Bezier points are sums of integer multiples of control points, divided once: two
/// segments that share the control points of a boundary get the same bits there.

#include <array>
#include <optional>
#include <string_view>

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

class CubicBasis {
  public:
    /// The Bezier basis.
    CubicBasis();
    /// The basis of any matrix.
    explicit CubicBasis(const std::array<double, 16>& matrix);
    /// The basis of a name: bezier, b-spline, catmull-rom, hermite, power, cardinal (tension 1/2).
    [[nodiscard]] static std::optional<CubicBasis> named(std::string_view name);

    /// The Bezier points of the segment of four control points.
    [[nodiscard]] std::array<HomogeneousPoint, 4> bezier(
        const std::array<HomogeneousPoint, 4>& points) const;

  private:
    std::array<double, 16> factors_{};  ///< [Bezier point][control point], times divisor_
    double divisor_ = 1.0;
};

/// The Bezier net of 16 control points, u-major.
[[nodiscard]] BezierNet bezier_of(const CubicBasis& u, const CubicBasis& v,
                                  const std::array<HomogeneousPoint, 16>& points);

}  // namespace alhazen
