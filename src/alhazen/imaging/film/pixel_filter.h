#pragma once
/// Pixel filters: how the samples of a pixel become its value.
///
/// A filter is a small value, black when made; one gathers one pixel. PixelFilter states the
/// interface.

#include <concepts>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// `add(sample)` takes a sample and returns false where it leaves it out. `value()`: of the pixel,
/// from the samples so far. Filters see the samples of their own pixel only, in order of number.
template <class F>
concept PixelFilter = std::default_initializable<F> && requires(F& filter, const Rgb& sample) {
    { filter.add(sample) } -> std::same_as<bool>;
    { filter.value() } -> std::same_as<Rgb>;
};

/// The mean of the finite samples: a box one pixel wide. Black without any.
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
