#include "alhazen/laboratory/tuning.h"

#include <array>
#include <cmath>
#include <utility>

namespace alhazen {
namespace {

/// Largest time, relative to the best so far, that counts as a saving; smaller savings are noise.
constexpr double kWorthwhile = 0.97;

struct TunedAccelerator {
    const char* name;
    std::vector<TuningStep> steps;
};

std::span<const TunedAccelerator> tuning_table() {
    static const std::array table{
        TunedAccelerator{"bounding_volumes",
                         {{"bound", {"sphere", "ellipsoid", "slabs7", "slabs13"}}}},
        TunedAccelerator{"hierarchy",
                         {{"bound", {"sphere", "slabs7", "slabs13"}}, {"order", {"stored"}}}},
        TunedAccelerator{"kay_kajiya", {{"slabs", {"3", "13"}}}},
        TunedAccelerator{"goldsmith_salmon", {{"orders", {"0", "10"}}, {"reinsert", {"2", "5"}}}},
        TunedAccelerator{"uniform_grid",
                         {{"density", {"1", "5", "10", "20", "50"}}, {"mailbox", {"off"}}}},
        TunedAccelerator{"nested_grid",
                         {{"density", {"1", "2", "5", "10"}},
                          {"leaf_size", {"2", "4", "16"}},
                          {"max_depth", {"2", "5"}},
                          {"planes", {"balanced"}},
                          {"mailbox", {"off"}}}},
        TunedAccelerator{
            "bsp", {{"planes", {"directions3", "directions7", "polygons"}}, {"mailbox", {"off"}}}},
        TunedAccelerator{"ray_classification",
                         {{"leaf_size", {"4", "16"}}, {"max_depth", {"6", "10"}}}},
        TunedAccelerator{"light_buffer", {{"others", {"kd_tree"}}, {"density", {"4", "64"}}}},
        TunedAccelerator{"ray_coherence", {{"others", {"kd_tree"}}, {"resolution", {"4", "16"}}}},
        TunedAccelerator{"list", {{"transform", {"z"}}}},
        TunedAccelerator{"octree",
                         {{"walk", {"neighbor_finding", "smart", "point_location"}},
                          {"max_depth", {"6", "10", "12"}},
                          {"leaf_size", {"2", "4", "8"}},
                          {"mailbox", {"off"}}}},
        TunedAccelerator{"kd_tree",
                         {{"traversal_cost", {"5", "10", "30"}},
                          {"empty_factor", {"0.5", "1"}},
                          {"mailbox", {"off"}}}},
    };
    return table;
}

}  // namespace

std::span<const TuningStep> tuning_steps(const std::string& accelerator) {
    for (const TunedAccelerator& tuned : tuning_table()) {
        if (accelerator == tuned.name) return tuned.steps;
    }
    return {};
}

TuningResult tune(const std::string& accelerator,
                  const std::function<double(const std::string&)>& cost,
                  const std::function<bool()>& more) {
    TuningResult result{accelerator};
    const std::span<const TuningStep> steps = tuning_steps(accelerator);
    if (steps.empty()) return result;
    double least = cost(accelerator);
    std::string settings;
    for (const TuningStep& step : steps) {
        std::string best = settings;
        const double before = least;
        for (const char* value : step.values) {
            if (!more()) {
                result.cut_short = true;
                break;
            }
            std::string tried = settings + (settings.empty() ? "" : ",");
            tried.append(step.setting).append("=").append(value);
            ++result.tried;
            const double found = cost(accelerator + ":" + tried);
            if (!(found < kWorthwhile * before) || !(found < least)) continue;
            least = found;
            best = std::move(tried);
        }
        settings = best;
    }
    if (!settings.empty()) result.accelerator += ":" + settings;
    return result;
}

}  // namespace alhazen
