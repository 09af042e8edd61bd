#include "added_lights.h"

#include "alhazen/session/environment_option.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/session/render.h"

namespace alhazen::viewer {

AddedLights complete(LoadedScene& loaded) {
    SceneDescription& description = loaded.description;
    Scene& scene = loaded.scene;
    FramingOptions framing;
    framing.aspect = free_aspect(description.picture, {});
    const std::size_t lights = scene.lights.size();
    const bool lacks = lacks_light(description, scene);
    AddedLights added;
    added.background = scene.background;
    added.studio = is_dark(loaded);
    added.follows_light = !added.studio && !scene.environment && !glows(scene) &&
                          (!lacks || scene.background.is_black());
    (void)complete_view(description, scene, framing);
    added.any = scene.lights.size() > lights;
    if (!added.any || !lacks) return added;
    for (const CameraDescription& camera : scene.cameras) {
        added.of_cameras.push_back(headlight(camera.camera));
    }
    return added;
}

std::optional<Light> AddedLights::of_view(const Camera& view) const {
    if (of_cameras.empty()) return std::nullopt;
    const Light own = headlight(view);
    const auto place = [](const Light& light) {
        const auto* const point = std::get_if<PointLight>(&light);
        return point != nullptr ? point->position : std::get<DirectionalLight>(light).to_light;
    };
    const Light& first = of_cameras.front();
    if (own.index() == first.index() && place(own) == place(first)) return std::nullopt;
    return own;
}

SceneDescription lights_of(const SceneDescription& description, const Light& headlight) {
    SceneDescription result;
    result.lights = description.lights;
    result.lights.back().light = headlight;
    result.materials = description.materials;
    return result;
}

Scene with_lighting(const Scene& scene, const SceneDescription& description,
                    const Lighting& lighting, const AddedLights& added, const Camera& view,
                    bool renderer_follows_light) {
    if (added.is_left_out(renderer_follows_light, lighting)) {
        Scene result = alhazen::with_lighting(scene, description, lighting);
        result.lights.pop_back();
        if (lighting.environment != "none") result.background = added.background;
        return result;
    }
    const std::optional<Light> own = added.of_view(view);
    if (!own) return alhazen::with_lighting(scene, description, lighting);
    Scene result = scene;
    result.lights.back() = *own;
    return alhazen::with_lighting(result, lights_of(description, *own), lighting);
}

}  // namespace alhazen::viewer
