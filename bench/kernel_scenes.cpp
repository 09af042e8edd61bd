#include "kernel_scenes.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/importers/mesh_io.h"

namespace alhazen::bench {

namespace {

/// Unit sphere: an icosahedron whose triangles are split into four `splits` times.
TriangleMesh icosphere(int splits) {
    TriangleMesh mesh;
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int s = 0; s < splits; ++s) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [place, fresh] =
                middles.try_emplace(std::minmax(a, b), mesh.positions.size());
            if (fresh) mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
            return place->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    for (Vec3& p : mesh.positions) p = normalize(p);
    return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const Vec3& center, double radius) {
    const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : part.positions) mesh.positions.push_back(center + radius * p);
    for (const auto& [a, b, c] : part.triangles) {
        mesh.triangles.push_back({a + offset, b + offset, c + offset});
    }
}

/// A sphere and, around it, nine of a third of its radius: six around the equator, three above.
void flake(TriangleMesh& mesh, const TriangleMesh& ball, const Vec3& center, double radius,
           const Vec3& axis, int depth) {
    append(mesh, ball, center, radius);
    if (depth == 0) return;
    const Vec3 u = perpendicular(axis);
    const Vec3 v = cross(axis, u);
    for (int i = 0; i < 9; ++i) {
        const bool equator = i < 6;
        const double around = equator ? i * 1.0471975511965976 : (i - 6) * 2.0943951023931953 + 0.5;
        const double up = equator ? 0.0 : 0.8660254037844386;
        const double out = std::sqrt(1.0 - up * up);
        const Vec3 d = out * (std::cos(around) * u + std::sin(around) * v) + up * axis;
        flake(mesh, ball, center + (4.0 / 3.0 * radius) * d, radius / 3.0, d, depth - 1);
    }
}

/// So that a kernel in float has the same triangles.
void round_to_float(TriangleMesh& mesh) {
    for (Vec3& p : mesh.positions) {
        for (int k = 0; k < 3; ++k) p[k] = static_cast<double>(static_cast<float>(p[k]));
    }
}

}  // namespace

KernelScene mesh_scene(const std::string& name, const std::filesystem::path& file) {
    Diagnostics diagnostics;
    KernelScene scene{name, read_mesh(file, {}, diagnostics), {}, {}};
    diagnostics.throw_if_errors();
    scene.mesh.normals.clear();
    scene.mesh.uvs.clear();
    round_to_float(scene.mesh);
    const Box3 box = scene.mesh.box();
    scene.look_at = box.center();
    scene.eye = box.center() + 1.2 * length(box.size()) * normalize(Vec3{0.3, 0.2, 1});
    return scene;
}

KernelScene tessellated_balls(int depth, int splits) {
    KernelScene scene{"balls", {}, {2.1, 1.3, 1.7}, {0, 0, 0}};
    flake(scene.mesh, icosphere(splits), {0, 0, 0}, 0.5, {0, 0, 1}, depth);
    const auto first = static_cast<std::uint32_t>(scene.mesh.positions.size());
    for (const double x : {-12.0, 12.0}) {
        for (const double y : {-12.0, 12.0}) scene.mesh.positions.push_back({x, y, -0.5});
    }
    scene.mesh.triangles.insert(scene.mesh.triangles.end(),
                                {{first, first + 2, first + 3}, {first, first + 3, first + 1}});
    round_to_float(scene.mesh);
    return scene;
}

}  // namespace alhazen::bench
