#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/session/conversion/tessellated.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/session/scene_files.h"
#include "alhazen/session/technical/technical_drawing.h"
#include "alhazen/session/vector_drawing.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

struct VectorArguments {
    SceneArguments scene;
    std::string output, size, camera, view, style = "shaded", hidden = "none";
    int depth = -1;
    double tolerance = 0;
    bool quiet = false;
};

DrawingLook look_named(const std::string& style) {
    if (style == "shaded") return DrawingLook::Shaded;
    if (style == "lined") return DrawingLook::Lined;
    if (style == "technical") return DrawingLook::Technical;
    throw Error(ErrorKind::Usage,
                fmt::format("--style '{}': expected shaded, lined or technical", style));
}

bool shows_hidden(const VectorArguments& args) {
    if (args.hidden == "none") return false;
    if (args.hidden != "dashed") {
        throw Error(ErrorKind::Usage,
                    fmt::format("--hidden '{}': expected dashed or none", args.hidden));
    }
    if (args.style != "technical") {
        throw Error(ErrorKind::Usage, "--hidden dashed belongs to --style technical");
    }
    return true;
}

/// The tolerance of the command; by default a five hundredth of the scene's size.
double tolerance_of(const VectorArguments& args, const LoadedScene& loaded) {
    if (args.tolerance > 0) return args.tolerance;
    const Box3 box = loaded.scene.aggregate->box();
    if (!box.empty() && box.bounded()) return 2e-3 * length(box.size());
    throw Error(ErrorKind::Usage, "the scene is endless: --tolerance has to be given");
}

/// Selects the writer by the suffix of the file.
using WriteDrawing = std::string (*)(const Drawing&);
WriteDrawing writer_for(const std::string& output) {
    const std::string suffix = lower_suffix(output);
    if (suffix == ".svg") return drawing_svg;
    if (suffix == ".pdf") return drawing_pdf;
    throw Error(ErrorKind::Usage, fmt::format("-o '{}': expected a file .svg or .pdf", output));
}

int run_vector(const VectorArguments& args) {
    const DrawingLook look = look_named(args.style);
    const WriteDrawing write = writer_for(args.output);
    const bool hidden = shows_hidden(args);
    const bool exact = look == DrawingLook::Technical && (hidden || args.tolerance > 0);
    if (exact && args.depth >= 0) {
        throw Error(ErrorKind::Usage,
                    "--depth is for drawings with mirror images: with --style technical and "
                    "--hidden dashed or --tolerance there are none");
    }
    RenderOptions options;
    if (!args.size.empty()) {
        const Size size = parse_size(args.size);
        options.width = size.width;
        options.height = size.height;
    }
    options.camera = args.camera;
    if (args.depth >= 0) options.max_depth = args.depth;
    options.threads = args.scene.threads;
    FramingOptions framing;
    if (!args.view.empty()) framing.view = parse_view(args.view);
    check_one_view(args.view, args.camera);
    check_writable(args.output);
    LoadOptions load_options = args.scene.load_options();
    load_options.with_aggregate = exact;
    if (!exact) args.scene.tell_idle_accelerator("a drawing of planar facets", args.quiet);
    LoadedScene loaded = load(args.scene.scene, load_options);
    const std::filesystem::path outputs[] = {args.output};
    check_spares_scene(loaded.description, outputs);
    if (!args.quiet) print_warnings(loaded.diagnostics);
    // Framing reads the tables of the aggregate.
    if (!args.view.empty() || loaded.scene.cameras.empty()) build_aggregate(loaded, load_options);
    framing.camera = options.camera;
    framing.aspect = free_aspect(loaded.description.picture, options);
    for (const std::string& note : complete_view(loaded.description, loaded.scene, framing)) {
        if (!args.quiet) tell("{}\n", note);
    }
    Drawing drawing;
    if (exact) {
        drawing = technical_drawing(loaded, options,
                                    {.tolerance = tolerance_of(args, loaded), .hidden = hidden});
    } else {
        if (args.tolerance > 0) {
            (void)tessellate(loaded.description, args.tolerance, true, kMostTessellated,
                             args.scene.threads);
        }
        drawing = draw_scene(loaded, options, look);
    }
    write_report(args.output, write(drawing));
    if (!args.quiet) {
        for (const std::string& note : drawing.notes) tell("warning: {}\n", note);
        std::size_t regions = 0;
        for (const DrawingGroup& group : drawing.groups) regions += group.regions.size();
        const std::string lines = counted(drawing.lines.size(), "line");
        if (drawing.groups.empty()) {
            tell("{}\n", lines);
        } else {
            tell("{} of {}, {}\n", counted(regions, "region"),
                 counted(drawing.groups.size(), "part"), lines);
        }
    }
    return kDone;
}

}  // namespace

void add_vector(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "vector",
        "Draw a scene of planar facets without pixels: SVG or PDF, with shadows and "
        "mirror images");
    const auto args = std::make_shared<VectorArguments>();
    args->scene.add_to(*command, "wide_bvh");
    command->add_option("-o,--output", args->output, "Drawing to write: .svg or .pdf")
        ->required()
        ->type_name("FILE");
    command->add_option("--size", args->size, "Size in pixels; default: the scene's")
        ->type_name("WxH");
    command
        ->add_option("--style", args->style,
                     "shaded: the colours of `whitted`; lined: the same with lines where planes "
                     "and objects end; technical: these lines on white")
        ->type_name("NAME")
        ->capture_default_str();
    command
        ->add_option("--hidden", args->hidden,
                     "Hidden lines of --style technical: none, or dashed (of any scene, without "
                     "mirror images)")
        ->type_name("NAME")
        ->capture_default_str();
    command
        ->add_option("--tolerance", args->tolerance,
                     "Draw exact shapes by triangles within this distance, scene units; with "
                     "--style technical spheres, cylinders and cones have their true outlines")
        ->type_name("X")
        ->check(positive_number());
    command->add_option("--depth", args->depth, "Recursion depth of mirrors and panes")
        ->type_name("N")
        ->check(CLI::Range(0, 1000));
    command->add_option("--camera", args->camera, "Camera by name or position")
        ->type_name("NAME|INDEX");
    command
        ->add_option("--view", args->view,
                     "Frame the whole scene from this side instead, degrees; 0,0 is the front")
        ->type_name("AZIMUTH,ELEVATION");
    add_quiet(*command, args->quiet);
    command->callback([args, &exit_status] { exit_status = run_vector(*args); });
}

}  // namespace alhazen::cli
