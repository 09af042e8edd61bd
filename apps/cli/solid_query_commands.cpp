/// `spans`, `inside`, `thickness`: queries about the solids of a scene, one line of JSON each.

#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/solids/solid_queries_json.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

using json = nlohmann::ordered_json;

/// Number of lines processed together, over all threads.
constexpr std::size_t kBatch = 16384;

struct SolidQueryArguments {
    SceneArguments scene;
    std::vector<std::string> given;  ///< --ray or --point
    std::string file;                ///< --rays or --points
    std::string one;                 ///< "ray" or "point"
    bool quiet = false;
};

void print_line(const json& line) {
    const std::string text = line.dump(-1, ' ', true, json::error_handler_t::replace) + "\n";
    (void)std::fwrite(text.data(), 1, text.size(), stdout);
}

/// Calls answer(batch) for the given items, then for those of the file, batch by batch.
template <class Question, class Parse, class Answer>
void for_each_batch(const SolidQueryArguments& args, const Parse& parse, const Answer& answer) {
    std::vector<Question> batch;
    for (const std::string& text : args.given) batch.push_back(parse(text, FileLocation{}));
    if (!batch.empty()) answer(batch);
    if (args.file.empty()) return;
    std::ifstream file;
    if (args.file != "-") {
        file.open(args.file);
        if (!file) throw Error(ErrorKind::File, args.file + ": cannot be opened");
    }
    LineReader reader(args.file == "-" ? std::cin : file,
                      args.file == "-" ? "standard input" : args.file);
    for (;;) {
        const auto lines = reader.next(kBatch);
        if (lines.empty()) return;
        batch.clear();
        for (const LineReader::Line& line : lines) batch.push_back(parse(line.text, line.where));
        answer(batch);
    }
}

/// Loads the scene and reports surfaces that are not solids.
template <class Work>
void with_solids(const SolidQueryArguments& args, const Work& work) {
    if (args.given.empty() && args.file.empty()) {
        throw Error(
            ErrorKind::Usage,
            fmt::format("nothing is asked for: expected --{0} or --{0}s (see --help)", args.one));
    }
    const LoadedScene loaded = load(args.scene.scene, args.scene.load_options());
    if (!args.quiet) print_warnings(loaded.diagnostics);
    ThreadLimit(args.scene.threads).run([&] {
        const SolidScene scene(loaded.description, loaded.scene);
        if (!args.quiet && scene.solids().open_surfaces() > 0) {
            const std::uint64_t open = scene.solids().open_surfaces();
            const bool one = open == 1;
            tell("alhazen: {} of the scene {} no volume: {} left out\n", counted(open, "surface"),
                 one ? "bounds" : "bound", one ? "it is" : "they are");
            for (const std::string& mesh : scene.open_meshes()) tell("alhazen: {}\n", mesh);
        }
        work(scene);
    });
}

/// Adds the options of a query by rays or by points.
std::shared_ptr<SolidQueryArguments> add_arguments(CLI::App& command, const char* one,
                                                   const char* what, const char* numbers) {
    auto args = std::make_shared<SolidQueryArguments>();
    args->one = one;
    args->scene.add_to(command, kDefaultAccelerator);
    command
        .add_option(std::string("--") + one, args->given,
                    std::string("A ") + one + ": " + what + "; may be repeated")
        ->type_name(numbers)
        ->expected(1)
        ->take_all();
    command
        .add_option(std::string("--") + one + "s", args->file,
                    std::string("File with a ") + one + " in each line; - for standard input")
        ->type_name("FILE");
    add_quiet(command, args->quiet);
    return args;
}
std::shared_ptr<SolidQueryArguments> add_ray_arguments(CLI::App& command) {
    return add_arguments(command, "ray", "origin and direction, perhaps the range of t",
                         "OX,OY,OZ,DX,DY,DZ[,TMIN,TMAX]");
}

}  // namespace

void add_spans(CLI::App& app, int& exit_status) {
    CLI::App* command =
        app.add_subcommand("spans", "Where rays enter and leave the solids of a scene, as JSON");
    const auto args = add_ray_arguments(*command);
    command->callback([args, &exit_status] {
        bool consistent = true;
        with_solids(*args, [&](const SolidScene& scene) {
            SpanLists lists;
            for_each_batch<Ray>(*args, parse_ray, [&](const std::vector<Ray>& rays) {
                scene.queries().spans(rays, lists);
                consistent = consistent && lists.inconsistent == 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    print_line(spans_json(scene, rays[i], lists.of(i)));
                }
            });
        });
        if (!consistent) {
            tell("alhazen: crossings of some solid did not come in pairs; its spans are missing\n");
        }
        exit_status = consistent ? kDone : kCheckFailed;
    });
}

void add_thickness(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "thickness", "How much of rays lies inside the solids of a scene, as JSON");
    const auto args = add_ray_arguments(*command);
    command->callback([args, &exit_status] {
        with_solids(*args, [&](const SolidScene& scene) {
            for_each_batch<Ray>(*args, parse_ray, [&](const std::vector<Ray>& rays) {
                const auto found = scene.queries().thickness(rays);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    print_line(thickness_json(scene, rays[i], found[i]));
                }
            });
        });
        exit_status = kDone;
    });
}

void add_inside(CLI::App& app, int& exit_status) {
    CLI::App* command =
        app.add_subcommand("inside", "Which solids of a scene hold points, as JSON");
    const auto args = add_arguments(*command, "point", "its coordinates", "X,Y,Z");
    command->callback([args, &exit_status] {
        with_solids(*args, [&](const SolidScene& scene) {
            for_each_batch<Vec3>(*args, parse_point, [&](const std::vector<Vec3>& points) {
                const auto found = scene.queries().inside(points);
                for (std::size_t i = 0; i < points.size(); ++i) {
                    print_line(inside_json(scene, points[i], found[i]));
                }
            });
        });
        exit_status = kDone;
    });
}

}  // namespace alhazen::cli
