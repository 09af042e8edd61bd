#include "alhazen/session/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>

#include "alhazen/base/control_characters.h"
#include "alhazen/base/error.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/load.h"

namespace alhazen {

namespace {

constexpr int kDefaultHeight = 512;
constexpr int kSpdRays = 513;
/// Bounds the recursion over generations to the stack size available in every thread.
constexpr int kMaxDepth = 1000;

/// A side of a picture in whole pixels, at least 1. One that is too long stays so.
int whole_side(double pixels) {
    return static_cast<int>(std::lround(std::clamp(pixels, 1.0, 1e9)));
}

/// Refuses options that would change the counts of a protocol.
void check_protocol(const RenderOptions& options) {
    if (options.protocol == Protocol::None) return;
    if (options.width || options.height || options.crop || options.samples_per_pixel != 1 ||
        options.antialias || options.sampling) {
        throw Error(ErrorKind::Usage, "the protocol fixes size, crop and samples per pixel");
    }
}

void check(const RenderOptions& options) {
    const auto need = [](bool ok, const std::string& message) {
        if (!ok) throw Error(ErrorKind::Usage, message);
    };
    need(options.samples_per_pixel >= 1 && options.samples_per_pixel <= 1 << 20,
         fmt::format("samples per pixel must be 1 to {}, found {}", 1 << 20,
                     options.samples_per_pixel));
    need(options.tile_size >= 1,
         fmt::format("tile size must be at least 1, found {}", options.tile_size));
    need(!options.max_depth || (*options.max_depth >= 0 && *options.max_depth <= kMaxDepth),
         fmt::format("depth must be 0 to {}", kMaxDepth));
}

/// The names of the renderers for which `has` is true.
std::string renderers_where(bool (Renderer::*has)() const) {
    std::string names;
    for (const RendererEntry& entry : renderers()) {
        if (!(*make_renderer(entry.name).*has)()) continue;
        names += (names.empty() ? "" : ", ") + std::string(entry.name);
    }
    return names;
}

/// Throws if a physically based renderer would ignore scattering in volumes.
void check_scattering(const Scene& scene, const RenderOptions& options, const Renderer& renderer) {
    if (!renderer.follows_light() || renderer.scatters_in_volumes()) return;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (!scene.is_used(i) || material.scattering.coefficient.is_black()) continue;
        throw Error(ErrorKind::Usage,
                    fmt::format("material '{}' scatters light inside of volumes, which is for {}; "
                                "renderer '{}' scatters at surfaces only",
                                escape_controls(material.name),
                                renderers_where(&Renderer::scatters_in_volumes), options.renderer));
    }
}

void check_camera(const Camera& camera, const RenderOptions& options, const Renderer& renderer) {
    if (!std::holds_alternative<WideCamera>(camera)) return;
    if (!renderer.takes_wide_cameras()) {
        throw Error(ErrorKind::Usage,
                    fmt::format("fisheyes and panoramas require one of the renderers {}; renderer "
                                "'{}' supports planar projections only",
                                renderers_where(&Renderer::takes_wide_cameras), options.renderer));
    }
    if (options.antialias) {
        throw Error(ErrorKind::Usage,
                    "--antialias supports planar projections only, neither fisheyes nor panoramas");
    }
}

/// Samples per pixel for the width of texture lookups. With rounds the number is not known in
/// advance; at most 16 are assumed. With --antialias `exact` the renderer filters over parts of the
/// pixel itself; with `whitted` the samples are the four corners that every pixel has.
int samples_of_cone(const RenderOptions& options) {
    constexpr int kLeast = 16;
    constexpr int kCorners = 4;
    if (options.antialias && options.antialias->exact) return 1;
    if (options.antialias && options.antialias->step == 0) return kCorners;
    const bool rounds = options.sampling && options.sampling->has_rounds();
    return rounds ? std::min(options.samples_per_pixel, kLeast) : options.samples_per_pixel;
}

bool is_black(const ColorInput& color) {
    return color.texture == kNoTexture && color.color.is_black();
}

/// True if light that passes the surface spreads.
bool blurs_transmission(const Material& m) {
    if (m.conductor) return false;
    if (m.dielectric) return m.roughness.value > 0.0;
    if (const auto& p = m.metallic_roughness) {
        return !p->unlit && p->transmission.value > 0.0 && p->roughness.value > 0.0;
    }
    return m.roughness.value > 0.0 && !is_black(m.transmissive);
}

/// True if mirror images in the surface spread. Those of physical materials fade with the
/// roughness in all renderers.
bool blurs_reflection(const Material& m) {
    const bool physical = m.conductor || m.dielectric || m.metallic_roughness;
    return !physical && m.roughness.value > 0.0 && !is_black(m.reflective);
}

/// The scene with the overrides of the command line; shares all geometry.
Scene adjusted(const Scene& scene, const RenderOptions& options, const Renderer& renderer) {
    Scene result = scene;
    ShadingConventions& shading = result.conventions.shading;
    if (options.protocol == Protocol::Spd) apply_spd(shading, result.conventions.sampling);
    if (options.max_depth) shading.max_depth = *options.max_depth;
    renderer.adjust(shading);
    return result;
}

/// `description`: that of the scene, or null.
RenderResult render_described(const Scene& original, const SceneDescription* description,
                              const PictureSettings& picture, const RenderOptions& options) {
    check(options);
    check_protocol(options);
    const std::unique_ptr<Renderer> renderer = make_renderer(options.renderer);
    if (renderer->needs_aggregate() && !original.aggregate) {
        throw Error(ErrorKind::Usage, fmt::format("renderer '{}' needs the aggregate of the scene",
                                                  options.renderer));
    }
    check_sampling(options, *renderer);
    check_antialias(options, *renderer);
    check_photons(options, *renderer);
    check_spectral(options, *renderer);
    check_scattering(original, options, *renderer);
    check_camera(chosen_camera(original, options).camera, options, *renderer);
    const Scene scene = adjusted(original, options, *renderer);
    const CameraDescription& camera = chosen_camera(scene, options);
    const FrameSize frame = frame_size(picture, options, camera.aspect);
    const double aspect = static_cast<double>(frame.width) / frame.height;
    RenderResult result(Film(frame.width, frame.height,
                             options.crop.value_or(PixelBox{0, 0, frame.width, frame.height})));
    AovFilm aovs(options.aovs, result.film.crop());
    std::optional<TransformMotion> camera_motion;
    if (!camera.keys.empty()) camera_motion.emplace(camera.keys);
    const RenderJob job{.scene = scene,
                        .camera = with_aspect(camera.camera, camera.aspect, aspect),
                        .samples_per_pixel = options.samples_per_pixel,
                        .seed = options.seed,
                        .count_tests = options.count_tests || options.aovs.has_tests(),
                        .cone = eye_cone(camera.camera, frame.height, samples_of_cone(options)),
                        .camera_motion = camera_motion ? &*camera_motion : nullptr,
                        .aovs = options.aovs.empty() ? nullptr : &aovs,
                        .description = description,
                        .antialias = options.antialias ? &*options.antialias : nullptr,
                        .sampling = options.sampling ? &*options.sampling : nullptr,
                        .spectral = options.spectral,
                        .photons = options.keep_photons ? &result.photons : nullptr,
                        .path = options.path,
                        .control = {.threads = options.threads,
                                    .tile_size = options.tile_size,
                                    .stop = options.stop,
                                    .progress = options.progress}};
    const Stopwatch time;
    const std::clock_t processor = std::clock();
    const RenderReport report = renderer->render(job, result.film);
    result.seconds = time.seconds();
    result.processor_seconds = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
    result.counters = report.counters;
    result.threads = report.threads;
    result.tiles = report.parts;
    result.tiles_done = report.done;
    result.complete = report.complete();
    result.antialias = report.antialias;
    result.sampling = report.sampling;
    result.scan_lines = report.scan_lines;
    result.beams = report.beams;
    result.notes = report.notes;
    result.remarks = report.remarks;
    result.layers = std::move(aovs.layers());
    return result;
}

}  // namespace

