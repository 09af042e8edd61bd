#include "render_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>

#include "alhazen/accel/accelerator_names.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/cameras/projection.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/environment_option.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/session/picture.h"

namespace alhazen::cli {

namespace {

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
    if (args.scene.time_limit) {
        if (sampling.seconds) {
            throw Error(ErrorKind::Usage,
                        "--time with a unit is an older form of --time-limit: expected one of "
                        "them");
        }
        sampling.seconds = args.scene.time_limit;
    }
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

/// The file, its size, and the part of it that is rendered.
void add_frame_options(CLI::App& command, RenderArguments& args) {
    command.add_option("-o,--output", args.output, "Picture to write: .png .exr .hdr .pfm .jpg")
        ->required()
        ->type_name("FILE");
    command.add_option("--size", args.size, "Picture size in pixels; default: the scene's")
        ->type_name("WxH");
    command.add_option("--crop", args.crop, "Render only this part, in pixels from the top left")
        ->type_name("X0,Y0,X1,Y1");
}

/// "64 for path_tracing, bidirectional, 16 for distributed, else 1"
std::string usual_samples_in_words() {
    std::map<int, std::string, std::greater<>> names;
    for (const RendererEntry& entry : renderers()) {
        std::string& same = names[make_renderer(entry.name)->usual_samples()];
        same += (same.empty() ? "" : ", ") + std::string(entry.name);
    }
    std::string words;
    for (const auto& [samples, of] : names) {
        if (samples > 1) words += fmt::format("{} for {}; ", samples, of);
    }
    return words + "else 1";
}

/// The renderer and its samples.
void add_sample_options(CLI::App& command, RenderArguments& args) {
    command
        .add_option("--renderer", args.render.renderer,
                    "Renderer by name; see `alhazen list renderers`")
        ->type_name("NAME[:SETTING=VALUE,...]")
        ->capture_default_str();
    command
        .add_option("--spp", args.spp,
                    fmt::format("Samples per pixel; default: {}. With --noise or --time-limit the "
                                "maximum of a pixel",
                                usual_samples_in_words()))
        ->type_name("N");
    command
        .add_option("--sampler", args.sampling.sampler,
                    "Sampler by name; see `alhazen list samplers`")
        ->type_name("NAME");
    command
        .add_option("--filter", args.sampling.filter,
                    "Reconstruction filter by name; see `alhazen list filters`")
        ->type_name("NAME[:radius=PIXELS,shared=on]");
    command
        .add_option("--noise", args.sampling.noise,
                    "More samples, in rounds, for pixels whose standard error over the root of "
                    "their value is larger")
        ->type_name("X")
        ->check(number_in(1e-6, 10.0));
    add_time_limit(command, "--time-limit", args.sampling.seconds,
                   "More samples, in rounds; no round begins that would end later")
        ->check(positive_number());
    command
        .add_option("--antialias", args.antialias,
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
        .add_option("--depth", args.depth,
                    "Recursion depth, 0 = eye rays only; default: the format's. Of what follows "
                    "paths: N + 1 scatterings at most; default: that of its setting depth")
        ->type_name("N")
        ->check(CLI::Range(0, 1000));
}

/// What surrounds the scene, and from where it is seen.
void add_view_options(CLI::App& command, RenderArguments& args) {
    command
        .add_option("--environment", args.environment,
                    "What surrounds the scene, for renderers that follow light physically: a "
                    "picture of all directions (.hdr .exr and others), a clear sky with its sun, a "
                    "neutral studio; default: the scene's, or the studio where it has no light")
        ->type_name("FILE|sky|studio|none");
    command.add_option("--camera", args.render.camera, "Camera by name or position")
        ->type_name("NAME|INDEX");
    command
        .add_option("--view", args.view,
                    "Frame the whole scene from this side instead, degrees; 0,0 is the front")
        ->type_name("AZIMUTH,ELEVATION");
    command
        .add_option(
            "--projection", args.projection,
            "Projection of the camera, with its position and direction: fisheye, "
            "equisolid (180 degrees high unless given), panorama (all around), perspective (45)")
        ->type_name("NAME[:DEGREES]");
}

/// The random numbers, and the order of the work.
void add_order_options(CLI::App& command, RenderArguments& args) {
    command.add_option("--seed", args.render.seed, "Seed of the sample positions")
        ->type_name("N")
        ->capture_default_str()
        ->check(unsigned_number());
    command.add_option("--tile-size", args.render.tile_size, "Side of a tile in pixels")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1, 4096));
}

/// How files hold values.
void add_value_options(CLI::App& command, RenderArguments& args) {
    command
        .add_option(
            "--encoding", args.encoding,
            "How PNG and JPG hold values: linear (truncated) or srgb; default: the format's")
        ->type_name("NAME");
    command.add_option("--tonemap", args.tonemap, "Curve of PNG and JPG from radiance to display")
        ->type_name("none|reinhard|aces|agx");
    command.add_option("--exposure", args.tone.stops, "PNG and JPG show 2^STOPS times the light")
        ->type_name("STOPS")
        ->check(number_in(-64.0, 64.0));
    command
        .add_option("--white-balance", args.tone.kelvin,
                    "Temperature of the light that PNG and JPG shall show as white")
        ->type_name("KELVIN")
        ->check(number_in(ToneMapping::kLeastKelvin, ToneMapping::kMostKelvin));
    command.add_option("--bits", args.bits, "Bits per channel of a PNG")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::IsMember({8, 16}));
    command.add_flag("--full-float", args.full_float, "EXR in float instead of half");
}

