#include "alhazen/session/statistics.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "alhazen/aggregates/accelerator_bytes.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/reports/antialias_report.h"
#include "alhazen/renderers/core/reports/beam_report.h"
#include "alhazen/renderers/core/reports/sampling_report.h"
#include "alhazen/renderers/core/reports/scan_line_report.h"
#include "alhazen/sampling/samplers/sampler.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/unique_bytes.h"

namespace alhazen {

const char* version() {
    return ALHAZEN_VERSION;
}

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

namespace {

using json = nlohmann::ordered_json;

/// Null if the renderer has none.
nlohmann::ordered_json beams_json(const RenderResult& result) {
    if (!result.beams) return nullptr;
    const BeamReport& r = *result.beams;
    return {{"polygons", r.polygons},
            {"tree_splits", r.tree_splits},
            {"tree_pieces", r.tree_pieces},
            {"tree_nodes", r.tree_nodes},
            {"tree_depth", r.tree_depth},
            {"eye_beams", r.eye_beams},
            {"reflected_beams", r.reflected_beams},
            {"refracted_beams", r.refracted_beams},
            {"shadow_beams", r.shadow_beams},
            {"pieces", r.pieces},
            {"hulls_tested", r.hulls_tested},
            {"hulls_missed", r.hulls_missed},
            {"polygons_tested", r.polygons_tested},
            {"cuts", r.cuts},
            {"seen_area", r.seen_area},
            {"gather_seconds", r.gather_seconds},
            {"beam_seconds", r.beam_seconds}};
}

/// null: without adaptive supersampling.
nlohmann::ordered_json antialias_json(const SceneDescription& description,
                                      const RenderResult& result) {
    if (!result.antialias) return nullptr;
    const AntialiasReport& r = *result.antialias;
    json whole{
        {"rays_by_level", r.points},
        {"divided_by_level", r.divided},
        {"rays_per_pixel", static_cast<double>(r.eye_rays()) / static_cast<double>(r.pixels)}};
    if (!r.guarantee) return whole;
    json named = json::array();
    for (const UnmetObject& unmet : r.unmet) {
        named.push_back({{"part", unmet.part + 1},
                         {"name", part_name(description, unmet.part)},
                         {"instance", unmet.instance + 1},
                         {"pixel", {unmet.x, unmet.y}}});
    }
    whole["guarantee"] = {{"objects", r.objects},
                          {"endless", r.unbounded},
                          {"met", r.met},
                          {"searching_rays", r.searching},
                          {"looked_for", r.sought},
                          {"passed_over", r.passed_over},
                          {"below_depth", r.below_depth},
                          {"below_depth_pixels", r.below_depth_pixels},
                          {"below_depth_named", named},
                          {"seconds", r.seconds}};
    return whole;
}

/// null: without a sampler, a filter or a stop rule by name.
nlohmann::ordered_json sampling_json(const RenderOptions& options, const RenderResult& result) {
    if (!result.sampling || !options.sampling) return nullptr;
    const SamplingReport& r = *result.sampling;
    json rounds = json::array();
    for (const SamplingReport::Round& round : r.rounds) {
        rounds.push_back(
            {{"samples", round.samples}, {"pixels", round.pixels}, {"seconds", round.seconds}});
    }
    const auto mean = static_cast<double>(r.samples()) / static_cast<double>(r.pixels);
    return {{"sampler", options.sampling->sampler->name},
            {"filter", options.sampling->filter->name},
            {"filter_radius", options.sampling->radius},
            {"filter_shared", options.sampling->shared},
            {"rounds", rounds},
            {"samples_per_pixel", mean},
            {"most_samples", r.most_samples},
            {"pixels_above_noise", r.pixels_above},
            {"out_of_time", r.out_of_time}};
}

}  // namespace

nlohmann::ordered_json statistics(const std::string& scene_name, const LoadedScene& loaded,
                                  const RenderOptions& options, const RenderResult& result,
                                  double write_seconds) {
    const RayCounters& counters = result.counters;
    json rays;
    for (std::size_t i = 0; i < kRayKindNames.size(); ++i) {
        rays[kRayKindNames[i]] = {{"cast", counters.rays[i].cast}, {"hit", counters.rays[i].hit}};
    }
    rays["refraction"]["total_internal"] = counters.total_internal;
    const TraversalStats& tests = counters.tests;
    json tests_json;  // null: not counted
    if (options.count_tests || options.aovs.has_tests()) {
        tests_json = {{"box", tests.box_tests},
                      {"primitive", tests.primitive_tests},
                      {"primitive_hit", tests.primitive_hits},
                      {"mailbox_saved", tests.mailbox_saved},
                      {"node_visits", tests.node_visits},
                      {"empty_cells", tests.empty_cells},
                      {"slab", tests.slab_tests},
                      {"heap_pushes", tests.heap_pushes},
                      {"cache_lookups", tests.cache_lookups},
                      {"cache_hits", tests.cache_hits}};
    }
    SceneCensus census = loaded.scene.census;
    const bool has_aggregate = loaded.scene.aggregate != nullptr;
    // Some accelerators build their lists while rays are traced.
    if (has_aggregate) census.accelerator_bytes = accelerator_bytes(*loaded.scene.aggregate);
    const std::optional<double> each = bytes_per_effective_primitive(census);
    const json bytes_each = each ? json(*each) : json(nullptr);
    json scan_lines;  // null: the renderer has none
    if (result.scan_lines) {
        const ScanLineReport& r = *result.scan_lines;
        scan_lines = {{"scan_lines", r.lines.size()},
                      {"flatness", r.flatness},
                      {"passes", r.passes},
                      {"patches", r.patches},
                      {"patches_split_u", r.split_u},
                      {"patches_split_v", r.split_v},
                      {"polygons_of_patches", r.quads},
                      {"polygons_of_scene", r.facets},
                      {"most_patches", r.most_patches},
                      {"most_active_patches", r.most_active},
                      {"most_polygons", r.most_polygons},
                      {"most_patches_and_polygons", r.most_held},
                      {"most_bytes", r.most_bytes},
                      {"crack_samples", r.counted_cracks ? json(r.crack_samples) : json()}};
    }
    return {
        {"scene", scene_name},
        {"renderer", options.renderer},
        {"accelerator", has_aggregate ? json(loaded.scene.accelerator) : json(nullptr)},
        {"build", has_aggregate ? json(name_of(loaded.quality)) : json(nullptr)},
        {"threads", result.threads},
        {"version", version()},
        {"width", result.film.crop().width()},
        {"height", result.film.crop().height()},
        {"samples_per_pixel", options.samples_per_pixel},
        {"seed", options.seed},
        {"complete", result.complete},
        {"rays", rays},
        {"tests", tests_json},
        {"scan_lines", scan_lines},
        {"beams", beams_json(result)},
        {"antialias", antialias_json(loaded.description, result)},
        {"sampling", sampling_json(options, result)},
        {"aov_rays", counters.aov_rays},
        {"non_finite_samples", counters.non_finite},
        {"notes", result.notes},
        {"remarks", result.remarks},
        {"memory",
         {{"accelerator_bytes", census.accelerator_bytes},
          {"scene_bytes", census.scene_bytes},
          {"peak_rss_bytes", peak_rss_bytes()},
          {"effective_primitives", census.effective_primitives},
          {"unique_bytes", unique_bytes(census)},
          {"bytes_per_effective_primitive", bytes_each}}},
        {"seconds",
         {{"load", loaded.load_seconds},
          {"build", loaded.build_seconds},
          {"render", result.seconds},
          {"render_processor", result.processor_seconds},
          {"write", write_seconds}}},
    };
}

}  // namespace alhazen
