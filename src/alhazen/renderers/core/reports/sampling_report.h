#pragma once
/// Statistics of rounds of samples.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace alhazen {

struct SamplingReport {
    struct Round {
        std::uint32_t samples = 0;  ///< of each pixel
        std::uint64_t pixels = 0;   ///< that got them
        double seconds = 0;
    };

    std::vector<Round> rounds;
    bool stopped = false;            ///< the last round, before all its pixels
    std::uint64_t pixels = 0;        ///< of the crop
    std::uint64_t pixels_above = 0;  ///< pixels whose noise is above SamplingPlan::noise
    bool out_of_time = false;        ///< SamplingPlan::seconds ended the work
    std::uint32_t most_samples = 0;  ///< largest number of a pixel

    /// The number of rounds of which all pixels got their samples.
    [[nodiscard]] std::size_t finished_rounds() const { return rounds.size() - (stopped ? 1 : 0); }
    [[nodiscard]] std::uint64_t samples() const {
        std::uint64_t total = 0;
        for (const Round& round : rounds) total += round.samples * round.pixels;
        return total;
    }
};

}  // namespace alhazen
