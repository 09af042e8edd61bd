#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/mapped_file.h"
#include "alhazen/formats/importer_list.h"
#include "alhazen/laboratory/claims/claims.h"
#include "alhazen/laboratory/compare.h"
#include "alhazen/laboratory/report/compare_page.h"
#include "alhazen/laboratory/report/compare_report.h"
#include "alhazen/laboratory/traversal_figure.h"
#include "alhazen/session/scene_files.h"
#include "commands.h"
#include "messages.h"
#include "options.h"
#include "progress_display.h"

namespace alhazen::cli {

namespace {

struct CompareArguments {
    std::vector<std::string> scenes, allow_paths;
    std::string accelerators = "all", size, protocol, json, html, claims, markdown, trace_ray, svg,
                along;
    CompareOptions compare;
    int depth = -1;
    bool no_tuning = false, quiet = false, strict = false;
    bool of_scenes = false;  ///< an option that --claim does not use was given
};

CompareOptions compare_options(const CompareArguments& args) {
    CompareOptions options = args.compare;
    options.accelerators = parse_accelerators(args.accelerators);
    options.tune = !args.no_tuning;
    if (!args.size.empty()) {
        const Size size = parse_size(args.size);
        options.trial.width = size.width;
        options.trial.height = size.height;
    }
    if (args.depth >= 0) options.trial.max_depth = args.depth;
    if (args.protocol == "spd") {
        if (!args.size.empty() || args.depth >= 0) {
            throw Error(ErrorKind::Usage, "the protocol fixes size and depth");
        }
        options.trial.spd = true;
    } else if (!args.protocol.empty()) {
        throw Error(ErrorKind::Usage, fmt::format("--protocol '{}': expected spd", args.protocol));
    }
    return options;
}

std::vector<std::filesystem::path> checked_outputs(const CompareArguments& args) {
    std::vector<std::filesystem::path> outputs;
    for (const std::string& name : {args.json, args.html, args.markdown, args.svg}) {
        if (name.empty() || name == "-") continue;
        check_writable(name);
        outputs.emplace_back(name);
    }
    check_distinct(outputs);
    return outputs;
}

/// Checks that a scene can be read, before long work on the first ones.
void check_readable(const std::string& scene) {
    (void)MappedFile::open(scene);
}

SceneDescription read_scene(const CompareArguments& args, const std::string& scene,
                            std::span<const std::filesystem::path> outputs) {
    LoadOptions options;
    options.import.allowed_folders.assign(args.allow_paths.begin(), args.allow_paths.end());
    options.strict = args.strict;
    Diagnostics diagnostics;
    SceneDescription description = load_description(scene, options, diagnostics);
    check_spares_scene(description, outputs);
    if (!args.quiet) print_warnings(diagnostics);
    return description;
}

struct PixelPlace {
    int x, y;
};

PixelPlace parse_pixel(const std::string& text) {
    PixelPlace pixel{};
    int read = 0;
    if (std::sscanf(text.c_str(), "%d,%d%n", &pixel.x, &pixel.y, &read) != 2 ||
        static_cast<std::size_t>(read) != text.size()) {
        throw Error(
            ErrorKind::Usage,
            fmt::format("--trace-ray '{}': expected X,Y in pixels from the top left", text));
    }
    return pixel;
}

/// Refuses options that have no effect.
void check_effects(const CompareArguments& args) {
    const auto need = [](bool has_effect, const char* message) {
        if (!has_effect) throw Error(ErrorKind::Usage, message);
    };
    const bool claims = !args.claims.empty();
    need(claims || !args.scenes.empty(), "compare needs scenes, or --claim");
    need(!claims || args.scenes.empty(), "--claim makes its own scenes: none can be given");
    need(claims || args.markdown.empty(), "--markdown is for --claim");
    const bool figure = !args.trace_ray.empty();
    need(figure == !args.svg.empty(), "--trace-ray needs --svg, and --svg needs --trace-ray");
    need(figure || args.along.empty(), "--along is for --trace-ray");
    need(!figure || (!claims && args.json.empty() && args.html.empty()),
         "--trace-ray makes a figure and nothing else");
    need(!claims || (args.json.empty() && args.html.empty()),
         "--json and --html are for scenes, --claim has --markdown");
    need(!claims || !args.of_scenes,
         "--claim makes its own scenes and chooses accelerators: of the options, --time-limit, "
         "--markdown and -q are for it");
}

int run_claims(const CompareArguments& args) {
    const std::vector<std::string> ids = parse_claims(args.claims);
    (void)checked_outputs(args);
    ProgressDisplay progress(args.quiet);
    ClaimOptions options;
    options.time_limit = args.compare.time_limit;
    options.progress = &progress;
    std::vector<ClaimReport> reports;
    (void)check_claims(ids, options, [&](const ClaimReport& report) {
        progress.finish();
        reports.push_back(report);
        if (args.markdown != "-") print("{}", claims_table({&report, 1}));
        // Writes the results so far, even if the rest fails or is stopped.
        if (!args.markdown.empty() && args.markdown != "-") {
            write_report(args.markdown, claims_markdown(reports));
        }
    });
    if (args.markdown == "-") write_report(args.markdown, claims_markdown(reports));
    const bool holds = std::all_of(reports.begin(), reports.end(), [](const ClaimReport& r) {
        return r.verdict == Verdict::Holds;
    });
    return holds ? kDone : kCheckFailed;
}

int run_figure(const CompareArguments& args) {
    CompareOptions options = compare_options(args);
    if (options.accelerators.size() != 1 || args.scenes.size() != 1) {
        throw Error(ErrorKind::Usage, "--trace-ray needs one scene, and --accelerators with one: " +
                                          traceable_accelerators());
    }
    const std::vector<std::filesystem::path> outputs = checked_outputs(args);
    const PixelPlace pixel = parse_pixel(args.trace_ray);
    options.trial.max_depth = 0;
    options.trial.most_rays = 1;
    const SceneTrial trial(read_scene(args, args.scenes.front(), outputs), options.trial);
    const TraversalTrace trace = trace_traversal(trial.reference(), options.accelerators.front(),
                                                 trial.eye_ray_of(pixel.x, pixel.y));
    const FigureView view =
        args.along.empty() ? natural_view(trace.ray) : parse_figure_view(args.along);
    write_report(args.svg, traversal_svg(trial.reference(), trace, view));
    return kDone;
}

std::string json_text(std::span<const Comparison> comparisons) {
    return comparison_json(comparisons)
               .dump(2, ' ', true, nlohmann::json::error_handler_t::replace) +
           "\n";
}

void write_reports(const CompareArguments& args, std::span<const Comparison> comparisons) {
    if (!args.json.empty() && args.json != "-") {
        write_report(args.json, json_text(comparisons));
    }
    if (!args.html.empty()) write_report(args.html, comparison_page(comparisons));
}

/// Writes the reports after every scene, so that results survive a later failure or stop.
int run_scenes(const CompareArguments& args) {
    CompareOptions options = compare_options(args);
    const std::vector<std::filesystem::path> outputs = checked_outputs(args);
    for (const std::string& scene : args.scenes) check_readable(scene);
    ProgressDisplay progress(args.quiet);
    options.progress = &progress;
    std::vector<Comparison> comparisons;
    for (const std::string& scene : args.scenes) {
        SceneDescription description = read_scene(args, scene, outputs);
        comparisons.push_back(
            compare(std::move(description), std::filesystem::path(scene).filename(), options));
        progress.finish();
        if (args.json != "-") print("{}\n", comparison_table(comparisons.back()));
        write_reports(args, comparisons);
    }
    if (args.json == "-") write_report(args.json, json_text(comparisons));
    const bool holds = std::all_of(comparisons.begin(), comparisons.end(),
                                   [](const Comparison& c) { return c.holds(); });
    if (!holds) tell("alhazen: the accelerators do not agree\n");
    return holds ? kDone : kCheckFailed;
}

int run(const CompareArguments& args) {
    check_effects(args);
    if (!args.trace_ray.empty()) return run_figure(args);
    return args.claims.empty() ? run_scenes(args) : run_claims(args);
}

}  // namespace

void add_compare(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "compare",
        "Measure accelerators side by side on the same rays; exit 0 only when they agree");
    const auto args = std::make_shared<CompareArguments>();
    command->add_option("scenes", args->scenes, "Scene files")->type_name("SCENE...");
    std::string footer = "Claims of the literature, measured again by --claim:";
    for (const ClaimEntry& entry : claims()) {
        footer += fmt::format("\n  {:<4} {}", entry.id, entry.claim);
    }
    command->footer(footer);
    command
        ->add_option("--claim", args->claims,
                     "Measure claims of the literature again: ID,ID,... or all; see below")
        ->type_name("LIST");
    command->add_option("--markdown", args->markdown, "Write the claims as a table; - for stdout")
        ->type_name("FILE");
    command
        ->add_option("--accelerators", args->accelerators,
                     "NAME,NAME:SETTING=VALUE,... or all; list and wide_bvh are always added")
        ->type_name("LIST")
        ->capture_default_str();
    command->add_flag("--no-tuning", args->no_tuning,
                      "Do not search the best settings of each accelerator");
    add_time_limit(*command, "--time-limit", args->compare.time_limit,
                   "Time for counting the rays of one accelerator, as much for timing them, and "
                   "for its picture; what takes longer is measured on a sample")
        ->capture_default_str()
        ->check(number_in(0.01, 1e6));
    command
        ->add_option("--size", args->size,
                     "Picture size in pixels; default: the scene's, at most 256")
        ->type_name("WxH");
    command->add_option("--depth", args->depth, "Recursion depth, 0 = eye rays only")
        ->type_name("N")
        ->check(CLI::Range(0, 1000));
    command->add_option("--camera", args->compare.trial.camera, "Camera by name or position")
        ->type_name("NAME|INDEX");
    command
        ->add_option("--protocol", args->protocol,
                     "Count as published: spd = 513x513 corner rays, depth 5")
        ->type_name("NAME");
    command
        ->add_option("--allow-path", args->allow_paths,
                     "Another folder that files named by the scene may lie in; may be repeated")
        ->type_name("DIR")
        ->expected(1)
        ->take_all();
    add_strict(*command, args->strict);
    command->add_option("--json", args->json, "Write the report as JSON; - for stdout")
        ->type_name("FILE");
    command->add_option("--html", args->html, "Write the report as one HTML page")
        ->type_name("FILE");
    command
        ->add_option("--trace-ray", args->trace_ray,
                     "Draw what one accelerator does for the eye ray of this pixel, from the top "
                     "left")
        ->type_name("X,Y");
    command->add_option("--svg", args->svg, "SVG file of the drawing")->type_name("FILE");
    command
        ->add_option("--along", args->along,
                     "View direction: x, y, z or isometric; default: across the ray")
        ->type_name("AXIS");
    add_quiet(*command, args->quiet);
    command->callback([args, command, &exit_status] {
        for (const char* name : {"--accelerators", "--no-tuning", "--size", "--depth", "--camera",
                                 "--protocol", "--allow-path", "--strict"}) {
            args->of_scenes = args->of_scenes || command->count(name) > 0;
        }
        exit_status = run(*args);
    });
}

}  // namespace alhazen::cli
