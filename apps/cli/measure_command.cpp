#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/session/scene_files.h"
#include "alhazen/solids/measure_report.h"
#include "alhazen/solids/solid_queries_json.h"
#include "commands.h"
#include "messages.h"
#include "options.h"
#include "progress_display.h"
#include "stop_signals.h"

namespace alhazen::cli {

namespace {

/// More solids are measured only if named, or with --all.
constexpr std::size_t kMostSolids = 64;

struct MeasureArguments {
    SceneArguments scene;
    std::vector<std::string> objects;
    std::vector<std::string> overlaps, clearances;
    std::string section, json;
    double error = 1e-4, time_limit = 2;
    std::optional<double> density;
    std::uint64_t seed = 1;
    bool all = false, quiet = false;
};

/// Two solids by name or number, separated by a comma.
std::pair<SolidId, SolidId> find_pair(const SolidScene& scene, const std::string& text) {
    for (std::size_t comma = text.find(','); comma != std::string::npos;
         comma = text.find(',', comma + 1)) {
        const std::string words[2] = {text.substr(0, comma), text.substr(comma + 1)};
        const auto a = scene.select(std::span(words, 1));
        const auto b = scene.select(std::span(words + 1, 1));
        if (a.size() == 1 && b.size() == 1) return {a[0], b[0]};
        throw Error(ErrorKind::Usage,
                    fmt::format("'{}': expected two solids; '{}' names {}, '{}' names {}", text,
                                words[0], a.size(), words[1], b.size()));
    }
    throw Error(ErrorKind::Usage, fmt::format("'{}': expected two solids apart by a comma", text));
}

SolidReport measure_solid(const SolidScene& scene, SolidId id, const MeasureArguments& args,
                          const MeasureOptions& options, const std::optional<SectionPlane>& plane) {
    const Stopwatch time;
    const IsolatedSolid solid(scene.solids(), id);
    SolidReport report;
    report.solid = id;
    report.name = scene.name(id);
    report.densities = args.density ? std::vector{args.density} : scene.densities(id);
    report.measures = measure(solid, options);
    if (plane) report.section = section_area(solid, *plane, options);
    report.seconds = time.seconds();
    return report;
}

struct WantedPair {
    std::pair<SolidId, SolidId> solids;
    bool overlap = false;  ///< true: measures the overlap; false: the clearance
};

/// Resolves all pairs before measuring, as names may be wrong.
std::vector<WantedPair> find_pairs(const SolidScene& scene, const MeasureArguments& args) {
    std::vector<WantedPair> pairs;
    for (const std::string& text : args.overlaps) pairs.push_back({find_pair(scene, text), true});
    for (const std::string& text : args.clearances) {
        pairs.push_back({find_pair(scene, text), false});
    }
    return pairs;
}

void measure_pairs(const SolidScene& scene, const MeasureArguments& args,
                   const MeasureOptions& options, const std::vector<WantedPair>& pairs,
                   MeasureReport& report) {
    for (const WantedPair& wanted : pairs) {
        const auto [a, b] = wanted.solids;
        const IsolatedSolid solid_a(scene.solids(), a), solid_b(scene.solids(), b);
        PairReport pair{a, b, scene.name(a), scene.name(b), {}, {}};
        if (wanted.overlap) {
            MeasureOptions volume_only = options;
            volume_only.area = false;
            pair.overlap = measure(Overlap(solid_a, solid_b), volume_only);
        } else {
            pair.clearance = clearance(solid_a, solid_b, args.seed);
        }
        report.pairs.push_back(std::move(pair));
    }
}

MeasureReport measure_all(const SolidScene& scene, const MeasureArguments& args,
                          ProgressDisplay& progress) {
    MeasureReport report;
    report.open_surfaces = scene.solids().open_surfaces();
    report.open_meshes = scene.open_meshes();
    std::optional<SectionPlane> plane;
    if (!args.section.empty()) {
        const auto n = parse_numbers(args.section, {4}, "a plane: nx,ny,nz,d");
        plane = SectionPlane{{n[0], n[1], n[2]}, n[3]};
        (void)frame_of(*plane);
    }
    const std::vector<WantedPair> pairs = find_pairs(scene, args);
    const MeasureOptions options{.relative_error = args.error,
                                 .seconds = args.time_limit,
                                 .area = true,
                                 .seed = args.seed,
                                 .stop = &stop_on_signals()};
    const bool only_pairs =
        args.objects.empty() && (!args.overlaps.empty() || !args.clearances.empty());
    if (!only_pairs) {
        if (scene.solids().count() == 0) {
            throw Error(ErrorKind::Scene,
                        fmt::format("the scene has no solid: {} no volume{}{}",
                                    report.open_surfaces == 1
                                        ? "1 surface bounds"
                                        : counted(report.open_surfaces, "surface") + " bound",
                                    report.open_meshes.empty() ? "" : "\n",
                                    fmt::join(report.open_meshes, "\n")));
        }
        if (args.objects.empty() && !args.all && scene.solids().count() > kMostSolids) {
            throw Error(ErrorKind::Usage,
                        fmt::format("the scene has {} solids: name those to measure, or --all",
                                    scene.solids().count()));
        }
        const auto chosen = scene.select(args.objects);
        for (std::size_t i = 0; i < chosen.size() && !options.stop->requested(); ++i) {
            progress.update("measure", i, chosen.size());
            report.solids.push_back(measure_solid(scene, chosen[i], args, options, plane));
        }
        progress.update("measure", chosen.size(), chosen.size());
    }
    measure_pairs(scene, args, options, pairs, report);
    return report;
}

void add_measure_options(CLI::App& command, MeasureArguments& args) {
    command
        .add_option("objects", args.objects,
                    "Solids by number, name, or the beginning or end of a name; default: all")
        ->type_name("OBJECT");
    command.add_option("--error", args.error, "Relative error of volume and area to work for")
        ->type_name("E")
        ->capture_default_str()
        ->check(number_in(1e-12, 1.0));
    add_time_limit(command, "--time-limit,--budget", args.time_limit,
                   "Time for each solid at the most; --budget is the older name")
        ->capture_default_str()
        ->check(number_in(0.0, 1e9));
    command.add_option("--density", args.density, "Of all solids, instead of their materials'")
        ->type_name("X")
        ->check(number_in(0.0, 1e300));
    command.add_option("--section", args.section, "Also the area that this plane cuts out")
        ->type_name("NX,NY,NZ,D");
    command.add_option("--overlap", args.overlaps, "Volume that two solids share; may be repeated")
        ->type_name("A,B")
        ->take_all()
        ->allow_extra_args(false);
    command
        .add_option("--clearance", args.clearances,
                    "Smallest distance of two solids, from below and above; may be repeated")
        ->type_name("A,B")
        ->take_all()
        ->allow_extra_args(false);
    command.add_option("--seed", args.seed, "Seed of the lines")
        ->type_name("N")
        ->capture_default_str()
        ->check(unsigned_number());
    command.add_flag("--all", args.all, "Measure all solids, however many");
    command.add_option("--json", args.json, "Write the report as JSON; - for stdout")
        ->type_name("FILE");
    add_quiet(command, args.quiet);
}

}  // namespace

void add_measure(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "measure",
        "Volume, area, centroid, inertia, mass of solids, with 95 % intervals; exit 1 when a check "
        "of them fails");
    const auto args = std::make_shared<MeasureArguments>();
    args->scene.add_to(*command, kDefaultAccelerator);
    add_measure_options(*command, *args);
    command->callback([args, &exit_status] {
        if (!args->json.empty() && args->json != "-") check_writable(args->json);
        const LoadedScene loaded = load(args->scene.scene, args->scene.load_options());
        if (!args->json.empty() && args->json != "-") {
            const std::filesystem::path output = args->json;
            check_spares_scene(loaded.description, std::span(&output, 1));
        }
        if (!args->quiet) print_warnings(loaded.diagnostics);
        ProgressDisplay progress(args->quiet);
        MeasureReport report;
        ThreadLimit(args->scene.threads).run([&] {
            const SolidScene scene(loaded.description, loaded.scene);
            report = measure_all(scene, *args, progress);
        });
        progress.finish();
        if (args->json != "-") print("{}", measure_text(report));
        if (!args->json.empty()) {
            write_report(args->json,
                         measure_json(report).dump(
                             2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) +
                             "\n");
        }
        exit_status = stop_on_signals().requested() ? kStopped
                      : report.holds()              ? kDone
                                                    : kCheckFailed;
    });
}

}  // namespace alhazen::cli
