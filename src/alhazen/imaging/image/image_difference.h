#pragma once
/// Measures of the difference between two images.
///
/// Conventions: compares colours, not alpha; grey counts as three equal channels if the other image
/// has colour. Encoded images are compared as encoded, linear ones by value. Equal infinities and
/// two NaNs are equal; NaN and a number, or different infinities, differ by infinity.

#include <cstdint>

#include "alhazen/imaging/image/image.h"

namespace alhazen {

struct ImageDifference {
    std::uint64_t pixels = 0;
    std::uint64_t identical = 0;        ///< pixels equal in every channel
    std::uint64_t within_one_step = 0;  ///< pixels at most 1/255 apart in every channel
    double max_absolute = 0;
    double mean_absolute = 0;
    double rmse = 0;
    double psnr_db = 0;  ///< of a unit peak; infinite for equal pictures
};

/// Throws Error (Usage) if the sizes differ, or one image is linear and the other encoded.
[[nodiscard]] ImageDifference difference(const Image& a, const Image& b);

/// |a - b| per channel, scaled such that the largest finite difference is 1; infinite differences
/// are 1. Throws as `difference`.
[[nodiscard]] Image difference_image(const Image& a, const Image& b);

}  // namespace alhazen
