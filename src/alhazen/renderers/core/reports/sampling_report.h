#pragma once
/// What rounds of samples report besides the picture.

#include <cstdint>
#include <vector>

namespace alhazen {

struct SamplingReport {
    struct Round {
        std::uint32_t samples = 0;  ///< of each pixel in it
        std::uint64_t pixels = 0;
        double seconds = 0;
    };

    std::vector<Round> rounds;       ///< the finished ones
    std::uint64_t pixels = 0;        ///< of the crop
    std::uint64_t pixels_above = 0;  ///< that still want samples for SamplingPlan::noise
    bool out_of_time = false;        ///< SamplingPlan::seconds ended the work
    std::uint32_t most_samples = 0;  ///< of a pixel

    [[nodiscard]] std::uint64_t samples() const {
        std::uint64_t total = 0;
        for (const Round& round : rounds) total += round.samples * round.pixels;
        return total;
    }
};

}  // namespace alhazen
