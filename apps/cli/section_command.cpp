#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/control_characters.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/session/scene_files.h"
#include "alhazen/solids/section.h"
#include "alhazen/solids/solid_queries_json.h"
#include "commands.h"
#include "messages.h"
#include "options.h"
#include "stop_signals.h"

namespace alhazen::cli {

namespace {

struct SectionArguments {
    SceneArguments scene;
    std::vector<std::string> objects;
    std::string plane, output, svg, json, size = "800x800", camera;
    SvgOptions svg_options;
    std::optional<double> tolerance;
    int grid = 256;
    double error = 1e-6, time_limit = 1;
    bool quiet = false;
};

/// The cut of one solid.
struct Cut {
    SolidId solid{};
    std::string name;
    SectionArea area;
};

Image picture_of(const SolidScene& solids, const LoadedScene& loaded, const SectionPlane& plane,
                 const SectionArguments& args) {
    const Size size = parse_size(args.size);
    SectionView view{.width = size.width, .height = size.height};
    if (!args.camera.empty()) {
        const CameraDescription& camera = find_camera(loaded.scene, args.camera);
        view.camera = with_aspect(camera.camera, camera.aspect,
                                  static_cast<double>(size.width) / size.height);
    }
    return section_picture(solids, loaded.scene, plane, view);
}

/// The solids that may have an outline, and their box.
struct Chosen {
    std::vector<SolidId> solids;
    Box3 box;
};

Chosen choose(const SolidScene& solids, const std::vector<std::string>& objects) {
    Chosen chosen;
    for (const SolidId id : solids.select(objects)) {
        const Box3 box = IsolatedSolid(solids.solids(), id).box();
        if (box.empty()) continue;
        if (!box.bounded()) {
            tell("alhazen: '{}' is not bounded: it has neither area nor outline\n",
                 escape_controls(solids.name(id)));
            continue;
        }
        chosen.solids.push_back(id);
        chosen.box.include(box);
    }
    return chosen;
}

/// Checks the tolerance before any measurement.
void check_tolerance(const Box3& box, std::optional<double> tolerance) {
    if (!tolerance || *tolerance >= least_tolerance(box)) return;
    throw Error(ErrorKind::Usage,
                fmt::format("--tolerance {}: expected at least {:.3g}, 1e-9 of the size of the "
                            "solids",
                            *tolerance, least_tolerance(box)));
}

/// Cut areas in the order of the solids, without solids that the plane misses.
std::vector<Cut> cut_solids(const SolidScene& solids, const Chosen& chosen,
                            const SectionPlane& plane, const SectionArguments& args) {
    const MeasureOptions options{
        .relative_error = args.error, .seconds = args.time_limit, .area = false};
    std::vector<Cut> cuts;
    for (const SolidId id : chosen.solids) {
        const SectionArea area = section_area(IsolatedSolid(solids.solids(), id), plane, options);
        if (area.area.hi() > 0.0) cuts.push_back({id, solids.name(id), area});
    }
    return cuts;
}

/// The text of the SVG; sets `unresolved` to the number of uncertain places.
std::string outlines_of(const SolidScene& solids, const Scene& scene, const PlaneFrame& frame,
                        const Chosen& chosen, const std::vector<Cut>& cuts, SectionArguments& args,
                        std::uint64_t& unresolved) {
    Box3 box;
    for (const Cut& cut : cuts) box.include(IsolatedSolid(solids.solids(), cut.solid).box());
    if (box.empty()) box = chosen.box;
    // That of small solids far away is at the rounding of their coordinates.
    const double usual =
        box.empty() ? 1e-4 : std::max({1e-4 * length(box.size()), least_tolerance(box), 1e-300});
    args.svg_options.tolerance = args.tolerance.value_or(usual);
    args.svg_options.around = box;
    std::vector<SectionLayer> layers;
    for (const Cut& cut : cuts) {
        const IsolatedSolid solid(solids.solids(), cut.solid);
        SectionLayer layer{cut.solid, cut.name, color_of(scene, solid.place().material), {}};
        layer.outlines = trace_section(
            solid, frame, {.cells = args.grid, .tolerance = args.svg_options.tolerance});
        unresolved += layer.outlines.unresolved;
        layers.push_back(std::move(layer));
    }
    return section_svg(layers, frame, args.svg_options);
}

nlohmann::ordered_json report_of(const std::vector<Cut>& cuts, const SectionArguments& args,
                                 std::uint64_t unresolved) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Cut& cut : cuts) {
        const Estimate& a = cut.area.area;
        list.push_back({{"solid", static_cast<std::uint64_t>(cut.solid)},
                        {"name", cut.name},
                        {"area", {{"value", a.value}, {"interval", {a.lo(), a.hi()}}}},
                        {"inconsistent_lines", cut.area.inconsistent_lines},
                        {"reached", cut.area.reached}});
    }
    nlohmann::ordered_json out{{"confidence", 0.95}, {"solids", std::move(list)}};
    if (!args.svg.empty()) {
        out["tolerance"] = args.svg_options.tolerance;
        out["unresolved"] = unresolved;
    }
    return out;
}

