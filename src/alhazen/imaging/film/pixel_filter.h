#pragma once
/// Pixel filters, which compute the value of a pixel from its samples. A filter is a small object,
/// initially black, that accumulates one pixel. PixelFilter is the interface.

#include <concepts>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// `add(sample)` adds a sample; it returns false if the sample is left out. `value()` is the value
/// of the pixel from the samples so far. Filters get only the samples of their own pixel, in order
/// of index.
template <class F>
concept PixelFilter = std::default_initializable<F> && requires(F& filter, const Rgb& sample) {
    { filter.add(sample) } -> std::same_as<bool>;
    { filter.value() } -> std::same_as<Rgb>;
};

/// The mean of the finite samples, a box filter one pixel wide. Black without samples.
class BoxFilter {
  public:
    bool add(const Rgb& sample) {
        if (!sample.is_finite()) return false;
        sum_ += sample;
        ++count_;
        return true;
    }
    [[nodiscard]] Rgb value() const {
        return count_ == 1 ? sum_ : count_ > 1 ? (1.0 / count_) * sum_ : Rgb{};
    }

  private:
    Rgb sum_;
    int count_ = 0;
};

static_assert(PixelFilter<BoxFilter>);

}  // namespace alhazen