/// Layers besides the picture.
void add_layer_options(CLI::App& command, RenderArguments& args) {
    std::string aovs;
    for (const AovEntry& entry : aov_table()) {
        aovs += fmt::format("\n  {:<22} {}", entry.name, entry.description);
    }
    command
        .add_option("--aov", args.aovs,
                    "Layers to write besides the picture, separated by commas, or all: into the "
                    ".exr, or each to OUT.NAME.png:" +
                        aovs)
        ->type_name("LIST");
    command.add_flag("--aov-png", args.aov_png, "OUT.NAME.png of each layer beside an .exr, too");
}

/// What is counted and written besides, and what is said.
void add_report_options(CLI::App& command, RenderArguments& args) {
    command
        .add_option("--protocol", args.protocol,
                    "Count as published: spd = 513x513 corner rays, depth 5")
        ->type_name("NAME");
    command.add_flag("--no-counts", args.no_counts,
                     "With --stats: count no tests, which takes time");
    command.add_option("--stats", args.stats, "Write statistics as JSON; - for stdout")
        ->type_name("FILE");
    command
        .add_option(
            "--tables", args.tables,
            "Draw the tables of lane_carpenter or clark over the scan lines as an animated SVG")
        ->type_name("FILE");
    command
        .add_option(
            "--photons", args.photons,
            "Write the photons of photon_mapping, or of the first pass of sppm or vcm, as points "
            "of a PLY file")
        ->type_name("FILE.ply");
    command.add_flag("--spectral", args.spectral,
                     "Light by wavelengths instead of red, green and blue: glass disperses");
    add_quiet(command, args.quiet);
}

}  // namespace

void RenderArguments::add_to(CLI::App& command) {
    scene.takes_time_limit = true;
    scene.takes_shutter = true;
    scene.takes_auto_build = true;
    scene.add_to(command, kDefaultAccelerator);
    add_frame_options(command, *this);
    add_sample_options(command, *this);
    add_view_options(command, *this);
    add_order_options(command, *this);
    add_value_options(command, *this);
    add_layer_options(command, *this);
    add_report_options(command, *this);
}

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

bool writes_aov_pictures(const RenderArguments& args) {
    return args.aov_png || !holds_layers(args.output);
}

CheckedRender checked(const RenderArguments& args) {
    if (!args.encoding.empty()) (void)parse_encoding(args.encoding);
    (void)tone_mapping(args);
    RenderOptions options = render_options(args);
    std::unique_ptr<Renderer> renderer = make_renderer(options.renderer);
    const bool rounds = options.sampling && options.sampling->has_rounds();
    if (!args.spp && !rounds) options.samples_per_pixel = renderer->usual_samples();
    check_sampling(options, *renderer);
    check_antialias(options, *renderer);
    check_photons(options, *renderer);
    check_spectral(options, *renderer);
    if (!args.tables.empty() && !renderer->has_scan_lines()) {
        throw Error(ErrorKind::Usage,
                    "--tables is for renderers in scan lines: lane_carpenter, clark");
    }
    check_environment(args.environment, options.renderer);
    if (!args.view.empty()) (void)parse_view(args.view);
    if (!args.projection.empty()) (void)parse_projection(args.projection);
    CheckedRender result{std::move(options), std::move(renderer), {}};
    result.outputs = checked_outputs(args, result.options);
    check_effects(args);
    return result;
}

}  // namespace alhazen::cli
