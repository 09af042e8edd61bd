#include "alhazen/formats/mesh/mesh_normals.h"

#include "alhazen/base/interruption.h"
#include "alhazen/formats/mesh/vertex_welder.h"

namespace alhazen {

namespace {

/// Normalises `v`; false if it has no direction. Scales first, so that squares do not over- or
/// underflow.
bool make_unit(Vec3& v) {
    const double scale = max_component(abs(v));
    if (!is_finite(v) || scale == 0.0) return false;
    const Vec3 unit = normalize(v / scale);
    if (!is_finite(unit)) return false;
    v = unit;
    return true;
}

/// [place] The sum, over the triangles at `place_of[vertex]`, of their normals times twice their
/// areas.
std::vector<Vec3> weighted_normals(const TriangleMesh& mesh,
                                   const std::vector<std::uint32_t>& place_of, std::size_t places) {
    std::vector<Vec3> sums(places);
    for (const auto& [a, b, c] : mesh.triangles) {
        interruption_point();
        const Vec3 weighted =
            cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (const std::uint32_t i : {a, b, c}) sums[place_of[i]] += weighted;
    }
    return sums;
}

}  // namespace

void make_smooth_normals(TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    TriangleMesh places;
    VertexWelder welder(places, count);
    std::vector<std::uint32_t> place_of(count), itself(count);
    for (std::size_t i = 0; i < count; ++i) {
        interruption_point();
        place_of[i] = welder.find_or_add(mesh.positions[i]);
        itself[i] = std::uint32_t(i);
    }
    const std::vector<Vec3> shared = weighted_normals(mesh, place_of, places.positions.size());
    std::vector<Vec3> own;
    mesh.normals.assign(count, {});
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 normal = shared[place_of[i]];
        if (!make_unit(normal)) {
            if (own.empty()) own = weighted_normals(mesh, itself, count);
            normal = own[i];
            if (!make_unit(normal)) normal = {0, 0, 1};
        }
        mesh.normals[i] = normal;
    }
}

void make_normals_unit(TriangleMesh& mesh) {
    std::vector<std::uint32_t> missing;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        if (make_unit(mesh.normals[i])) continue;
        mesh.normals[i] = {};
        missing.push_back(std::uint32_t(i));
    }
    if (missing.empty()) return;
    std::vector<bool> wanted(mesh.normals.size());
    for (const std::uint32_t i : missing) wanted[i] = true;
    for (const auto& [a, b, c] : mesh.triangles) {
        if (!wanted[a] && !wanted[b] && !wanted[c]) continue;
        const Vec3 weighted =
            cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (const std::uint32_t i : {a, b, c}) {
            if (wanted[i]) mesh.normals[i] += weighted;
        }
    }
    for (const std::uint32_t i : missing) {
        if (!make_unit(mesh.normals[i])) mesh.normals[i] = {0, 0, 1};
    }
}

}  // namespace alhazen
