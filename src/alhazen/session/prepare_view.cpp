#include "alhazen/session/prepare_view.h"

#include <utility>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/environment_option.h"

namespace alhazen {

std::vector<std::string> prepare_view(LoadedScene& loaded, const RenderOptions& options,
                                      const ViewWishes& wishes) {
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
    append(simplified(loaded.scene, options, *make_renderer(options.renderer)));
    return notes;
}

}  // namespace alhazen