const CameraDescription& chosen_camera(const Scene& scene, const RenderOptions& options) {
    return options.view != nullptr ? *options.view : find_camera(scene, options.camera);
}

FrameSize frame_size(const PictureSettings& picture, const RenderOptions& options, double aspect) {
    if (options.protocol == Protocol::Spd) return {kSpdRays, kSpdRays};
    std::optional<int> width = options.width;
    std::optional<int> height = options.height;
    if (!width && !height) {
        width = picture.width;
        height = picture.height;
    }
    if (!width && !height) height = kDefaultHeight;
    if (!width) width = whole_side(*height * aspect);
    if (!height) height = whole_side(*width / aspect);
    check_picture_size(*width, *height);
    return {*width, *height};
}

void apply_spd(ShadingConventions& shading, SamplingConventions& sampling) {
    sampling.pixel_sample = SamplingConventions::PixelSample::FrameCorners;
    shading.max_depth = 4;
    shading.min_contribution = 0.0;
    shading.transmitting_surfaces_reflect = true;
    shading.correct_interpolated_normals = false;
}

void check_antialias(const RenderOptions& options, const Renderer& renderer) {
    if (!options.antialias) return;
    if (options.antialias->exact) {
        if (!renderer.gives_exact_areas()) {
            throw Error(
                ErrorKind::Usage,
                fmt::format("--antialias exact is for renderers that know the areas of "
                            "what they show: {}; renderer '{}' does not",
                            renderers_where(&Renderer::gives_exact_areas), options.renderer));
        }
    } else if (!renderer.answers_single_rays()) {
        throw Error(
            ErrorKind::Usage,
            fmt::format("--antialias {} is for renderers that answer single rays: {}; renderer "
                        "'{}' does not",
                        options.antialias->step > 0 ? "pixel_selection" : "whitted",
                        renderers_where(&Renderer::answers_single_rays), options.renderer));
    }
    if (options.samples_per_pixel != 1) {
        throw Error(ErrorKind::Usage,
                    "--antialias chooses the samples of each pixel: it excludes --spp");
    }
    if (options.aovs.has_tests() || options.aovs.has(AovKind::Time)) {
        throw Error(ErrorKind::Usage,
                    "--antialias: pixels share their rays, so --aov time and the counts of tests "
                    "have no meaning; count.rays has");
    }
}

