#include "alhazen/session/generators/stress_scenes.h"

#include <cmath>
#include <utility>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "alhazen/session/generators/generated_scene.h"
#include "alhazen/session/generators/teapot_patches.h"

namespace alhazen {

namespace {

/// Adds two triangles per cell of a lattice of (columns + 1) x (rows + 1) existing vertices.
void add_lattice_triangles(TriangleMesh& mesh, std::uint32_t first, std::uint32_t columns,
                           std::uint32_t rows) {
    for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::uint32_t c = 0; c < columns; ++c) {
            const std::uint32_t a = first + r * (columns + 1) + c, d = a + columns + 1;
            mesh.triangles.push_back({a, a + 1, d + 1});
            mesh.triangles.push_back({d + 1, d, a});
        }
    }
}

/// At least `triangles` triangles, 3.15 high, standing on z = 0.
TriangleMesh teapot_mesh(std::uint64_t triangles) {
    const std::uint64_t cells = static_cast<std::uint64_t>(
        std::ceil(std::sqrt(static_cast<double>(triangles) / 64.0 + 1.0)) + 1.0);
    TriangleMesh mesh;
    for (const TeapotPatch& patch : teapot_patches()) {
        const PatchGrid grid = evaluate(patch, static_cast<int>(cells));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), grid.points.begin(), grid.points.end());
        mesh.normals.insert(mesh.normals.end(), grid.normals.begin(), grid.normals.end());
        add_lattice_triangles(mesh, first, static_cast<std::uint32_t>(cells),
                              static_cast<std::uint32_t>(cells));
    }
    return mesh;
}

/// Terraces around an oval pitch, 70 x 50 inside, 30 high, of at least `triangles` triangles.
TriangleMesh stands_mesh(std::uint64_t triangles) {
    const double cells = std::ceil(static_cast<double>(triangles) / 2.0);
    // Twelve columns per row; rows come in pairs, a riser and a tread.
    const double pairs = std::max(1.0, std::ceil(std::sqrt(cells / 12.0) / 2.0));
    const double columns = std::max(3.0, std::ceil(cells / (2.0 * pairs)));
    const auto rows = static_cast<std::uint32_t>(2.0 * pairs);
    TriangleMesh mesh;
    for (std::uint32_t r = 0; r <= rows; ++r) {
        const double up = 30.0 * ((r + 1) / 2) / pairs, out = 45.0 * (r / 2) / pairs;
        for (double c = 0; c <= columns; ++c) {
            const double a = 2.0 * kPi * (c == columns ? 0.0 : c / columns);  // closed exactly
            mesh.positions.push_back({(70.0 + out) * std::cos(a), (50.0 + out) * std::sin(a), up});
        }
    }
    add_lattice_triangles(mesh, 0, static_cast<std::uint32_t>(columns), rows);
    return mesh;
}

}  // namespace

SceneDescription stadium(std::uint64_t triangles) {
    SceneDescription scene = generated_scene({{0.75, -1.3, 0.55}, {0, 0, 0.16}, 40});
    scene.picture.background = Rgb{0.45, 0.6, 0.85};
    scene.cameras.push_back({"stands",
                             look_along({0, -85, 24}, Vec3{0, 0, 4} - Vec3{0, -85, 24}, {0, 0, 1},
                                        60.0 * kRadiansPerDegree, 1.0),
                             1.0,
                             {}});
    const MaterialId grass = add_material(scene, "grass", {0.2, 0.5, 0.15});
    const MaterialId concrete = add_material(scene, "concrete", {0.6, 0.6, 0.65});
    const MaterialId copper = add_material(scene, "copper", {0.8, 0.4, 0.2});
    std::vector<Part> parts;
    parts.push_back(part_of(
        Rectangle{.corner = {-115, -95, 0}, .edge_u = {230, 0, 0}, .edge_v = {0, 190, 0}}, grass));
    parts.push_back(part_of(add_mesh(scene, "stands", stands_mesh(triangles)), concrete));
    Part pot = part_of(add_mesh(scene, "teapot", teapot_mesh(triangles)), copper);
    pot.object_from_part = Affine::scale({0.1, 0.1, 0.1});
    parts.push_back(std::move(pot));
    scene.objects.front().parts = std::move(parts);
    return scene;
}

SceneDescription thin_sticks(std::uint64_t sticks) {
    SceneDescription scene = generated_scene({{2.3, -2.8, 2.0}, {0, 0, 0}, 40});
    const MaterialId wood = add_material(scene, "wood", {0.75, 0.6, 0.4});
    const MaterialId painted = add_material(scene, "painted", {0.3, 0.5, 0.8});
    constexpr double kLength = 1.5, kRadius = kLength / 1000.0;
    RandomStream random(1);
    for (std::uint64_t i = 0; i < sticks; ++i) {
        const Vec3 middle{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const double z = random.uniform(-1, 1), a = random.uniform(0, 2.0 * kPi);
        const double r = std::sqrt(1.0 - z * z);
        const Vec3 half = 0.5 * kLength * Vec3{r * std::cos(a), r * std::sin(a), z};
        scene.objects.front().parts.push_back(
            part_of(Cylinder{.base = middle - half, .top = middle + half, .radius = kRadius},
                    i % 2 == 0 ? wood : painted));
    }
    return scene;
}

SceneDescription coincident_clusters(std::uint64_t spheres) {
    SceneDescription scene = generated_scene({{2.3, -2.8, 2.0}, {0, 0, 0}, 40});
    const MaterialId outer = add_material(scene, "outer", {0.3, 0.6, 0.4});
    const MaterialId inner = add_material(scene, "inner", {0.9, 0.5, 0.3});
    constexpr std::uint64_t kHeap = 64;
    const double heaps = std::ceil(static_cast<double>(spheres) / kHeap);
    const double radius = 0.6 / std::cbrt(heaps);
    RandomStream random(2);
    Vec3 center;
    for (std::uint64_t i = 0; i < spheres; ++i) {
        if (i % kHeap == 0) {
            center = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        }
        const std::uint64_t place = i % kHeap;
        const double shrink = place < kHeap / 2 ? 1.0 : 1.0 - static_cast<double>(place) / 128.0;
        scene.objects.front().parts.push_back(
            part_of(Sphere{center, shrink * radius}, place < kHeap / 2 ? outer : inner));
    }
    return scene;
}

}  // namespace alhazen
