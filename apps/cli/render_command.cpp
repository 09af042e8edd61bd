#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "alhazen/base/file.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/imaging/codecs/half_range.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/core/reports/antialias_report.h"
#include "alhazen/renderers/core/reports/beam_report.h"
#include "alhazen/renderers/core/reports/sampling_report.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/build_choice.h"
#include "alhazen/session/conversion/tessellated.h"
#include "alhazen/session/photon_file.h"
#include "alhazen/session/picture.h"
#include "alhazen/session/prepare_view.h"
#include "alhazen/session/render.h"
#include "alhazen/session/scan_line_figure.h"
#include "alhazen/session/scene_files.h"
#include "alhazen/session/statistics.h"
#include "commands.h"
#include "messages.h"
#include "progress_display.h"
#include "render_arguments.h"
#include "stop_signals.h"

namespace alhazen::cli {

namespace {

/// Pictures that took less, in seconds, are not synced to the disk, which takes some 10 ms.
constexpr double kSyncedFrom = 1;

PictureOptions picture_options(const RenderArguments& args, int samples_per_pixel,
                               const RenderResult& result, double seconds) {
    PictureOptions options;
    options.sync = seconds < kSyncedFrom ? Sync::Later : Sync::ToDisk;
    if (!args.encoding.empty()) options.encoding = parse_encoding(args.encoding);
    options.tone = tone_mapping(args);
    options.bits = args.bits;
    options.full_float = args.full_float;
    options.metadata = {{"software", fmt::format("alhazen {}", version())},
                        {"alhazen.scene", args.scene.scene},
                        {"alhazen.spp", fmt::format("{}", samples_per_pixel)},
                        {"alhazen.complete", result.complete ? "1" : "0"}};
    return options;
}

/// Prints how many pixels of an EXR were clamped.
void tell_beyond_half(const Film& film, const PictureOptions& picture) {
    const BeyondHalf beyond = beyond_half(film, picture.layers);
    if (beyond.colors > 0 && !picture.full_float) {
        tell(
            "warning: {} pixel{} beyond the largest number of a half, {}, and written as that; "
            "--full-float keeps them\n",
            beyond.colors, beyond.colors == 1 ? " is" : "s are", kLargestHalf);
    }
    if (beyond.layers > 0) {
        tell(
            "warning: {} pixel{} beyond the largest number of a half, {}, in a layer, and written "
            "as that\n",
            beyond.layers, beyond.layers == 1 ? " is" : "s are", kLargestHalf);
    }
}

void write_pictures(const RenderArguments& args, const RenderOptions& options,
                    const LoadedScene& loaded, const RenderResult& result, double seconds) {
    PictureOptions picture = picture_options(args, options.samples_per_pixel, result, seconds);
    const ImageMetadata common = picture.metadata;
    if (!options.aovs.empty() && holds_layers(args.output)) {
        picture.layers = &result.layers;
        const ImageMetadata names = id_names(loaded.description, options.aovs);
        picture.metadata.insert(picture.metadata.end(), names.begin(), names.end());
    }
    write_picture(args.output, result.film, loaded.scene.conventions.film, picture);
    if (!args.quiet && holds_layers(args.output)) tell_beyond_half(result.film, picture);
    if (options.aovs.empty() || !writes_aov_pictures(args)) return;
    for (const std::string& line :
         write_aov_pictures(args.output, options.aovs, result.layers, common)) {
        if (!args.quiet) tell("{}\n", line);
    }
}

/// Prints the names of objects that no ray of --antialias met.
void tell_unmet(const LoadedScene& loaded, const AntialiasReport& report) {
    constexpr std::size_t kNames = 4;
    if (report.below_depth == 0) return;
    std::string names;
    for (std::size_t i = 0; i < std::min(kNames, report.unmet.size()); ++i) {
        names += fmt::format("{}'{}' (pixel {},{})", i == 0 ? "" : ", ",
                             part_name(loaded.description, report.unmet[i].part), report.unmet[i].x,
                             report.unmet[i].y);
    }
    tell("{} object{} stayed below the depth of --antialias, in {} pixels: {}{}\n",
         report.below_depth, report.below_depth == 1 ? "" : "s", report.below_depth_pixels, names,
         report.below_depth > kNames ? ", ..." : "");
}

/// Prints the results of the stop rules.
void tell_sampling(const RenderOptions& options, const SamplingReport& report) {
    if (!options.sampling || !options.sampling->has_rounds() || report.finished_rounds() == 0)
        return;
    const double mean = static_cast<double>(report.samples()) / static_cast<double>(report.pixels);
    tell("{:.1f} samples per pixel, at most {}{}\n", mean, report.most_samples,
         report.out_of_time ? "; out of time" : "");
    if (report.pixels_above > 0) {
        tell("the noise of {} pixels is above --noise {:g}\n", report.pixels_above,
             *options.sampling->noise);
    }
}

/// Prints what became of the picture. Returns the exit status.
int tell_result(const RenderArguments& args, const RenderOptions& options,
                const LoadedScene& loaded, const RenderResult& result) {
    if (result.counters.non_finite > 0 && !args.quiet) {
        tell("warning: {} samples were not finite and were left out\n", result.counters.non_finite);
    }
    if (!args.quiet) {
        for (const std::string& note : result.notes) tell("warning: {}\n", note);
        for (const std::string& remark : result.remarks) tell("{}\n", remark);
    }
    if (result.antialias && !args.quiet) tell_unmet(loaded, *result.antialias);
    if (result.sampling && !args.quiet) tell_sampling(options, *result.sampling);
    const bool has_rounds = result.sampling && result.sampling->finished_rounds() > 0;
    if (!result.complete && has_rounds) {
        tell("stopped in round {}: {} of {} tiles have its samples, the rest those before it\n",
             result.sampling->finished_rounds() + 1, result.tiles_done, result.tiles);
        return kStopped;
    }
    if (!result.complete) {
        tell("stopped: {} of {} tiles were traced; the others are missing from the picture in {}\n",
             result.tiles_done, result.tiles, args.output);
        return kStopped;
    }
    if (!args.quiet) {
        tell("{}: {}x{}, {:.2f} M rays in {:.2f} s on {} thread{}\n", args.output,
             result.film.crop().width(), result.film.crop().height(),
             1e-6 * static_cast<double>(result.counters.total_cast()), result.seconds,
             result.threads, result.threads == 1 ? "" : "s");
    }
    return args.scene.strict && result.counters.non_finite > 0 ? kNotStrict : kDone;
}

int run(const RenderArguments& args) {
    const Stopwatch run_time;
    CheckedRender plan = checked(args);
    RenderOptions& options = plan.options;
    const Renderer& renderer = *plan.renderer;
    const bool needs_aggregate = renderer.needs_aggregate();
    ProgressDisplay progress(args.quiet);
    LoadOptions load_options = args.scene.load_options();
    load_options.progress = &progress;
    load_options.with_aggregate = needs_aggregate;
    load_options.keep_meshes = !needs_aggregate;
    if (args.scene.chooses_build()) {
        load_options.choose_quality = [&options](const LoadedScene& loaded) {
            return quality_for_picture(loaded, options);
        };
    }
    if (!needs_aggregate) {
        args.scene.tell_idle_accelerator(fmt::format("renderer '{}'", options.renderer),
                                         args.quiet);
    }
    LoadedScene loaded = load(args.scene.scene, load_options);
    progress.finish();
    check_spares_scene(loaded.description, plan.outputs);
    if (!args.quiet) print_warnings(loaded.diagnostics);
    // Framing reads the tables of the aggregate.
    if (!args.view.empty() || loaded.scene.cameras.empty()) build_aggregate(loaded, load_options);
    ViewRequest wishes{.environment = args.environment,
                       .image_limits = load_options.import.image_limits};
    if (!args.view.empty()) wishes.view = parse_view(args.view);
    wishes.projection = args.projection;
    for (const std::string& note : prepare_view(loaded, options, wishes)) {
        if (!args.quiet) tell("{}\n", note);
    }
    if (const double within = renderer.takes_triangles_within(); within > 0) {
        (void)tessellate(loaded.description, within, true, kMostTessellated, options.threads);
    }
    options.progress = &progress;
    options.stop = &stop_on_signals();
    const RenderResult result = render(loaded, options);
    progress.finish();
    const bool has_rounds = result.sampling && result.sampling->finished_rounds() > 0;
    if (result.tiles_done == 0 && !has_rounds && !result.complete) {
        tell("stopped before a tile was done; nothing was written\n");
        return kStopped;
    }
    const Stopwatch write_time;
    ThreadLimit(options.threads).run([&] {
        write_pictures(args, options, loaded, result, run_time.seconds());
    });
    const double write_seconds = write_time.seconds();
    if (!args.stats.empty()) {
        write_report(
            args.stats,
            statistics(args.scene.scene, loaded, options, result, write_seconds)
                    .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                "\n");
    }
    if (!args.tables.empty()) {
        write_report(args.tables, scan_line_svg(*result.scan_lines, args.scene.scene));
    }
    if (!args.photons.empty()) write_file_atomically(args.photons, photon_ply(result.photons));
    return tell_result(args, options, loaded, result);
}

}  // namespace

void add_render(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand("render", "Render a scene to a picture");
    const auto args = std::make_shared<RenderArguments>();
    args->add_to(*command);
    command->callback([args, command, &exit_status] {
        for (const char* option : {"--tonemap", "--exposure", "--white-balance"}) {
            args->names_tone = args->names_tone || command->count(option) > 0;
        }
        exit_status = run(*args);
    });
}

}  // namespace alhazen::cli
