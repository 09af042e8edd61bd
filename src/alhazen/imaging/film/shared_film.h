#pragma once
/// Samples that count for every pixel within reach of a filter: a pixel's value is the mean of the
/// samples around it, weighed by the filter.
///
/// Source: Pharr, Jakob and Humphreys, "Physically Based Rendering", 3rd edition, 2016, section 7.8
/// (the weighted mean).
/// Differs: sums are exact (fixed_sum.h), so that the order of the samples does not matter.
/// Where samples differ by chance alone, the variance of a pixel is that of a sample of its own
/// times the integral of the square of the filter (whose own integral is 1).
/// Conventions: the picture expected is that of samples drawn by the filter (filter_kernel.h), off
/// by O(1 / n), as the mean's weight is that of the samples themselves.
/// Beyond the crop there are no samples: pixels at its border are means of those on one side.
/// Threads: `add` may be called from many.

#include <cstdint>
#include <vector>

#include "alhazen/imaging/film/film.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/imaging/film/fixed_sum.h"
#include "alhazen/math/vec.h"

namespace alhazen {

class SharedFilm {
  public:
    /// Precondition: the kernel is nowhere negative, and no radius below 0.5: else the weight of a
    /// pixel may be 0, or nearly.
    SharedFilm(const FilterEntry& filter, double radius, const PixelBox& crop);

    /// What the samples of one pixel add to the pixels around it.
    class Spread {
      public:
        explicit Spread(const SharedFilm& film);
        /// `offset`: of the sample from the centre of its pixel, in pixels, y up, at most 0.5 each
        /// way. Not for samples that are not finite.
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
    /// Adds the samples of pixel (x, y) and empties `spread`. False where one is too large to be
    /// summed: that share is left out.
    bool add(int x, int y, Spread& spread);

    /// Writes all pixels that samples reach. While nobody adds.
    void write(Film& film) const;

  private:
    struct Pixel {
        FixedSum r, g, b, weight;
    };

    /// The kernel at a distance along one axis, from a table; its scale has no meaning.
    [[nodiscard]] double kernel(double distance) const;

    double radius_;
    int reach_;                  ///< pixels on each side
    std::vector<double> table_;  ///< [from 0 to the radius]
    PixelBox crop_;
    std::vector<Pixel> pixels_;  ///< [pixel of the crop]
};

}  // namespace alhazen
