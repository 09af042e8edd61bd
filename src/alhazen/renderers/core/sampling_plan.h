#pragma once
/// Samplers, filters and stop rules as users ask for them: `--sampler NAME`,
/// `--filter NAME:radius=R,shared=on`, `--noise X`, `--time 5m`.

#include <optional>
#include <string>

namespace alhazen {

struct FilterEntry;
struct SamplerEntry;

struct SamplingPlan {
    static constexpr double kLeastRadius = 0.01, kLargestRadius = 16.0;
    static constexpr double kLeastShared = 0.5, kLargestShared = 4.0;  ///< with `shared`
    /// Samples per pixel at most where a stop rule decides and nothing else is said.
    static constexpr int kMostByRule = 1 << 14;

    const SamplerEntry* sampler;
    const FilterEntry* filter;
    double radius;                  ///< of the filter, in pixels
    bool shared = false;            ///< samples count for all pixels in reach (shared_film.h)
    std::optional<double> noise;    ///< pixels above it get more samples
    std::optional<double> seconds;  ///< no round begins that would not end by then

    /// `sobol` and `box`.
    SamplingPlan();
    [[nodiscard]] bool has_rounds() const { return noise || seconds; }
};

/// Throws Error (Usage) where the plan shares samples: for a renderer whose pixels are not means of
/// samples of their own.
void refuse_shared_samples(const SamplingPlan& plan, const char* renderer);

/// The texts of the options; empty where not given. Throws Error (Usage).
struct SamplingTexts {
    std::string sampler, filter;
    std::optional<double> noise, seconds;
};
/// None where nothing is given: the renderer's own samples.
[[nodiscard]] std::optional<SamplingPlan> parse_sampling(const SamplingTexts& texts);

}  // namespace alhazen
