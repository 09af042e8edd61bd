#pragma once
/// The sum of a pixel's samples, with signs for the negative lobes of a filter.
///
/// Differs: for a kernel with negative lobes the value is the mean of the samples plus the signed
/// mean of their differences from it, divided by the mean sign. A uniform area keeps its colour
/// whatever the signs are; the expectation is off by O(1 / n), like that of the quotient of the
/// signed sums.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

struct SampleSum {
    Rgb plain, with_signs, squares;
    double signs = 0.0;
    std::uint32_t count = 0;

    /// Adds a sample; false if it is not finite and left out.
    bool add(const Rgb& sample, double sign) {
        if (!sample.is_finite()) return false;
        plain += sample;
        squares += sample * sample;
        with_signs += sign * sample;
        signs += sign;
        ++count;
        return true;
    }
    SampleSum& operator+=(const SampleSum& more) {
        plain += more.plain;
        squares += more.squares;
        with_signs += more.with_signs;
        signs += more.signs;
        count += more.count;
        return *this;
    }
    /// The standard deviation of a sample, of the channel where it is largest. 0 for fewer than
    /// two samples.
    [[nodiscard]] double deviation() const {
        if (count < 2) return 0.0;
        const Rgb sum = squares - (1.0 / count) * (plain * plain);
        return std::sqrt(std::max(0.0, sum.max()) / (count - 1));
    }
    /// The value of the pixel. `mean_sign`: of the kernel. Black without samples.
    [[nodiscard]] Rgb value(double mean_sign) const {
        if (count == 0) return {};
        const Rgb mean = (1.0 / count) * plain;
        if (mean_sign == 1.0) return mean;
        return mean + (1.0 / (mean_sign * count)) * (with_signs - signs * mean);
    }
};

}  // namespace alhazen
