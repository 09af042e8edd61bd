#pragma once
/// Contributions to arbitrary points of a film, in any order and from any thread; sums are
/// bit-identical.

#include <cstdint>
#include <vector>

#include "alhazen/imaging/film/binned_sum.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/math/vec.h"
#include "alhazen/renderers/core/sampling_plan.h"

namespace alhazen {

class SplatFilm {
  public:
    SplatFilm(const Film& film, const SamplingPlan& plan);

    /// Adds `light` at film coordinates `place` in [0, 1], y up. False if it is not finite.
    bool add(const Vec2& place, const Rgb& light);

    /// Adds the mean over `paths` paths to the pixels of `film`.
    void add_to(Film& film, double paths) const;

  private:
    using Sum = BinnedSum<3>;
    [[nodiscard]] double kernel(double offset) const;

    const FilterEntry& filter_;
    double radius_;
    double scale_ = 1;  ///< makes the integral of the kernel 1
    int width_, height_;
    PixelBox crop_;
    std::vector<Sum> sums_;  ///< [pixel of the crop]
};

}  // namespace alhazen
