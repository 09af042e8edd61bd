#pragma once
/// What a loaded scene needs before it is rendered: an environment, a camera, a light.

#include <optional>
#include <string>
#include <vector>

#include "alhazen/session/framing/framing.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

struct ViewWishes {
    std::optional<ViewAngles> view;  ///< of a camera that frames the scene, instead of the file's
    std::string projection;          ///< of the camera, "NAME" or "NAME:DEGREES"; empty: its own
    std::string environment;         ///< as of `set_environment`
    ImageLimits image_limits;
};

/// Sets the environment, and adds a camera and a light where there are none (`complete_view`).
/// Returns what was done, and what the renderer does not show as it is, a sentence each. A scene
/// that gets a camera must have its aggregate. A panorama is twice as wide as high unless `options`
/// give both sides. Throws Error as these.
std::vector<std::string> prepare_view(LoadedScene& loaded, const RenderOptions& options,
                                      const ViewWishes& wishes);

}  // namespace alhazen
