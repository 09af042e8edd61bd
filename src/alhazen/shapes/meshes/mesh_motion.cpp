#include "alhazen/shapes/meshes/mesh_motion.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

const char* fault_of(const TriangleMesh& mesh, std::span<const MeshKey> keys) {
    const auto finite = [](const Vec3& v) { return is_finite(v); };
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const MeshKey& key = keys[i];
        if (!std::isfinite(key.time) || (i > 0 && !(keys[i - 1].time < key.time))) {
            return "the times of a mesh's keys must ascend";
        }
        if (key.positions.size() != mesh.positions.size()) {
            return "every key of a mesh needs as many points as the mesh";
        }
        if (!key.normals.empty() && key.normals.size() != mesh.normals.size()) {
            return "every key of a mesh needs as many normals as the mesh, or none";
        }
        if (!std::all_of(key.positions.begin(), key.positions.end(), finite) ||
            !std::all_of(key.normals.begin(), key.normals.end(), finite)) {
            return "the points and normals of a mesh's keys must be finite";
        }
    }
    return nullptr;
}

MeshMotion::Moment MeshMotion::moment(double time) const {
    if (time <= keys_.front().time) return {0, 0.0};
    if (time >= keys_.back().time) return {keys_.size() - 1, 0.0};
    std::size_t i = 0;
    while (time >= keys_[i + 1].time) ++i;
    return {i, (time - keys_[i].time) / (keys_[i + 1].time - keys_[i].time)};
}

Vec3 MeshMotion::position(std::uint32_t vertex, const Moment& m) const {
    const Vec3& a = keys_[m.i].positions[vertex];
    if (m.share == 0.0) return a;
    return (1.0 - m.share) * a + m.share * keys_[m.i + 1].positions[vertex];
}

Vec3 MeshMotion::normal(std::uint32_t vertex, const Moment& m) const {
    const Vec3& a = keys_[m.i].normals[vertex];
    if (m.share == 0.0) return a;
    const Vec3 sum = (1.0 - m.share) * a + m.share * keys_[m.i + 1].normals[vertex];
    return length_squared(sum) > 0.0 ? normalize(sum) : a;
}

std::array<Vec3, 3> MeshMotion::positions_at(const Corners& corners, double time) const {
    const Moment m = moment(time);
    return {position(corners[0], m), position(corners[1], m), position(corners[2], m)};
}

MovingBox MeshMotion::box(const Corners& corners) const {
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return {};
    const auto box_at = [&](double time) {
        Box3 box;
        for (const Vec3& p : positions_at(corners, time)) box.include(p);
        return padded(box, 1e-13);
    };
    MovingBox box{box_at(0.0), box_at(1.0)};
    for (const MeshKey& key : keys_) {
        if (key.time > 0.0 && key.time < 1.0) box.widen_to(key.time, box_at(key.time));
    }
    return box;
}

TriangleMesh MeshMotion::triangle_at(const TriangleMesh& mesh, std::size_t triangle,
                                     double time) const {
    const Moment m = moment(time);
    TriangleMesh alone;
    alone.triangles = {{0, 1, 2}};
    const auto copy = [](const auto& from, std::uint32_t vertex, auto& to) {
        if (!from.empty()) to.push_back(from[vertex]);
    };
    for (const std::uint32_t vertex : mesh.triangles[triangle]) {
        alone.positions.push_back(position(vertex, m));
        if (!mesh.normals.empty()) {
            const bool moves = !keys_[m.i].normals.empty();
            alone.normals.push_back(moves ? normal(vertex, m) : mesh.normals[vertex]);
        }
        copy(mesh.uvs, vertex, alone.uvs);
        copy(mesh.uvs2, vertex, alone.uvs2);
        copy(mesh.colors, vertex, alone.colors);
        copy(mesh.tangents, vertex, alone.tangents);
        copy(mesh.vertex_materials, vertex, alone.vertex_materials);
    }
    return alone;
}

void MeshMotion::pose(double time, TriangleMesh& mesh) const {
    const Moment m = moment(time);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) mesh.positions[v] = position(v, m);
    if (keys_[m.i].normals.empty()) return;
    for (std::uint32_t v = 0; v < mesh.normals.size(); ++v) mesh.normals[v] = normal(v, m);
}

std::size_t MeshMotion::memory_bytes() const {
    std::size_t bytes = 0;
    for (const MeshKey& key : keys_) {
        bytes += (key.positions.capacity() + key.normals.capacity()) * sizeof(Vec3);
    }
    return bytes;
}

}  // namespace alhazen
