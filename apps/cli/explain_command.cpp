#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/explain/page/explanation_json.h"
#include "alhazen/explain/page/explanation_page.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/session/scene_files.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

struct ExplainArguments {
    SceneArguments scene;
    std::string pixel, output, size, view;
    ExplainOptions explain;
    int depth = -1;
    bool quiet = false;
};

void parse_explained_pixel(const std::string& text, ExplainOptions& options) {
    int read = 0;
    if (std::sscanf(text.c_str(), "%d,%d%n", &options.x, &options.y, &read) != 2 ||
        static_cast<std::size_t>(read) != text.size()) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--pixel '{}': expected X,Y in pixels from the top left", text));
    }
}

/// True if the output is JSON. Throws Error (Usage) for a suffix of neither kind.
bool is_json(const std::string& output) {
    const std::string suffix = std::filesystem::path(output).extension().string();
    if (output == "-" || suffix == ".json") return true;
    if (suffix == ".html" || suffix == ".htm") return false;
    throw Error(ErrorKind::Usage,
                fmt::format("-o '{}': expected a name that ends in .html or .json", output));
}

int run_explain(ExplainArguments& args) {
    ExplainOptions& options = args.explain;
    parse_explained_pixel(args.pixel, options);
    const bool json = is_json(args.output);
    if (!args.size.empty()) {
        const Size size = parse_size(args.size);
        options.render.width = size.width;
        options.render.height = size.height;
    }
    if (args.depth >= 0) options.render.max_depth = args.depth;
    if (!args.view.empty()) (void)parse_view(args.view);
    check_one_view(args.view, options.render.camera);
    if (args.output != "-") check_writable(args.output);
    options.with_picture = !json;
    LoadedScene loaded = load(args.scene.scene, args.scene.load_options());
    if (args.output != "-") {
        const std::filesystem::path outputs[] = {args.output};
        check_spares_scene(loaded.description, outputs);
    }
    if (!args.quiet) print_warnings(loaded.diagnostics);
    FramingOptions framing;
    if (!args.view.empty()) framing.view = parse_view(args.view);
    framing.camera = options.render.camera;
    framing.aspect = free_aspect(loaded.description.picture, options.render);
    for (const std::string& note : complete_view(loaded.description, loaded.scene, framing)) {
        if (!args.quiet) tell("{}\n", note);
    }
    options.render.threads = args.scene.threads;
    const Explanation explanation = explain_pixel(loaded, options);
    write_report(args.output,
                 json ? explanation_json(explanation, 2) + "\n" : explanation_page(explanation));
    if (!args.quiet && args.output != "-") {
        const RayCensus census = census_of(explanation.tree);
        tell("{}: pixel {},{} of {}x{}, {}\n", args.output, explanation.x, explanation.y,
             explanation.width, explanation.height,
             counted(census.eye + census.shadow + census.reflection + census.refraction, "ray"));
    }
    return kDone;
}

}  // namespace

void add_explain(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "explain", "Why a pixel has its colour: the tree of rays with every term, as a page");
    const auto args = std::make_shared<ExplainArguments>();
    args->scene.add_to(*command, kDefaultAccelerator);
    command->add_option("--pixel", args->pixel, "The pixel, from the top left")
        ->required()
        ->type_name("X,Y");
    command
        ->add_option("-o,--output", args->output,
                     "A page that opens offline, or the data; - for JSON on stdout")
        ->required()
        ->type_name("FILE.html|FILE.json|-");
    command->add_option("--size", args->size, "Picture size in pixels; default: the scene's")
        ->type_name("WxH");
    command->add_option("--camera", args->explain.render.camera, "Camera by name or position")
        ->type_name("NAME|INDEX");
    command
        ->add_option("--view", args->view,
                     "Frame the whole scene from this side instead, degrees; 0,0 is the front")
        ->type_name("AZIMUTH,ELEVATION");
    command
        ->add_option(
            "--renderer", args->explain.render.renderer,
            "cone_tracing, beam_tracing: also their cones or beams for the pixel; the tree "
            "of rays is that of whitted")
        ->capture_default_str()
        ->check(CLI::IsMember({"whitted", "cone_tracing", "beam_tracing"}))
        ->type_name("NAME");
    command->add_option("--depth", args->depth, "Recursion depth; default: the format's")
        ->type_name("N")
        ->check(CLI::Range(0, 1000));
    command
        ->add_option("--spp", args->explain.render.samples_per_pixel,
                     "Samples of the pixel, as `render --spp` places them")
        ->capture_default_str()
        ->type_name("N");
    command->add_option("--sample", args->explain.sample, "The sample that is explained, from 0")
        ->capture_default_str()
        ->type_name("K");
    command->add_option("--seed", args->explain.render.seed, "Seed of the sample positions")
        ->type_name("N")
        ->capture_default_str()
        ->check(unsigned_number());
    command
        ->add_option("--steps", args->explain.accelerator,
                     "The accelerator whose steps are shown: " + traceable_accelerators())
        ->capture_default_str()
        ->type_name("NAME[:SETTING=VALUE,...]");
    add_quiet(*command, args->quiet);
    command->callback([args, &exit_status] { exit_status = run_explain(*args); });
}

}  // namespace alhazen::cli
