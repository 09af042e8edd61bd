#include "alhazen/renderers/core/antialias_settings.h"

#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/imaging/film/filter_integral.h"
#include "alhazen/renderers/core/renderer_settings.h"
#include "alhazen/renderers/core/sampling_plan.h"

namespace alhazen {

namespace {

void read_exact_filter(RendererSettings& given, AntialiasSettings& settings) {
    std::vector<const char*> names;
    for (const FilterEntry& entry : filters()) names.push_back(entry.name);
    const FilterEntry& filter = filters()[given.choice("filter", 0, names)];
    settings.radius = given.number("radius", filter.radius, SamplingPlan::kLeastRadius,
                                   SamplingPlan::kLargestRadius);
    if (filter.name == std::string("box") && settings.radius == filter.radius) return;
    static_cast<void>(FilterIntegral(filter, settings.radius));  // throws if it has no integral
    settings.filter = &filter;
}

}  // namespace

AntialiasSettings parse_antialias(const std::string& text) {
    static constexpr const char *kSwitch[] = {"off", "on"}, *kGuarantee[] = {"off", "on", "all"};
    RendererSettings given(text, "--antialias");
    AntialiasSettings settings;
    if (given.name() == "exact") {
        settings.exact = true;
        settings.error = given.number("error", settings.error, 1e-9, 1.0);
        read_exact_filter(given, settings);
        given.finish();
        return settings;
    }
    if (given.name() == "pixel_selection") {
        settings.threshold = given.number("threshold", 0.05, 0.0, 1.0);
        settings.step = given.whole("step", 8, 1, AntialiasSettings::kLargestStep);
        given.finish();
        return settings;
    }
    if (given.name() != "whitted") {
        throw Error(ErrorKind::Usage, "--antialias '" + given.name() +
                                          "': unknown; known: whitted, exact, pixel_selection");
    }
    settings.threshold = given.number("threshold", settings.threshold, 0.0, 1.0);
    settings.depth = given.whole("depth", settings.depth, 0, AntialiasSettings::kDeepest);
    const std::size_t guarantee = given.choice("guarantee", 1, kGuarantee);
    settings.guarantee = guarantee > 0;
    settings.behind_all = guarantee == 2;
    settings.weigh = given.choice("weigh", 1, kSwitch) == 1;
    settings.neighbours = given.choice("neighbours", 1, kSwitch) == 1;
    given.finish();
    return settings;
}

}  // namespace alhazen
