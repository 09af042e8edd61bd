#include "alhazen/formats/mesh/mesh_normals.h"

namespace alhazen {

namespace {

/// Normalises `v`; false when it has no direction. Scales first, so that squares neither underflow
/// nor overflow.
bool make_unit(Vec3& v) {
    const double scale = max_component(abs(v));
    if (!is_finite(v) || scale == 0.0) return false;
    const Vec3 unit = normalize(v / scale);
    if (!is_finite(unit)) return false;
    v = unit;
    return true;
}

}  // namespace

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
