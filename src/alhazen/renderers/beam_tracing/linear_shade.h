#pragma once
/// Fits colours at points by one that changes linearly along one direction.

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
    std::optional<DrawingGradient> gradient;  ///< none where one colour will do
    double error = 0;                         ///< the largest of a channel, at the points
};

/// Least squares: the direction is that in which the sum of the channels changes. `enough`: one
/// colour will do where no channel is further from it.
[[nodiscard]] LinearShade fit_shade(std::span<const ShadePoint> points, double enough);

}  // namespace alhazen
