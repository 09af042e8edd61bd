#include "alhazen/formats/gltf/scene/gltf_pose.h"

#include <algorithm>
#include <cmath>

#include "alhazen/formats/gltf/document/gltf_matrix.h"

namespace alhazen::gltf {

Pose rest_pose(const Document& document) {
    Pose pose(document.nodes.size());
    for (std::size_t i = 0; i < pose.size(); ++i) {
        const Node& node = document.nodes[i];
        if (node.matrix) pose[i].matrix = affine_of(node.matrix->data());
        pose[i].translation = {node.translation[0], node.translation[1], node.translation[2]};
        pose[i].rotation = node.rotation;
        pose[i].scale = {node.scale[0], node.scale[1], node.scale[2]};
        pose[i].weights = node.weights;
    }
    return pose;
}

Quaternion normalized(const Quaternion& q) {
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > 0.0) || !std::isfinite(length)) return {0, 0, 0, 1};
    return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

Affine transform_of(const Vec3& translation, const Quaternion& rotation, const Vec3& scale) {
    const auto [x, y, z, w] = normalized(rotation);
    Affine result;
    result.linear.x_axis =
        scale.x * Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
    result.linear.y_axis =
        scale.y * Vec3{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
    result.linear.z_axis =
        scale.z * Vec3{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    result.translation = translation;
    return result;
}

Affine affine_of(const double* column_major) {
    return matrix_of(column_major).transform;
}

std::vector<Affine> world_transforms(const Document& document, const Pose& pose) {
    std::vector<Affine> world_from_node(document.nodes.size());
    for (std::size_t i = 0; i < pose.size(); ++i) {
        const NodePose& p = pose[i];
        world_from_node[i] =
            p.matrix ? *p.matrix : transform_of(p.translation, p.rotation, p.scale);
    }
    // Parents precede their children, so each parent is complete when used.
    for (const Index node : nodes_below(document, root_nodes(document))) {
        for (const Index child : document.nodes[node].children) {
            world_from_node[child] = world_from_node[node] * world_from_node[child];
        }
    }
    return world_from_node;
}

std::vector<Index> nodes_below(const Document& document, const std::vector<Index>& roots) {
    std::vector<Index> order;
    std::vector<char> seen(document.nodes.size(), 0);
    std::vector<Index> stack(roots.rbegin(), roots.rend());
    while (!stack.empty()) {
        const Index node = stack.back();
        stack.pop_back();
        if (seen[node] != 0) continue;
        seen[node] = 1;
        order.push_back(node);
        const auto& children = document.nodes[node].children;
        stack.insert(stack.end(), children.rbegin(), children.rend());
    }
    return order;
}

std::vector<Index> visible_nodes(const Document& document, const std::vector<Index>& nodes) {
    std::vector<char> hidden(document.nodes.size(), 0);
    std::vector<Index> visible;
    for (const Index index : nodes) {
        const Node& node = document.nodes[index];
        if (!node.visible) hidden[index] = 1;
        if (hidden[index] == 0) {
            visible.push_back(index);
        } else {
            for (const Index child : node.children) hidden[child] = 1;
        }
    }
    return visible;
}

std::vector<Index> root_nodes(const Document& document) {
    std::vector<char> has_parent(document.nodes.size(), 0);
    for (const Node& node : document.nodes) {
        for (const Index child : node.children) has_parent[child] = 1;
    }
    std::vector<Index> roots;
    for (Index i = 0; i < document.nodes.size(); ++i) {
        if (has_parent[i] == 0) roots.push_back(i);
    }
    return roots;
}

}  // namespace alhazen::gltf
