#pragma once
/// Sampler, filter and stop rules of the options `--sampler NAME`,
/// `--filter NAME:radius=R,shared=on`, `--noise X`, `--time-limit 5m`.

#include <optional>
#include <string>

namespace alhazen {

struct FilterEntry;
struct SamplerEntry;

struct SamplingPlan {
    static constexpr double kLeastRadius = 0.01, kLargestRadius = 16.0;
    static constexpr double kLeastShared = 0.5, kLargestShared = 4.0;  ///< with `shared`
    /// Default largest number of samples per pixel with a stop rule.
    static constexpr int kMostByRule = 1 << 14;

    const SamplerEntry* sampler;
    const FilterEntry* filter;
    double radius;                  ///< of the filter, in pixels
    bool shared = false;            ///< samples count for all pixels in reach (shared_film.h)
    std::optional<double> noise;    ///< pixels above it get more samples (rounds.h)
    std::optional<double> seconds;  ///< no round begins that is expected to end later

    /// `sobol` and `box`.
    SamplingPlan();
    [[nodiscard]] bool has_rounds() const { return noise || seconds; }
};

/// Throws Error (Usage) if the plan shares samples. For renderers whose pixels are not means of
/// their own samples.
void refuse_shared_samples(const SamplingPlan& plan, const char* renderer);

/// The texts of the options; empty: not given.
struct SamplingTexts {
    std::string sampler, filter;
    std::optional<double> noise, seconds;
};
/// None if no option is given: the renderer's own samples. Throws Error (Usage).
[[nodiscard]] std::optional<SamplingPlan> parse_sampling(const SamplingTexts& texts);

}  // namespace alhazen
