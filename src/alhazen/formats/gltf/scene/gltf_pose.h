#pragma once
/// Where the nodes of a glTF document are: their local transforms, which animations change, and the
/// transforms to the world that follow.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.5.
/// Differs: quaternions need not be unit, they are made so.
/// Conventions: chains of nodes may be as long as the file: nothing here recurses.

#include <array>
#include <vector>

#include "alhazen/formats/gltf/document/gltf_document.h"
#include "alhazen/math/affine.h"

namespace alhazen::gltf {

using Quaternion = std::array<double, 4>;  ///< x, y, z, w

struct NodePose {
    std::optional<Affine> matrix;  ///< instead of the three that follow
    Vec3 translation{0, 0, 0};
    Quaternion rotation{0, 0, 0, 1};
    Vec3 scale{1, 1, 1};
    std::vector<double> weights;  ///< of morph targets; empty: those of the mesh
};

/// [node]
using Pose = std::vector<NodePose>;

[[nodiscard]] Pose rest_pose(const Document& document);

/// Unit; the identity for one that has no direction.
[[nodiscard]] Quaternion normalized(const Quaternion& q);
/// translation * rotation * scale.
[[nodiscard]] Affine transform_of(const Vec3& translation, const Quaternion& rotation,
                                  const Vec3& scale);
/// The first three rows of a column-major 4 x 4 matrix.
[[nodiscard]] Affine affine_of(const double* column_major);

/// [node] the transform from the node's frame to the world, of every node of the document.
[[nodiscard]] std::vector<Affine> world_transforms(const Document& document, const Pose& pose);

/// The nodes of a scene in depth-first order, children in the order of the file, each once.
[[nodiscard]] std::vector<Index> nodes_below(const Document& document,
                                             const std::vector<Index>& roots);
/// The nodes that are no other node's child.
[[nodiscard]] std::vector<Index> root_nodes(const Document& document);

}  // namespace alhazen::gltf
