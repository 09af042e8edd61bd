#pragma once
/// Parses the requests of the viewer's page from JSON.
///
/// Conventions: throws Error (Usage) for values of the wrong type (wish_values.h) or out of range.

#include <nlohmann/json.hpp>
#include <vector>

#include "alhazen/imaging/image/tone_mapping.h"
#include "alhazen/scene/scene.h"
#include "alhazen/session/lighting.h"
#include "alhazen/session/render.h"

namespace alhazen::viewer {

/// The camera and the options of a frame.
struct FrameWish {
    CameraDescription camera;
    std::size_t of = 0;     ///< the camera of the scene at which the view began
    RenderOptions options;  ///< without `view`, `threads` and `stop`
    Lighting lighting;      ///< without its environment
    ToneMapping tone;
    const AovEntry* layer = nullptr;  ///< shown instead of the colours; null: none
    bool png = false;
    bool raw = false;  ///< red, green, blue, 255 of each pixel, unless `png`
};

/// The changes of lights of a request.
[[nodiscard]] std::vector<LightChange> light_changes(const nlohmann::ordered_json& wish);

/// The position of the camera at which the view began; 0 if it is missing.
[[nodiscard]] std::size_t camera_number(const nlohmann::ordered_json& camera);

[[nodiscard]] FrameWish frame_wish(const nlohmann::ordered_json& wish);

}  // namespace alhazen::viewer
