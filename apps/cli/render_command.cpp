#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/cameras/projection.h"
#include "alhazen/imaging/codecs/half_range.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/core/reports/antialias_report.h"
#include "alhazen/renderers/core/reports/beam_report.h"
#include "alhazen/renderers/core/reports/sampling_report.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/build_choice.h"
#include "alhazen/session/conversion/tessellated.h"
#include "alhazen/session/environment_option.h"
#include "alhazen/session/photon_file.h"
#include "alhazen/session/picture.h"
#include "alhazen/session/prepare_view.h"
#include "alhazen/session/render.h"
#include "alhazen/session/scan_line_figure.h"
#include "alhazen/session/scene_files.h"
#include "alhazen/session/statistics.h"
#include "alhazen/session/stopwatch.h"
#include "commands.h"
#include "messages.h"
#include "options.h"
#include "progress_display.h"
#include "stop_signals.h"

namespace alhazen::cli {

namespace {

struct RenderArguments {
    SceneArguments scene;
    std::string output;
    std::string size, crop, encoding, protocol, stats, tables, photons, aovs, view, antialias;
    std::string projection;
    int depth = -1;
    int bits = 8;
    bool full_float = false, aov_png = false, quiet = false, no_counts = false, spectral = false;
    SamplingTexts sampling;
    std::optional<int> spp;
    RenderOptions render;
    std::string environment, tonemap;
    ToneMapping tone;
    bool names_tone = false;  ///< one of its options is given, whatever its value
};

Encoding parse_encoding(const std::string& name) {
    if (name == "linear") return Encoding::LinearTruncated;
    if (name == "srgb") return Encoding::Srgb;
    throw Error(ErrorKind::Usage, fmt::format("--encoding '{}': expected linear or srgb", name));
}

ToneMapping tone_mapping(const RenderArguments& args) {
    ToneMapping tone = args.tone;
    if (args.tonemap.empty()) return tone;
    for (std::size_t i = 0; i < std::size(kToneCurveNames); ++i) {
        if (args.tonemap != kToneCurveNames[i]) continue;
        tone.curve = static_cast<ToneCurve>(i);
        return tone;
    }
    throw Error(ErrorKind::Usage, fmt::format("--tonemap '{}': expected {}", args.tonemap,
                                              fmt::join(kToneCurveNames, ", ")));
}

RenderOptions render_options(const RenderArguments& args) {
    RenderOptions options = args.render;
    options.threads = args.scene.threads;
    options.count_tests = !args.stats.empty() && !args.no_counts;
    if (!args.size.empty()) {
        const Size size = parse_size(args.size);
        options.width = size.width;
        options.height = size.height;
    }
    if (!args.crop.empty()) options.crop = parse_crop(args.crop);
    if (args.depth >= 0) {
        options.max_depth = args.depth;
        options.renderer = with_depth(options.renderer, args.depth);
    }
    if (!args.antialias.empty()) options.antialias = parse_antialias(args.antialias);
    SamplingTexts sampling = args.sampling;
    sampling.seconds = args.scene.time_limit;
    options.sampling = parse_sampling(sampling);
    if (args.spp) {
        options.samples_per_pixel = *args.spp;
    } else if (options.sampling && options.sampling->has_rounds()) {
        options.samples_per_pixel = SamplingPlan::kMostByRule;
    }
    if (!args.aovs.empty()) options.aovs = parse_aovs(args.aovs);
    options.keep_photons = !args.photons.empty();
    options.spectral = args.spectral;
    check_one_view(args.view, options.camera);
    if (args.protocol == "spd") {
        options.protocol = Protocol::Spd;
    } else if (!args.protocol.empty()) {
        throw Error(ErrorKind::Usage, fmt::format("--protocol '{}': expected spd", args.protocol));
    }
    return options;
}

/// True if layers are written as separate pictures: without an EXR file, or on request.
bool writes_aov_pictures(const RenderArguments& args) {
    return args.aov_png || !holds_layers(args.output);
}

/// Refuses options that have no effect.
void check_effects(const RenderArguments& args) {
    const auto need = [](bool has_effect, const char* message) {
        if (!has_effect) throw Error(ErrorKind::Usage, message);
    };
    std::string suffix = std::filesystem::path(args.output).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool jpeg = suffix == ".jpg" || suffix == ".jpeg";
    need(!args.aov_png || !args.aovs.empty(), "--aov-png needs --aov: no layers were asked for");
    need(!args.no_counts || !args.stats.empty(), "--no-counts needs --stats");
    need(args.bits == 8 || suffix == ".png", "--bits 16 is for .png: no other picture has them");
    need(!args.full_float || suffix == ".exr", "--full-float is for .exr");
    need(!args.names_tone || suffix == ".png" || jpeg,
         "--tonemap, --exposure and --white-balance are for .png and .jpg: other pictures hold "
         "linear values");
    need(args.encoding.empty() || suffix == ".png" || jpeg,
         "--encoding is for .png and .jpg: other pictures hold linear values");
}

/// All output files. Throws unless all are writable and different.
std::vector<std::filesystem::path> checked_outputs(const RenderArguments& args,
                                                   const RenderOptions& options) {
    check_image_suffix(args.output);
    std::vector<std::filesystem::path> outputs{args.output};
    if (writes_aov_pictures(args)) {
        for (auto& path : aov_picture_paths(args.output, options.aovs)) {
            outputs.push_back(std::move(path));
        }
    }
    if (!args.stats.empty() && args.stats != "-") outputs.emplace_back(args.stats);
    if (!args.tables.empty()) outputs.emplace_back(args.tables);
    if (!args.photons.empty()) outputs.emplace_back(args.photons);
    check_distinct(outputs);
    for (const auto& path : outputs) check_writable(path);
    return outputs;
}

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

int run(const RenderArguments& args) {
    const Stopwatch run_time;
    // Checks the options before any work.
    if (!args.encoding.empty()) (void)parse_encoding(args.encoding);
    RenderOptions options = render_options(args);
    const std::unique_ptr<Renderer> renderer = make_renderer(options.renderer);
    const bool rounds = options.sampling && options.sampling->has_rounds();
    if (!args.spp && !rounds) options.samples_per_pixel = renderer->usual_samples();
    check_sampling(options, *renderer);
    check_antialias(options, *renderer);
    check_photons(options, *renderer);
    check_spectral(options, *renderer);
    const bool needs_aggregate = renderer->needs_aggregate();
    if (!args.tables.empty() && !renderer->has_scan_lines()) {
        throw Error(ErrorKind::Usage,
                    "--tables is for renderers in scan lines: lane_carpenter, clark");
    }
    check_environment(args.environment, options.renderer);
    if (!args.view.empty()) (void)parse_view(args.view);
    if (!args.projection.empty()) (void)parse_projection(args.projection);
    const std::vector<std::filesystem::path> outputs = checked_outputs(args, options);
    check_effects(args);
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
    LoadedScene loaded = load(args.scene.scene, load_options);
    progress.finish();
    check_spares_scene(loaded.description, outputs);
    if (!args.quiet) print_warnings(loaded.diagnostics);
    if (!needs_aggregate && args.scene.names_accelerator() && !args.quiet) {
        tell(
            "renderer '{}' has no accelerator: --accelerator, --bound, --build, --width and "
            "--compact have no effect\n",
            options.renderer);
    }
    // Framing reads the tables of the aggregate.
    if (!args.view.empty() || loaded.scene.cameras.empty()) build_aggregate(loaded, load_options);
    ViewRequest wishes{.environment = args.environment,
                       .image_limits = load_options.import.image_limits};
    if (!args.view.empty()) wishes.view = parse_view(args.view);
    wishes.projection = args.projection;
    for (const std::string& note : prepare_view(loaded, options, wishes)) {
        if (!args.quiet) tell("{}\n", note);
    }
    if (const double within = renderer->takes_triangles_within(); within > 0) {
        (void)tessellate(loaded.description, within, true);
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
    if (result.counters.non_finite > 0 && !args.quiet) {
        tell("warning: {} samples were not finite and were left out\n", result.counters.non_finite);
    }
    if (!args.quiet) {
        for (const std::string& note : result.notes) tell("warning: {}\n", note);
        for (const std::string& remark : result.remarks) tell("{}\n", remark);
    }
    if (result.antialias && !args.quiet) tell_unmet(loaded, *result.antialias);
    if (result.sampling && !args.quiet) tell_sampling(options, *result.sampling);
    if (!result.complete && has_rounds) {
        tell("stopped in round {}: {} of {} tiles have its samples, the rest those before it\n",
             result.sampling->finished_rounds() + 1, result.tiles_done, result.tiles);
        return kStopped;
    }
    if (!result.complete) {
        tell(
            "stopped: {} of {} tiles were traced; the picture in {} lacks the light of the "
            "others\n",
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

}  // namespace

void add_render(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand("render", "Render a scene to a picture");
    const auto args = std::make_shared<RenderArguments>();
    args->scene.takes_time_limit = true;
    args->scene.takes_shutter = true;
    args->scene.takes_auto_build = true;
    args->scene.add_to(*command, kDefaultAccelerator);
    command->add_option("-o,--output", args->output, "Picture to write: .png .exr .hdr .pfm .jpg")
        ->required()
        ->type_name("FILE");
    command->add_option("--size", args->size, "Picture size in pixels; default: the scene's")
        ->type_name("WxH");
    command->add_option("--crop", args->crop, "Render only this part, in pixels from the top left")
        ->type_name("X0,Y0,X1,Y1");
    command
        ->add_option("--renderer", args->render.renderer,
                     "Renderer by name; see `alhazen list renderers`")
        ->type_name("NAME[:SETTING=VALUE,...]")
        ->capture_default_str();
    command
        ->add_option("--spp", args->spp,
                     "Samples per pixel; default: 1, or 16 or 64 for renderers that distribute "
                     "rays; with --noise or a limit of --time the maximum of a pixel")
        ->type_name("N");
    command
        ->add_option("--sampler", args->sampling.sampler,
                     "Sampler by name; see `alhazen list samplers`")
        ->type_name("NAME");
    command
        ->add_option("--filter", args->sampling.filter,
                     "Reconstruction filter by name; see `alhazen list filters`")
        ->type_name("NAME[:radius=PIXELS,shared=on]");
    command
        ->add_option("--noise", args->sampling.noise,
                     "More samples, in rounds, for pixels whose standard error over the root of "
                     "their value is larger")
        ->type_name("X")
        ->check(number_in(1e-6, 10.0));
    command
        ->add_option("--antialias", args->antialias,
                     "Adaptive supersampling instead of --spp: rays through the corners of the "
                     "pixels, and more where their shades would change the pixel by more than "
                     "threshold (0.02), down to 1 / 2^depth (4) of a pixel; guarantee (on): and "
                     "where an object may hide between rays (all: also where all rays around meet "
                     "something nearer); neighbours (on): and where rays of "
                     "cells beside it differ; weigh (on): shades count by the area of their cell. "
                     "exact: the integral over the whole area of each pixel, or "
                     "under a filter (`alhazen list filters`), of beam_tracing; shades that change "
                     "within a pixel are integrated to within error (0.0001). pixel_selection: no "
                     "antialiasing; a quick look: rays for one pixel in step (8) of each row and "
                     "column, more where shades differ by more than threshold (0.05)")
        ->type_name(
            "whitted[:threshold=T,depth=D,guarantee=on|off|all,weigh=on|off,neighbours=on|off]|"
            "exact[:error=E,filter=NAME,radius=PIXELS]|pixel_selection[:step=N,threshold=T]");
    command
        ->add_option("--depth", args->depth,
                     "Recursion depth, 0 = eye rays only; default: the format's. Of what follows "
                     "paths: N + 1 scatterings at most; default: that of its setting depth")
        ->type_name("N")
        ->check(CLI::Range(0, 1000));
    command
        ->add_option(
            "--environment", args->environment,
            "What surrounds the scene, for renderers that follow light physically: a "
            "picture of all directions (.hdr .exr and others), a clear sky with its sun, a "
            "neutral studio; default: the scene's, or the studio where it has no light")
        ->type_name("FILE|sky|studio|none");
    command->add_option("--camera", args->render.camera, "Camera by name or position")
        ->type_name("NAME|INDEX");
    command
        ->add_option("--view", args->view,
                     "Frame the whole scene from this side instead, degrees; 0,0 is the front")
        ->type_name("AZIMUTH,ELEVATION");
    command
        ->add_option(
            "--projection", args->projection,
            "Projection of the camera, with its position and direction: fisheye, "
            "equisolid (180 degrees high unless given), panorama (all around), perspective (45)")
        ->type_name("NAME[:DEGREES]");
    command->add_option("--seed", args->render.seed, "Seed of the sample positions")
        ->type_name("N")
        ->capture_default_str()
        ->check(unsigned_number());
    command->add_option("--tile-size", args->render.tile_size, "Side of a tile in pixels")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1, 4096));
    command
        ->add_option(
            "--encoding", args->encoding,
            "How PNG and JPG hold values: linear (truncated) or srgb; default: the format's")
        ->type_name("NAME");
    command->add_option("--tonemap", args->tonemap, "Curve of PNG and JPG from radiance to display")
        ->type_name("none|reinhard|aces|agx");
    command->add_option("--exposure", args->tone.stops, "PNG and JPG show 2^STOPS times the light")
        ->type_name("STOPS")
        ->check(number_in(-64.0, 64.0));
    command
        ->add_option("--white-balance", args->tone.kelvin,
                     "Temperature of the light that PNG and JPG shall show as white")
        ->type_name("KELVIN")
        ->check(number_in(ToneMapping::kLeastKelvin, ToneMapping::kMostKelvin));
    command->add_option("--bits", args->bits, "Bits per channel of a PNG")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::IsMember({8, 16}));
    command->add_flag("--full-float", args->full_float, "EXR in float instead of half");
    std::string aovs;
    for (const AovEntry& entry : aov_table()) {
        aovs += fmt::format("\n  {:<22} {}", entry.name, entry.description);
    }
    command
        ->add_option("--aov", args->aovs,
                     "Layers to write besides the picture, separated by commas, or all: into the "
                     ".exr, or each to OUT.NAME.png:" +
                         aovs)
        ->type_name("LIST");
    command->add_flag("--aov-png", args->aov_png, "OUT.NAME.png of each layer beside an .exr, too");
    command
        ->add_option("--protocol", args->protocol,
                     "Count as published: spd = 513x513 corner rays, depth 5")
        ->type_name("NAME");
    command->add_flag("--no-counts", args->no_counts,
                      "With --stats: count no tests, which takes time");
    command->add_option("--stats", args->stats, "Write statistics as JSON; - for stdout")
        ->type_name("FILE");
    command
        ->add_option(
            "--tables", args->tables,
            "Draw the tables of lane_carpenter or clark over the scan lines as an animated SVG")
        ->type_name("FILE");
    command
        ->add_option(
            "--photons", args->photons,
            "Write the photons of photon_mapping, or of the first pass of sppm or vcm, as points "
            "of a PLY file")
        ->type_name("FILE.ply");
    command->add_flag("--spectral", args->spectral,
                      "Light by wavelengths instead of red, green and blue: glass disperses");
    add_quiet(*command, args->quiet);
    command->callback([args, command, &exit_status] {
        for (const char* option : {"--tonemap", "--exposure", "--white-balance"}) {
            args->names_tone = args->names_tone || command->count(option) > 0;
        }
        exit_status = run(*args);
    });
}

}  // namespace alhazen::cli
