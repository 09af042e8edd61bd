#pragma once
/// Integrals of a filter kernel over polygons, as sums of integrals along their edges.
///
/// Source: Green's theorem: the integral of f(x) f(y) over a region is that of F(x) f(y) dy along
/// its boundary, F being an antiderivative of f; Duff, "Polygon Scan Conversion by Exact
/// Convolution", Raster Imaging and Digital Typography, 1989.
/// Differs: F is in closed form for each kernel; the integral along an edge has none for a Gaussian
/// and is taken by Gauss' rule between the lines where the kernel is not smooth: within 1e-9 of the
/// integral of the kernel.
/// Conventions: coordinates in pixels from the centre of the pixel whose filter it is. The integral
/// over the whole plane is 1.

#include <array>

#include "alhazen/imaging/film/filter_kernel.h"

namespace alhazen {

class FilterIntegral {
  public:
    /// Throws Error (Usage) for a kernel without antiderivative in closed form.
    /// Precondition: radius > 0.
    FilterIntegral(const FilterEntry& entry, double radius);

    /// Pixels beside a pixel, along an axis, into which its filter reaches.
    [[nodiscard]] int reach() const { return reach_; }
    /// Over the strip lo <= x <= hi, or lo <= y <= hi; over a rectangle: the product of two.
    [[nodiscard]] double between(double lo, double hi) const {
        return scale_ * (integral(hi) - integral(lo));
    }
    /// The part of an edge of a loop around the region: the sum over all edges is the integral over
    /// the region, positive for what lies to the left of the edges.
    [[nodiscard]] double along(const Vec2& from, const Vec2& to) const;

  private:
    /// From the centre.
    [[nodiscard]] double integral(double x) const;

    const FilterEntry* entry_;
    double radius_;
    int reach_;
    double scale_ = 1;
    std::array<double, 5> knots_;  ///< between which the kernel is smooth
};

}  // namespace alhazen
