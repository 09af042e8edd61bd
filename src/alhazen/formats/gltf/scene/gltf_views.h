#pragma once
/// The cameras and lights of a glTF scene, placed in the world.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.10; KHR_lights_punctual.
/// Differs: near and far planes do not cut; the edge of a spot light's cone is our smooth step.
/// Conventions: photometric units are divided by pi, for surfaces here send back kd (N.L) of the
/// light, without Lambert's 1 / pi.

#include <span>

#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

/// `nodes`: those of the scene, in order; `world_from_node` [node]. Scale is left out of both.
void add_cameras(const Document& document, std::span<const Index> nodes,
                 const std::vector<Affine>& world_from_node, SceneDescription& scene);
void add_lights(const Document& document, std::span<const Index> nodes,
                const std::vector<Affine>& world_from_node, SceneDescription& scene);

}  // namespace alhazen::gltf
