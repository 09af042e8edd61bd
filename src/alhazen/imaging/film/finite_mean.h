#pragma once
/// The value of a pixel from its samples: a small object, initially black, accumulates one pixel.

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// The mean of the finite samples. Black without samples.
class FiniteMean {
  public:
    /// False if the sample is left out.
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

}  // namespace alhazen
