#pragma once
/// The spectrum of sets of points.
///
/// Source: Ulichney, "Dithering with Blue Noise", Proc. IEEE 76(1), 1988 (periodogram, radial
/// mean).
/// Conventions: integer frequencies per unit square; independent points have power 1. Frequency 0
/// has no power. Radii are in units of the root of the number of points.
/// Complexity: O(n (2 reach + 1)^2) for a set of n points.

#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

class Periodogram {
  public:
    /// Covers frequencies from -reach to reach along both axes.
    explicit Periodogram(int reach);

    /// Adds the spectrum of a set to the mean.
    void add(std::span<const Vec2> points);

    [[nodiscard]] int reach() const { return reach_; }
    /// The mean power at a frequency; 0 if no set was added.
    [[nodiscard]] double power(int fx, int fy) const;
    /// [k] is the mean power at radii from k to k + 1 times root(points) / bins_of_root, up to the
    /// reach.
    [[nodiscard]] std::vector<double> radial_mean(std::size_t points, int bins_of_root) const;

  private:
    int reach_, sets_ = 0;
    std::vector<double> sums_;  ///< [fy + reach][fx], fx >= 0: the spectrum is symmetric
};

}  // namespace alhazen
