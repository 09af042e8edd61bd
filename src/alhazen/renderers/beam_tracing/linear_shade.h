#pragma once
/// Fits a linear gradient to colours at points.

#include <span>
#include <vector>

#include "alhazen/imaging/drawing/drawing.h"

namespace alhazen {

struct ShadePoint {
    Vec2 at;
    Rgb color;
};

struct LinearShade {
    Rgb mean;
    std::optional<DrawingGradient> gradient;  ///< empty if one colour is sufficient
    double error = 0;                         ///< largest error of a channel, at the points
};

/// Least squares fit along the direction in which the sum of the channels changes. `enough`: one
/// colour is used if no channel differs from it by more.
[[nodiscard]] LinearShade fit_shade(std::span<const ShadePoint> points, double enough);

}  // namespace alhazen
