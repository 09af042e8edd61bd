#pragma once
/// Cameras and lights of the SBT-raytracer format.
///
/// Source: docs/reference/formats/ray.md.
/// Differs: accepts spot lights in three student spellings; rejects lights with an extent.

#include <string_view>
#include <vector>

#include "alhazen/formats/ray/ray_context.h"
#include "alhazen/formats/text/text_tree.h"

namespace alhazen {

/// True for `camera` and every supported light.
[[nodiscard]] bool is_ray_camera_or_light(std::string_view name);
/// `camera` and the names of the supported lights.
[[nodiscard]] std::vector<std::string_view> ray_cameras_and_lights();
/// Adds the camera or light that `entry` describes. Precondition:
/// is_ray_camera_or_light(entry.text()).
void read_ray_camera_or_light(TextNode entry, RayContext& context);

}  // namespace alhazen
