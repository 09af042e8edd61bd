#include "alhazen/session/environment_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/shading/lights/direction_picture.h"
#include "alhazen/shading/lights/environment.h"

namespace alhazen {

namespace {

std::vector<std::string> that_follow_light() {
    std::vector<std::string> names;
    for (const RendererEntry& entry : renderers()) {
        if (follows_light(entry.name)) names.push_back(entry.name);
    }
    return names;
}

bool is_in_table(const std::string& name) {
    const auto all = environments();
    return std::any_of(all.begin(), all.end(),
                       [&](const EnvironmentEntry& entry) { return entry.name == name; });
}

EnvironmentKind kind_in_table(const std::string& name) {
    return name == "sky" ? EnvironmentKind::Sky : EnvironmentKind::Studio;
}

EnvironmentSettings settings_of(const std::string& text, const ImageLimits& limits) {
    EnvironmentSettings settings;
    if (is_in_table(text)) {
        settings.kind = kind_in_table(text);
    } else {
        settings.kind = EnvironmentKind::Picture;
        settings.file = text;
        settings.picture = std::make_shared<const Image>(read_image(text, limits));
    }
    return settings;
}

Vec3 up_of(UpAxis up_axis) {
    return up_axis == UpAxis::Z ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
}

std::string of_bad_texels(std::size_t count) {
    return fmt::format(
        "{} texels of the environment are negative, above {:g} or no numbers, and are taken as "
        "black",
        count, kLargestRadiance);
}

void set(LoadedScene& loaded, EnvironmentSettings settings) {
    loaded.scene.environment =
        std::make_shared<const Environment>(settings, up_of(loaded.description.up_axis));
    loaded.description.environment = EnvironmentDescription{std::move(settings), {}};
}

}  // namespace

bool follows_light(const std::string& renderer) {
    return make_renderer(renderer)->follows_light();
}

std::span<const EnvironmentEntry> environments() {
    static constexpr std::array<EnvironmentEntry, 3> table{{
        {"none", "black, and no light is added"},
        {"sky", "clear, with its sun"},
        {"studio", "soft boxes before grey walls"},
    }};
    return table;
}

std::shared_ptr<const Environment> make_environment(const std::string& name, UpAxis up_axis) {
    if (name == "none") return nullptr;
    EnvironmentSettings settings;
    settings.kind = kind_in_table(name);
    return std::make_shared<const Environment>(settings, up_of(up_axis));
}

void check_environment(const std::string& text, const std::string& renderer) {
    if (text.empty()) return;
    if (!follows_light(renderer)) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--environment requires a physically based renderer: {}; "
                                "renderer '{}' shows the background of the scene",
                                fmt::join(that_follow_light(), ", "), renderer));
    }
    if (is_in_table(text)) return;
    if (!std::filesystem::exists(text)) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--environment '{}': expected sky, studio, none or the file of a "
                                "picture of all directions; there is no such file",
                                text));
    }
}

bool is_dark(const LoadedScene& loaded) {
    const Scene& scene = loaded.scene;
    // In a format without surroundings a glow up to white is a label or a display, not the light.
    const double glow = loaded.description.conventions.importing.surroundings ? 1.0 : 0.0;
    return !scene.environment && scene.background.is_black() &&
           lacks_light(loaded.description, scene) && !glows(scene, glow);
}

std::vector<std::string> set_environment(LoadedScene& loaded, const std::string& text,
                                         const std::string& renderer, const ImageLimits& limits) {
    check_environment(text, renderer);
    if (text == "none") {
        loaded.description.environment.reset();
        loaded.scene.environment = nullptr;
        loaded.description.picture.background.reset();
        loaded.scene.background = {};
        return {};
    }
    if (!text.empty()) {
        set(loaded, settings_of(text, limits));
        const std::size_t bad = loaded.scene.environment->bad_texels();
        std::vector<std::string> lines;
        if (bad > 0) lines.push_back("warning: " + of_bad_texels(bad));
        const auto& picture = loaded.description.environment->settings.picture;
        if (picture && picture->held.are_none()) {
            lines.push_back("warning: " + text + ": " + kNoPixelsHeld);
        }
        return lines;
    }
    if (!follows_light(renderer) || !is_dark(loaded)) return {};
    EnvironmentSettings studio;
    studio.kind = EnvironmentKind::Studio;
    set(loaded, std::move(studio));
    return {"no lights in the file: a studio was put around it (--environment)"};
}

void warn_of_bad_texels(LoadedScene& loaded) {
    const auto& environment = loaded.scene.environment;
    if (!environment || environment->bad_texels() == 0) return;
    loaded.diagnostics.warning(loaded.description.environment->location,
                               of_bad_texels(environment->bad_texels()));
}

}  // namespace alhazen
