#pragma once
/// Searches for the settings of an accelerator that take the least time for the rays of a scene.
///
/// Source: settings that the authors and users of each structure vary: Havran and Sixta,
/// "Comparison of Hierarchical Grids", Ray Tracing News 12(1), 1999 (densities, depths, objects in
/// a leaf); Kay and Kajiya 1986 (slabs); Goldsmith and Salmon 1987 (orders of insertion).
/// Differs: coordinate search in the order of the table: each value of a setting is built and timed
/// on a sample of the rays; the fastest is kept if it saves at least 3 %.
/// Conventions: times are of the rays, not of the build: a setting with a slow build may win. To
/// tune a new accelerator, add an entry to the table in tuning.cpp.

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace alhazen {

/// A setting and its values to try besides the default.
struct TuningStep {
    const char* setting;
    std::vector<const char*> values;
};

/// The steps in the order of trial; empty for an accelerator without settings to try.
[[nodiscard]] std::span<const TuningStep> tuning_steps(const std::string& accelerator);

struct TuningResult {
    std::string accelerator;  ///< with the best settings found; bare if these are the defaults
    int tried = 0;            ///< number of builds
    bool cut_short = false;   ///< true: `more` ended the search
};

/// Runs the search. `cost(accelerator)` is the time of the sample, infinite if the settings cannot
/// be built. The search ends when `more()` is false.
[[nodiscard]] TuningResult tune(const std::string& accelerator,
                                const std::function<double(const std::string&)>& cost,
                                const std::function<bool()>& more);

}  // namespace alhazen
