#include "alhazen/session/prepare_view.h"

#include <utility>

#include "alhazen/cameras/projection.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/environment_option.h"

namespace alhazen {

namespace {

void project(LoadedScene& loaded, const RenderOptions& options, const Projection& projection) {
    const auto chosen = static_cast<std::size_t>(&find_camera(loaded.scene, options.camera) -
                                                 loaded.scene.cameras.data());
    CameraDescription& camera = loaded.scene.cameras[chosen];
    camera.camera = with_projection(camera.camera, projection, camera.aspect);
    PictureSettings& picture = loaded.description.picture;
    if (projection.name == "panorama" && picture.height) picture.width = 2 * *picture.height;
    if (chosen < loaded.description.cameras.size()) loaded.description.cameras[chosen] = camera;
}

}  // namespace

std::vector<std::string> prepare_view(LoadedScene& loaded, const RenderOptions& options,
                                      const ViewRequest& wishes) {
    std::vector<std::string> notes =
        set_environment(loaded, wishes.environment, options.renderer, wishes.image_limits);
    const auto append = [&](std::vector<std::string> more) {
        for (std::string& note : more) notes.push_back(std::move(note));
    };
    FramingOptions framing;
    framing.view = wishes.view;
    framing.camera = options.camera;
    framing.aspect = free_aspect(loaded.description.picture, options);
    framing.follows_light = follows_light(options.renderer);
    framing.nothing_around = wishes.environment == "none";
    append(complete_view(loaded.description, loaded.scene, framing));
    if (!wishes.projection.empty()) project(loaded, options, parse_projection(wishes.projection));
    append(simplified(loaded.scene, options, *make_renderer(options.renderer)));
    return notes;
}

}  // namespace alhazen
