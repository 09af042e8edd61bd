#pragma once
/// Moves the vertices of a skinned mesh with the joints of its skin.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.7.3 (linear blend skinning).
/// Differs: weights that do not sum to one are divided by their sum.
/// Conventions: the result is in world space; the transform of the mesh's own node plays no part.

#include "alhazen/formats/gltf/scene/gltf_geometry.h"
#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

/// [joint] from the frame of the mesh at binding to the world.
[[nodiscard]] std::vector<Affine> joint_matrices(const Document& document, const Skin& skin,
                                                 const std::vector<Affine>& world_from_node);

/// Moves positions, normals and tangents; triangles whose corners are mirrored (taken together)
/// are turned, so that they keep their front. `geometry.joints.per_vertex` must not be 0.
void apply_skin(PrimitiveGeometry& geometry, const std::vector<Affine>& world_from_bound);

}  // namespace alhazen::gltf
