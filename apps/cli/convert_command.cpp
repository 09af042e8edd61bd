#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "alhazen/base/error.h"
#include "alhazen/session/conversion/convert.h"
#include "alhazen/session/conversion/tessellated.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

struct ConvertArguments {
    ReadArguments scene;
    std::string output;
    bool quiet = false;
    std::optional<double> tolerance;
    ConvertOptions convert;
};

TessellationReport triangles_of(SceneDescription& description, double tolerance, bool keep_others,
                                int threads) {
    try {
        return tessellate(description, tolerance, keep_others, kMostTessellated, threads);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Scene) throw;
        throw Error(ErrorKind::Scene, std::string(error.what()) +
                                          "--meshes-only leaves them out, .alhazen keeps them");
    }
}

int run(const ConvertArguments& args) {
    // Checks the names before any work.
    check_convert_target(args.scene.scene, args.output);
    Diagnostics diagnostics;
    std::string became;
    SceneDescription description =
        load_description(args.scene.scene, args.scene.load_options(), diagnostics);
    if (!args.quiet) print_warnings(diagnostics);
    if (args.tolerance) {
        // A native file can hold shapes without a tessellation; --meshes-only leaves them out.
        const bool keep_others = args.convert.meshes_only ||
                                 std::filesystem::path(args.output).extension() == ".alhazen";
        const TessellationReport report =
            triangles_of(description, *args.tolerance, keep_others, args.scene.threads);
        if (args.scene.strict && !report.lost.empty()) {
            std::string message = "triangles cannot hold all of the scene:";
            for (const std::string& line : report.lost) message += "\nerror: " + line;
            throw Error(ErrorKind::Scene, message);
        }
        if (!args.quiet) {
            for (const std::string& line : report.lost) tell("warning: {}\n", line);
            for (const std::string& line : report.kept) tell("warning: {}\n", line);
            became = fmt::format("{} became {} within {:g} of {}", counted(report.shapes, "shape"),
                                 counted(report.triangles, "triangle"), *args.tolerance,
                                 report.shapes == 1 ? "it" : "them");
        }
    }
    ConvertOptions options = args.convert;
    options.tolerance = args.tolerance.value_or(0.0);
    options.strict = args.scene.strict;
    const ConvertReport report = convert(description, args.output, options);
    if (args.quiet) return kDone;
    if (report.moved > 0.0 && !became.empty()) {
        became += ", and the file's floats move corners by up to " + rounded_up(report.moved);
    }
    if (!became.empty()) tell("{}\n", became);
    for (const std::string& line : conversion_warnings(report)) tell("warning: {}\n", line);
    const std::size_t beside = report.files.size() - 1;
    tell("{}: {}, {:.1f} MB{}\n", args.output, counted(report.triangles, "triangle"),
         1e-6 * static_cast<double>(report.bytes),
         beside == 0   ? ""
         : beside == 1 ? ", one file beside it"
                       : fmt::format(", {} files beside it", beside));
    return kDone;
}

}  // namespace

void add_convert(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "convert",
        "Write a scene in the native format, its meshes as PLY, OBJ or STL, its patches as OBJ or "
        ".bpt");
    const auto args = std::make_shared<ConvertArguments>();
    args->scene.add_to(*command);
    command
        ->add_option("output", args->output,
                     "File to write: .alhazen for the whole scene, .ply .obj .stl for its meshes, "
                     ".obj .bpt for its patches")
        ->required()
        ->type_name("OUT");
    command->add_flag("--meshes-only", args->convert.meshes_only,
                      "Leave out shapes that are not meshes where the format holds only those");
    command
        ->add_option("--tolerance", args->tolerance,
                     "Replace shapes by triangles at most this far from them, in units of the "
                     "scene")
        ->type_name("X");
    add_quiet(*command, args->quiet);
    command->callback([args, &exit_status] { exit_status = run(*args); });
}

}  // namespace alhazen::cli