void check_sampling(const RenderOptions& options, const Renderer& renderer) {
    if (!options.sampling) return;
    if (!renderer.takes_samplers()) {
        const bool rounds = options.sampling->has_rounds();
        throw Error(
            ErrorKind::Usage,
            fmt::format(
                "{} are for the renderers {}{}; renderer '{}' has samples of its own",
                rounds ? "--noise and --time-limit" : "--sampler and --filter",
                renderers_where(rounds ? &Renderer::renders_in_rounds : &Renderer::takes_samplers),
                rounds ? ", vcm:merge=off" : "", options.renderer));
    }
    if (options.antialias) {
        throw Error(ErrorKind::Usage,
                    "--antialias chooses the samples of each pixel: it excludes --sampler, "
                    "--filter, --noise and --time-limit");
    }
    if (options.sampling->has_rounds() && options.aovs.has_costs()) {
        throw Error(ErrorKind::Usage,
                    "--noise and --time-limit render in rounds: --aov time and counts are for a "
                    "fixed --spp");
    }
}

void check_photons(const RenderOptions& options, const Renderer& renderer) {
    if (!options.keep_photons || renderer.has_photons()) return;
    throw Error(
        ErrorKind::Usage,
        fmt::format("--photons is for renderers that shoot some: {}; renderer '{}' does not",
                    renderers_where(&Renderer::has_photons), options.renderer));
}

