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

SceneDescription lights_of(const SceneDescription& description, const AddedLights& added,
                           std::size_t camera) {
    SceneDescription result;
    result.lights = description.lights;
    result.lights.back().light = added.of_cameras[camera];
    result.materials = description.materials;
    return result;
}

Scene with_lighting(const Scene& scene, const SceneDescription& description,
                    const Lighting& lighting, const AddedLights& added, std::size_t camera,
                    bool renderer_follows_light) {
    if (added.is_left_out(renderer_follows_light, lighting)) {
        Scene result = alhazen::with_lighting(scene, description, lighting);
        result.lights.pop_back();
        if (lighting.environment != "none") result.background = added.background;
        return result;
    }
    if (!added.is_another(camera)) return alhazen::with_lighting(scene, description, lighting);
    Scene result = scene;
    result.lights.back() = added.of_cameras[camera];
    return alhazen::with_lighting(result, lights_of(description, added, camera), lighting);
}

}  // namespace alhazen::viewer
