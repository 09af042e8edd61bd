#include "alhazen/formats/gltf/scene/gltf_skin.h"

#include <algorithm>

#include "alhazen/math/unit_vector.h"

namespace alhazen::gltf {

namespace {

void add(Affine& sum, double weight, const Affine& m) {
    sum.linear.x_axis += weight * m.linear.x_axis;
    sum.linear.y_axis += weight * m.linear.y_axis;
    sum.linear.z_axis += weight * m.linear.z_axis;
    sum.translation += weight * m.translation;
}

/// Blended transform of a vertex.
Affine blend(const VertexJoints& joints, std::size_t vertex,
             const std::vector<Affine>& world_from_bound) {
    Affine sum{{{}, {}, {}}, {}};
    double total = 0.0;
    const std::size_t first = vertex * joints.per_vertex;
    for (std::size_t k = first; k < first + joints.per_vertex; ++k) {
        if (joints.joints[k] >= world_from_bound.size()) continue;
        add(sum, joints.weights[k], world_from_bound[joints.joints[k]]);
        total += joints.weights[k];
    }
    Affine result{{{}, {}, {}}, {}};
    if (total != 0.0) {
        add(result, 1.0 / total, sum);
    } else if (joints.joints[first] < world_from_bound.size()) {
        // A vertex without weights follows the first of its joints.
        result = world_from_bound[joints.joints[first]];
    } else {
        result = Affine{};
    }
    return result;
}

/// The normal of a transformed surface. Uses the cofactor matrix, which equals the inverse
/// transpose times the determinant and also exists for singular transforms.
Vec3 transformed_normal(const Mat3& m, const Vec3& n) {
    const Vec3 turned = n.x * cross(m.y_axis, m.z_axis) + n.y * cross(m.z_axis, m.x_axis) +
                        n.z * cross(m.x_axis, m.y_axis);
    return unit_or(determinant(m) < 0.0 ? -turned : turned, {});
}

}  // namespace

std::vector<Affine> joint_matrices(const Document& document, const Skin& skin,
                                   const std::vector<Affine>& world_from_node) {
    std::vector<double> inverse_bind;
    if (skin.inverse_bind_matrices) {
        // The accessor may be far longer than the skin and shared by many skins.
        inverse_bind = read_numbers(document, *skin.inverse_bind_matrices, skin.joints.size());
    }
    std::vector<Affine> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        Affine m = world_from_node[skin.joints[i]];
        if (16 * i + 16 <= inverse_bind.size()) m = m * affine_of(inverse_bind.data() + 16 * i);
        matrices.push_back(m);
    }
    return matrices;
}

void apply_skin(PrimitiveGeometry& geometry, const std::vector<Affine>& world_from_bound) {
    TriangleMesh& mesh = geometry.mesh;
    // [vertex] Determinant of the transform; negative: mirrored.
    std::vector<double> turned(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Affine m = blend(geometry.joints, i, world_from_bound);
        turned[i] = determinant(m.linear);
        mesh.positions[i] = m.point(mesh.positions[i]);
        if (!mesh.normals.empty()) {
            mesh.normals[i] = transformed_normal(m.linear, mesh.normals[i]);
        }
        if (!mesh.tangents.empty()) {
            VertexTangent& tangent = mesh.tangents[i];
            const Vec3 t = unit_or(m.linear * Vec3{tangent.x, tangent.y, tangent.z}, {});
            // A mirroring flips the bitangent, not the normal.
            const float sign = turned[i] < 0.0 ? -tangent.sign : tangent.sign;
            tangent = {float(t.x), float(t.y), float(t.z), sign};
        }
    }
    // A mirroring flips the winding, which defines the front.
    for (auto& [a, b, c] : mesh.triangles) {
        if (turned[a] + turned[b] + turned[c] < 0.0) std::swap(b, c);
    }
}

}  // namespace alhazen::gltf
