#pragma once
/// A film whose samples contribute to every pixel within reach of a filter: the value of a pixel is
/// the mean of the samples around it, weighted by the filter.
///
/// Source: Pharr, Jakob and Humphreys, "Physically Based Rendering", 3rd edition, 2016, section 7.8
/// (the weighted mean).
/// Differs: sums are exact (binned_sum.h), so that the order of the samples does not matter. If
/// samples differ by chance only, the variance of a pixel is that with its own samples only times
/// the integral of the square of the filter (whose own integral is 1).
/// Conventions: the expected picture is that of samples drawn by the filter (filter_kernel.h), to
/// within O(1 / n), because the weight of the mean is that of the samples themselves. There are no
/// samples beyond the crop: pixels at its border are means of those on one side.
/// Threads: `add` may be called from several threads.

#include <cstdint>
#include <vector>

#include "alhazen/imaging/film/binned_sum.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/math/vec.h"

namespace alhazen {

class SharedFilm {
  public:
    /// Precondition: the kernel is nowhere negative and the radius at least 0.5; otherwise the
    /// weight of a pixel may be 0 or nearly 0.
    SharedFilm(const FilterEntry& filter, double radius, const PixelBox& crop);

    /// The contribution of the samples of one pixel to the pixels around it.
    class Spread {
      public:
        explicit Spread(const SharedFilm& film);
        /// Adds a finite sample. `offset`: of the sample from the centre of its pixel, in pixels, y
        /// up, each coordinate in [-0.5, 0.5].
        void add(const Vec2& offset, const Rgb& sample);

      private:
        friend class SharedFilm;
        struct Sum {
            Rgb color;
            double weight = 0;
        };
        const SharedFilm& film_;
        std::vector<Sum> sums_;             ///< [row][column] around the pixel
        std::vector<double> column_, row_;  ///< the kernel at one sample
    };
    /// Adds the samples of pixel (x, y) and clears `spread`. False if a sum is not finite
    /// and therefore left out.
    bool add(int x, int y, Spread& spread);

    /// Writes all pixels that samples reach. Not to be called during `add`.
    void write(Film& film) const;

  private:
    using Pixel = BinnedSum<4>;  ///< of the colour and the weight

    /// The kernel at a distance along one axis, from a table; its scale is arbitrary.
    [[nodiscard]] double kernel(double distance) const;

    double radius_;
    int reach_;                  ///< pixels on each side
    std::vector<double> table_;  ///< [distance] from 0 to the radius
    PixelBox crop_;
    std::vector<Pixel> pixels_;  ///< [pixel of the crop]
};

}  // namespace alhazen
