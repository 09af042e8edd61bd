#pragma once
/// Cameras and lights of a glTF scene in world space.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.10; KHR_lights_punctual.
/// Differs: near and far planes do not clip; the edge of a spot cone is the smoothstep of Alhazen's
/// spot lights.
/// Conventions: photometric units are divided by pi, because surfaces reflect kd (N.L) of a light,
/// without Lambert's 1 / pi.

#include <span>

#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

/// `nodes`: those of the scene, in order; `world_from_node`: [node]. Ignores scale in transforms.
void add_cameras(const Document& document, std::span<const Index> nodes,
                 const std::vector<Affine>& world_from_node, SceneDescription& scene);
void add_lights(const Document& document, std::span<const Index> nodes,
                const std::vector<Affine>& world_from_node, SceneDescription& scene);

}  // namespace alhazen::gltf
