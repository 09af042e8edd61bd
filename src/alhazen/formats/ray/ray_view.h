#pragma once
/// Cameras and lights of the SBT-raytracer format.
///
/// Source: docs/reference/formats/ray.md.
/// Differs: spot lights of three student spellings are read; lights with an extent are refused.

#include <string_view>

#include "alhazen/formats/ray/ray_context.h"
#include "alhazen/formats/text/text_tree.h"

namespace alhazen {

/// True for `camera` and every light that is read.
[[nodiscard]] bool is_ray_camera_or_light(std::string_view name);
/// Adds the camera or light that `entry` describes. Precondition:
/// is_ray_camera_or_light(entry.text()).
void read_ray_camera_or_light(TextNode entry, RayContext& context);

}  // namespace alhazen
