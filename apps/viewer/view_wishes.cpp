#include "view_wishes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/renderers/core/antialias_settings.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/environment_option.h"
#include "wish_values.h"

namespace alhazen::viewer {

namespace {

using json = nlohmann::ordered_json;

/// A vector of the camera.
Vec3 finite_in(const json& wish, const char* key) {
    const Vec3 vector = vector_in(wish, key);
    if (!is_finite(vector)) throw Error(ErrorKind::Usage, "the camera is not finite");
    return vector;
}

Lens lens_in(const json& camera) {
    Lens lens;
    const json* const given = find_in(camera, "lens");
    if (given == nullptr) return lens;
    lens.radius = number_in(*given, "radius", 0.0);
    lens.focus_distance = number_in(*given, "focus_distance", 1.0);
    lens.blades = whole_in(*given, "blades", 0, 0, 1000);
    lens.turn = number_in(*given, "turn", 0.0);
    if (!(lens.radius >= 0.0 && std::isfinite(lens.radius) && lens.focus_distance > 0.0 &&
          std::isfinite(lens.focus_distance) && std::isfinite(lens.turn) && lens.blades != 1 &&
          lens.blades != 2)) {
        throw Error(ErrorKind::Usage,
                    "the lens must have a radius that is not negative, a focus distance above 0 "
                    "and no blades or 3 to 1000");
    }
    return lens;
}

Camera camera_in(const json& wish) {
    const Vec3 eye = finite_in(wish, "eye"), look = finite_in(wish, "look");
    const Vec3 right = finite_in(wish, "right"), up = finite_in(wish, "up");
    if (look == Vec3{} || right == Vec3{} || up == Vec3{}) {
        throw Error(ErrorKind::Usage, "the camera has no extent");
    }
    if (flag_in(wish, "parallel")) return OrthographicCamera{eye, look, right, up};
    return PerspectiveCamera{eye, look, right, up, lens_in(wish)};
}

/// The picture's width / height for which the sides of the camera are given.
double aspect_in(const json& camera, double usual) {
    const double aspect = number_in(camera, "aspect", usual);
    if (!(aspect > 0.0 && std::isfinite(aspect))) {
        throw Error(ErrorKind::Usage, "the aspect of the camera must be above 0");
    }
    return aspect;
}

ToneMapping tone_in(const json& wish) {
    ToneMapping tone;
    tone.stops = number_in(wish, "exposure", 0.0);
    if (!(std::abs(tone.stops) <= 64.0)) {
        throw Error(ErrorKind::Usage, "exposure must be -64 to 64 stops");
    }
    const std::string curve = text_in(wish, "curve", "none");
    const auto* const names = std::begin(kToneCurveNames);
    const auto* const found = std::find(names, std::end(kToneCurveNames), curve);
    if (found == std::end(kToneCurveNames)) {
        throw Error(ErrorKind::Usage, "there is no tone curve '" + curve + "'");
    }
    tone.curve = static_cast<ToneCurve>(found - names);
    return tone;
}

/// Replaces many samples by exact pixel areas for renderers that compute them.
void use_exact_areas(RenderOptions& options) {
    if (options.samples_per_pixel == 1) return;
    if (!make_renderer(options.renderer)->gives_exact_areas()) return;
    options.samples_per_pixel = 1;
    if (options.aovs.has_tests() || options.aovs.has(AovKind::Time)) return;
    options.antialias.emplace();
    options.antialias->exact = true;
}

/// Colour difference below which a mean is shown while the view moves; may blur reflections.
constexpr double kMovingThreshold = 0.15;

/// Traces rays for some pixels only, if the renderer can and no other option needs all.
void select_pixels(RenderOptions& options) {
    if (options.antialias || options.samples_per_pixel != 1 || !options.aovs.empty()) return;
    if (!make_renderer(options.renderer)->answers_single_rays()) return;
    options.antialias = parse_antialias("pixel_selection");
    options.antialias->threshold = kMovingThreshold;
}

/// Environments apply to physically based renderers; other renderers keep that of the scene.
Lighting lighting_in(const json& wish, const std::string& renderer) {
    Lighting lighting;
    lighting.off = texts_in(wish, "lights_off");
    lighting.changes = light_changes(wish);
    const std::string name = text_in(wish, "environment", "");
    if (name.empty()) return lighting;
    std::string known;
    for (const EnvironmentEntry& entry : environments()) {
        if (name == entry.name && follows_light(renderer)) lighting.environment = name;
        if (name == entry.name) return lighting;
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    throw Error(ErrorKind::Usage,
                fmt::format("there is no environment '{}'; expected one of {}", name, known));
}

const AovEntry* layer_in(const json& wish) {
    const std::string name = text_in(wish, "layer", "");
    if (name.empty()) return nullptr;
    std::string known;
    for (const AovEntry& entry : aov_table()) {
        if (name == entry.name) return &entry;
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    throw Error(ErrorKind::Usage,
                fmt::format("there is no layer '{}'; expected one of {}", name, known));
}

}  // namespace

std::vector<LightChange> light_changes(const json& wish) {
    std::vector<LightChange> changes;
    const json* const lights = find_in(wish, "lights");
    if (lights == nullptr) return changes;
    if (!lights->is_array()) throw Error(ErrorKind::Usage, "lights must be a list of objects");
    for (const json& light : *lights) {
        LightChange& change = changes.emplace_back();
        change.name = text_in(light, "name");
        if (light.contains("position")) change.position = vector_in(light, "position");
        if (light.contains("direction")) change.direction = vector_in(light, "direction");
        if (light.contains("sizes")) change.sizes = numbers_in(light, "sizes");
        if (!light.contains("color")) continue;
        const Vec3 color = vector_in(light, "color");
        change.color = Rgb{color.x, color.y, color.z};
    }
    return changes;
}

std::size_t camera_number(const json& camera) {
    return static_cast<std::size_t>(whole_in(camera, "of", 0, 0, std::numeric_limits<int>::max()));
}

FrameWish frame_wish(const json& wish) {
    FrameWish result;
    RenderOptions& options = result.options;
    options.width = whole_in(wish, "width", 640, 1, 4096);
    options.height = whole_in(wish, "height", 360, 1, 4096);
    const json& camera = value_in(wish, "camera");
    result.camera.camera = camera_in(camera);
    result.camera.aspect = aspect_in(camera, static_cast<double>(*options.width) / *options.height);
    result.of = camera_number(camera);
    options.renderer = text_in(wish, "renderer", "whitted");
    options.samples_per_pixel = whole_in(wish, "samples", 1, 1, 1024);
    if (wish.contains("depth")) {
        options.max_depth = whole_in(wish, "depth", 5, 0, 100);
        options.renderer = with_depth(options.renderer, *options.max_depth);
    }
    result.layer = layer_in(wish);
    if (result.layer != nullptr) options.aovs.add(result.layer->kind);
    use_exact_areas(options);
    if (flag_in(wish, "selected")) select_pixels(options);
    result.lighting = lighting_in(wish, options.renderer);
    result.tone = tone_in(wish);
    result.png = flag_in(wish, "png");
    result.raw = flag_in(wish, "raw") && !result.png;
    return result;
}

}  // namespace alhazen::viewer