void check_spectral(const RenderOptions& options, const Renderer& renderer) {
    if (!options.spectral || renderer.takes_wavelengths()) return;
    throw Error(ErrorKind::Usage,
                fmt::format("--spectral requires a renderer that traces wavelengths: {}; "
                            "renderer '{}' does not",
                            renderers_where(&Renderer::takes_wavelengths), options.renderer));
}

std::vector<std::string> simplified(const Scene& scene, const RenderOptions& options,
                                    const Renderer& renderer) {
    std::vector<std::string> notes;
    if (scene.conventions.shading.optics.any() && !renderer.heeds_optics()) {
        notes.push_back(
            fmt::format("renderer '{}' leaves out the scene's exact optics (fresnel, "
                        "beer); 'whitted' and 'distributed' have them",
                        options.renderer));
    }
    const auto scatters = [](const Material& m) { return !m.scattering.coefficient.is_black(); };
    if (!renderer.follows_light() && scene.count_used(scatters) > 0) {
        notes.push_back(
            fmt::format("renderer '{}' does not support scattering media; supported by: {}",
                        options.renderer, renderers_where(&Renderer::scatters_in_volumes)));
    }
    if (renderer.distributes()) return notes;
    const int depth = options.max_depth.value_or(scene.conventions.shading.max_depth);
    const bool shows_none_sharp =
        renderer.lights_have_extent() || !renderer.reflects() || depth == 0;
    const auto tell_rough = [&](const char* what, bool (*is_rough)(const Material&)) {
        const std::size_t rough = shows_none_sharp ? 0 : scene.count_used(is_rough);
        if (rough == 0) return;
        notes.push_back(
            fmt::format("renderer '{}' does not blur {} rough surfaces ({} material{}); "
                        "'distributed', 'cone_tracing' and the renderers of light transport do",
                        options.renderer, what, rough, rough == 1 ? "" : "s"));
    };
    tell_rough("transmission through", blurs_transmission);
    tell_rough("reflection at", blurs_reflection);
    const auto has_extent = [](const Light& l) { return std::holds_alternative<AreaLight>(l); };
    if (!renderer.lights_have_extent() &&
        std::any_of(scene.lights.begin(), scene.lights.end(), has_extent)) {
        notes.push_back(
            fmt::format("renderer '{}' replaces area lights by point lights at their "
                        "centres; 'distributed', 'cone_tracing' and the renderers of light "
                        "transport do not",
                        options.renderer));
    }
    const CameraDescription& described = chosen_camera(scene, options);
    const Camera& camera = described.camera;
    if (scene.has_motion || !described.keys.empty()) {
        notes.push_back(
            fmt::format("renderer '{}' renders the moment at which the shutter opens; "
                        "'distributed', 'ambient_occlusion' and the renderers of light transport "
                        "render all of its time",
                        options.renderer));
    }
    const auto* perspective = std::get_if<PerspectiveCamera>(&camera);
    if (perspective != nullptr && perspective->lens.radius > 0.0) {
        notes.push_back(
            fmt::format("renderer '{}' uses the centre of the lens; "
                        "'distributed' and the renderers of light transport sample all of it",
                        options.renderer));
    }
    return notes;
}

double free_aspect(const PictureSettings& picture, const RenderOptions& options) {
    constexpr double kAspect = 4.0 / 3.0;
    check_protocol(options);
    const FrameSize frame = frame_size(picture, options, kAspect);
    const bool both = (options.width && options.height) || options.protocol != Protocol::None ||
                      (!options.width && !options.height && picture.width && picture.height);
    return both ? static_cast<double>(frame.width) / frame.height : kAspect;
}

RenderResult render(const Scene& scene, const PictureSettings& picture,
                    const RenderOptions& options) {
    return render_described(scene, nullptr, picture, options);
}

RenderResult render(const LoadedScene& loaded, const RenderOptions& options) {
    return render_with_description(loaded.scene, loaded.description, options);
}

RenderResult render_with_description(const Scene& scene, const SceneDescription& description,
                                     const RenderOptions& options) {
    return render_described(scene, &description, description.picture, options);
}

}  // namespace alhazen
