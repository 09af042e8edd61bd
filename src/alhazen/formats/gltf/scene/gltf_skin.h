#pragma once
/// Skinning of meshes by joints.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.7.3 (linear blend skinning).
/// Differs: weights are divided by their sum if it is not one.
/// Conventions: the result is in world space; the transform of the mesh's node is ignored.

#include "alhazen/formats/gltf/scene/gltf_geometry.h"
#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

/// World-from-bind-pose transform of each joint, [joint].
[[nodiscard]] std::vector<Affine> joint_matrices(const Document& document, const Skin& skin,
                                                 const std::vector<Affine>& world_from_node);

/// Transforms positions, normals and tangents. Reverses triangles whose corner transforms mirror on
/// average, so that they keep their front. Precondition: `geometry.joints.per_vertex` is not 0.
void apply_skin(PrimitiveGeometry& geometry, const std::vector<Affine>& world_from_bound);

}  // namespace alhazen::gltf
