#pragma once
/// Integrals of a filter kernel over polygons, as sums of integrals along their edges.
///
/// Source: Green's theorem: the integral of f(x) f(y) over a region is that of F(x) f(y) dy along
/// its boundary, where F is an antiderivative of f; Duff, "Polygon Scan Conversion by Exact
/// Convolution", Raster Imaging and Digital Typography, 1989.
/// Differs: F is in closed form for each kernel; the integral along an edge has no closed form for
/// a Gaussian and is computed by Gauss' rule between the lines where the kernel is not smooth, to
/// within 1e-9 of the integral of the kernel.
/// Conventions: coordinates in pixels from the centre of the pixel that the filter belongs to. The
/// integral over the whole plane is 1.

#include <array>

#include "alhazen/imaging/film/filter_kernel.h"

namespace alhazen {

class FilterIntegral {
  public:
    /// Throws Error (Usage) for a kernel whose antiderivative has no closed form.
    /// Precondition: radius > 0.
    FilterIntegral(const FilterEntry& entry, double radius);

    /// Number of pixels beside a pixel, along an axis, that its filter reaches.
    [[nodiscard]] int reach() const { return reach_; }
    /// The integral over the strip lo <= x <= hi, or lo <= y <= hi; that over a rectangle is the
    /// product of two.
    [[nodiscard]] double between(double lo, double hi) const {
        return scale_ * (integral(hi) - integral(lo));
    }
    /// The contribution of an edge of a loop around the region: the sum over all edges is the
    /// integral over the region, positive for regions to the left of the edges.
    [[nodiscard]] double along(const Vec2& from, const Vec2& to) const;

  private:
    /// The integral from the centre to x, not scaled.
    [[nodiscard]] double integral(double x) const;

    const FilterEntry* entry_;
    double radius_;
    int reach_;
    double scale_ = 1;
    std::array<double, 5> knots_;  ///< kernel is smooth between successive knots
};

}  // namespace alhazen