void add_section_options(CLI::App& command, SectionArguments& args) {
    command
        .add_option("objects", args.objects,
                    "Solids by number, name, or the beginning or end of a name; default: all. "
                    "The picture shows the whole scene")
        ->type_name("OBJECT");
    command
        .add_option("--plane", args.plane,
                    "The plane nx x + ny y + nz z = d; what lies on the side of the normal is "
                    "taken away")
        ->required()
        ->type_name("NX,NY,NZ,D");
    command.add_option("-o,--output", args.output, "Picture of the scene cut open")
        ->type_name("FILE");
    command.add_option("--size", args.size, "Of the picture")
        ->type_name("WxH")
        ->capture_default_str();
    command
        .add_option("--camera", args.camera,
                    "Look through this camera of the scene instead of straight on")
        ->type_name("NAME|INDEX");
    command
        .add_option("--svg", args.svg, "Outlines of the cut, a layer for each solid; - for stdout")
        ->type_name("FILE");
    command
        .add_option("--unit", args.svg_options.unit,
                    "What a unit of the scene is in the SVG: mm, cm, in, pt or px")
        ->type_name("NAME")
        ->capture_default_str();
    command
        .add_option("--tolerance", args.tolerance,
                    "Largest distance of outlines from the curves, at least 1e-9 of the size; "
                    "default: 1e-4 of it")
        ->type_name("X")
        ->check(number_in(1e-300, 1e300));
    command.add_option("--grid", args.grid, "Cells along a solid; smaller features may be missed")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(4, 8192));
    command.add_option("--error", args.error, "Relative error of the areas to work for")
        ->type_name("E")
        ->capture_default_str()
        ->check(number_in(1e-13, 1.0));
    add_time_limit(command, "--time-limit,--budget", args.time_limit,
                   "Time for the area of each solid at the most; --budget is the older name")
        ->capture_default_str()
        ->check(number_in(0.0, 1e9));
    command.add_option("--json", args.json, "Write the areas as JSON; - for stdout")
        ->type_name("FILE");
    add_quiet(command, args.quiet);
}

void print_cuts(const std::vector<Cut>& cuts, std::uint64_t unresolved,
                const SectionArguments& args) {
    if (args.json != "-" && args.svg != "-") {
        for (const Cut& cut : cuts) {
            print("{} {}: area {:.12g} +- {:.2g}\n", static_cast<std::uint64_t>(cut.solid),
                  escape_controls(cut.name), cut.area.area.value, cut.area.area.half_width);
        }
        if (cuts.empty()) print("the plane cuts nothing\n");
    } else if (cuts.empty() && !args.quiet) {
        tell("the plane cuts nothing\n");
    }
    if (unresolved > 0) {
        tell(
            "alhazen: at {} places of the outlines curves could not be told apart; try a larger "
            "--grid\n",
            unresolved);
    }
}

void run_section(SectionArguments& args, int& exit_status) {
    const auto n = parse_numbers(args.plane, {4}, "a plane: nx,ny,nz,d");
    const SectionPlane plane{{n[0], n[1], n[2]}, n[3]};
    const PlaneFrame frame = frame_of(plane);
    const Size size = parse_size(args.size);
    check_picture_size(size.width, size.height);
    if (!args.output.empty()) check_image_suffix(args.output);
    if (!args.svg.empty()) (void)section_svg({}, frame, args.svg_options);  // checks the unit
    std::vector<std::filesystem::path> outputs;
    for (const std::string& path : {args.output, args.svg, args.json}) {
        if (!path.empty() && path != "-") outputs.emplace_back(path);
    }
    check_distinct(outputs);
    for (const auto& path : outputs) check_writable(path);
    if (args.svg == "-" && args.json == "-") {
        throw Error(ErrorKind::Usage, "--svg and --json cannot both be written to stdout");
    }
    const LoadedScene loaded = load(args.scene.scene, args.scene.load_options());
    check_spares_scene(loaded.description, outputs);
    if (!args.quiet) print_warnings(loaded.diagnostics);
    ThreadLimit(args.scene.threads).run([&] {
        const SolidScene solids(loaded.description, loaded.scene);
        const Chosen chosen = choose(solids, args.objects);
        if (!args.svg.empty()) check_tolerance(chosen.box, args.tolerance);
        const std::vector<Cut> cuts = cut_solids(solids, chosen, plane, args);
        std::optional<Image> picture;
        if (!args.output.empty()) picture = picture_of(solids, loaded, plane, args);
        std::uint64_t unresolved = 0;
        std::string svg;
        if (!args.svg.empty()) {
            svg = outlines_of(solids, loaded.scene, frame, chosen, cuts, args, unresolved);
        }
        // Up to here a signal ends the program without output; from here all output is written.
        (void)stop_on_signals();
        if (picture) write_image(args.output, *picture);
        if (!args.svg.empty()) write_report(args.svg, svg);
        print_cuts(cuts, unresolved, args);
        if (!args.json.empty()) {
            write_report(args.json,
                         report_of(cuts, args, unresolved)
                                 .dump(2, ' ', true, nlohmann::json::error_handler_t::replace) +
                             "\n");
        }
    });
    exit_status = kDone;
}

/// Refuses options that have no effect.
void check_effects(const CLI::App& command, const SectionArguments& args) {
    const auto need = [&](const std::string& file, const char* of,
                          std::initializer_list<const char*> options) {
        for (const char* option : options) {
            if (!file.empty() || command.count(option) == 0) continue;
            throw Error(ErrorKind::Usage, fmt::format("{} needs {}", option, of));
        }
    };
    need(args.output, "-o, the picture", {"--size", "--camera"});
    need(args.svg, "--svg, the outlines", {"--unit", "--tolerance", "--grid"});
}

}  // namespace

void add_section(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "section", "A scene cut open by a plane: picture, outlines as SVG, areas");
    const auto args = std::make_shared<SectionArguments>();
    args->scene.add_to(*command, kDefaultAccelerator);
    add_section_options(*command, *args);
    command->callback([args, command, &exit_status] {
        check_effects(*command, *args);
        run_section(*args, exit_status);
    });
}

}  // namespace alhazen::cli
