#pragma once
/// Local transforms of the nodes of a glTF document, which animations modify, and the resulting
/// world transforms.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.5.
/// Differs: quaternions are normalised; they need not be unit.
/// Conventions: no function recurses, since chains of nodes may be as long as the file.

#include <array>
#include <vector>

#include "alhazen/formats/gltf/document/gltf_document.h"
#include "alhazen/math/affine.h"

namespace alhazen::gltf {

using Quaternion = std::array<double, 4>;  ///< x, y, z, w

struct NodePose {
    std::optional<Affine> matrix;  ///< replaces translation, rotation and scale
    Vec3 translation{0, 0, 0};
    Quaternion rotation{0, 0, 0, 1};
    Vec3 scale{1, 1, 1};
    std::vector<double> weights;  ///< of morph targets; empty: weights of the mesh
};

/// [node]
using Pose = std::vector<NodePose>;

[[nodiscard]] Pose rest_pose(const Document& document);

/// The unit quaternion; the identity for one that is zero or not finite.
[[nodiscard]] Quaternion normalized(const Quaternion& q);
/// Translation * rotation * scale.
[[nodiscard]] Affine transform_of(const Vec3& translation, const Quaternion& rotation,
                                  const Vec3& scale);
/// The transform of a column-major 4 x 4 matrix.
[[nodiscard]] Affine affine_of(const double* column_major);

/// World-from-node transform of every node of the document, [node].
[[nodiscard]] std::vector<Affine> world_transforms(const Document& document, const Pose& pose);

/// Nodes of a scene in depth-first order, children in file order, each once.
[[nodiscard]] std::vector<Index> nodes_below(const Document& document,
                                             const std::vector<Index>& roots);
/// The nodes of `nodes`, parents before children, that are hidden neither themselves nor by an
/// ancestor.
[[nodiscard]] std::vector<Index> visible_nodes(const Document& document,
                                               const std::vector<Index>& nodes);
/// Nodes without a parent.
[[nodiscard]] std::vector<Index> root_nodes(const Document& document);

}  // namespace alhazen::gltf
