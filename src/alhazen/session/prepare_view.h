#pragma once
/// Completes a loaded scene for rendering: environment, camera, light.

#include <optional>
#include <string>
#include <vector>

#include "alhazen/session/framing/framing.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

struct ViewRequest {
    std::optional<ViewAngles> view;  ///< of a framing camera, instead of the file's cameras
    std::string projection;          ///< of the camera, "NAME" or "NAME:DEGREES"; empty: unchanged
    std::string environment;         ///< text for `set_environment`
    ImageLimits image_limits;
};

/// Sets the environment, and adds a camera and a light if there are none (`complete_view`). Returns
/// notes, one sentence each: what was done, and what the renderer simplifies. A scene that gets a
/// camera must have its aggregate. A panorama is twice as wide as high unless `options` give both
/// sides. Throws Error as these functions.
std::vector<std::string> prepare_view(LoadedScene& loaded, const RenderOptions& options,
                                      const ViewRequest& wishes);

}  // namespace alhazen
