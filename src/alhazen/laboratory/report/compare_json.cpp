#include <nlohmann/json.hpp>

#include "alhazen/laboratory/report/compare_report.h"
#include "alhazen/session/statistics.h"

namespace alhazen {
namespace {

using json = nlohmann::ordered_json;

const char* variant_name(Measurement::Variant variant) {
    switch (variant) {
        case Measurement::Variant::Default:
            return "default";
        case Measurement::Variant::Tuned:
            return "tuned";
        case Measurement::Variant::Given:
            break;
    }
    return "given";
}

/// Totals over the counted rays.
json counts(const KindFigures& figures) {
    const TraversalStats& t = figures.tests;
    return {{"rays_counted", figures.counted},
            {"hits", figures.hits},
            {"rays_timed", figures.timed},
            {"seconds", figures.seconds},
            {"nanoseconds_per_ray", figures.nanoseconds()},
            {"tests",
             {{"box", t.box_tests},
              {"primitive", t.primitive_tests},
              {"primitive_hit", t.primitive_hits},
              {"mailbox_saved", t.mailbox_saved},
              {"node_visits", t.node_visits},
              {"empty_cells", t.empty_cells},
              {"slab", t.slab_tests},
              {"heap_pushes", t.heap_pushes},
              {"cache_lookups", t.cache_lookups},
              {"cache_hits", t.cache_hits}}}};
}

json per_ray(const ReplayFigures& f) {
    return {{"box", f.each(&TraversalStats::box_tests)},
            {"primitive", f.each(&TraversalStats::primitive_tests)},
            {"mailbox_saved", f.each(&TraversalStats::mailbox_saved)},
            {"node_visits", f.each(&TraversalStats::node_visits)},
            {"empty_cells", f.each(&TraversalStats::empty_cells)},
            {"slab", f.each(&TraversalStats::slab_tests)},
            {"heap_pushes", f.each(&TraversalStats::heap_pushes)},
            {"nanoseconds", f.nanoseconds()}};
}

json to_json(const Comparison& c, const Measurement& m) {
    json j{{"accelerator", m.accelerator}, {"settings", variant_name(m.variant)}};
    if (!m.unavailable.empty()) {
        j["unavailable"] = m.unavailable;
        return j;
    }
    j["build_seconds"] = m.build_seconds;
    j["accelerator_bytes"] = m.bytes;
    j["per_ray"] = per_ray(m.figures);
    const auto ratio = [&](const char* name) -> json {
        const Measurement* reference = c.find(name);
        if (reference == nullptr || reference->figures.nanoseconds() == 0) return nullptr;
        return m.figures.nanoseconds() / reference->figures.nanoseconds();
    };
    j["time_over_list"] = ratio("list");
    j["time_over_wide_bvh"] = ratio("wide_bvh");
    json kinds;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (c.recorded[k] > 0) kinds[kRayKindNames[k]] = counts(m.figures.kinds[k]);
    }
    j["by_kind"] = kinds;
    j["sampled"] = {{"counts", !m.figures.all_counted}, {"times", !m.figures.all_timed}};
    j["answers_that_differ"] = m.figures.disagreements;
    if (!m.figures.first_disagreement.empty()) {
        j["first_that_differs"] = m.figures.first_disagreement;
    }
    j["picture"] = {{"pixels_compared", m.picture.pixels},
                    {"pixels_that_differ", m.picture.differing},
                    {"complete", m.picture.complete},
                    {"same_ray_counts", m.picture.same_rays}};
    if (m.tried > 0) {
        j["search"] = {{"builds", m.tried}, {"cut_short", m.search_cut_short}};
    }
    j["agrees"] = m.agrees();
    return j;
}

json to_json(const Comparison& c) {
    json rays;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        rays[kRayKindNames[k]] = {{"cast", c.rays.rays[k].cast},
                                  {"hit", c.rays.rays[k].hit},
                                  {"recorded", c.recorded[k]}};
    }
    rays["refraction"]["total_internal"] = c.rays.total_internal;
    json accelerators = json::array();
    for (const Measurement& m : c.measurements) accelerators.push_back(to_json(c, m));
    return {{"scene", c.scene},
            {"width", c.width},
            {"height", c.height},
            {"effective_primitives", c.census.effective_primitives},
            {"stored_triangles", c.census.triangles},
            {"stored_shapes", c.census.analytic_shapes},
            {"scene_bytes", c.census.scene_bytes},
            {"rays", rays},
            {"accelerators", accelerators},
            {"all_agree", c.holds()}};
}

}  // namespace

json comparison_json(std::span<const Comparison> comparisons) {
    json scenes = json::array();
    for (const Comparison& c : comparisons) scenes.push_back(to_json(c));
    return {{"format", "alhazen comparison 1"},
            {"version", version()},
            {"threads", 1},
            {"scenes", scenes}};
}

}  // namespace alhazen
