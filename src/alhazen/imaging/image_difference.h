#pragma once
/// How far two pictures are apart.

#include <cstdint>

#include "alhazen/imaging/image.h"

namespace alhazen {

/// Differences over all pixels and the channels that both pictures have (at most RGB). Encoded pictures are
/// compared as encoded, in units of 1/255 for `max_steps`; linear ones by value.
struct ImageDifference {
    std::uint64_t pixels = 0;
    std::uint64_t identical = 0;        ///< pixels equal in every channel
    std::uint64_t within_one_step = 0;  ///< pixels at most 1/255 apart in every channel
    double max_absolute = 0;
    double mean_absolute = 0;
    double rmse = 0;
    double psnr_db = 0;                 ///< of a unit peak; infinite for equal pictures
};

/// Throws Error (Usage) when the sizes differ, or one picture is linear and the other encoded.
[[nodiscard]] ImageDifference difference(const Image& a, const Image& b);

/// |a - b| per channel, scaled so that the largest difference is 1.
[[nodiscard]] Image difference_image(const Image& a, const Image& b);

}  // namespace alhazen
