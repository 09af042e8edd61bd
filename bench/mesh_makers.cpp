#include "mesh_makers.h"

#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace alhazen::bench {

TriangleMesh icosphere(int splits) {
    TriangleMesh mesh;
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int s = 0; s < splits; ++s) split_triangles(mesh);
    for (Vec3& p : mesh.positions) p = normalize(p);
    return mesh;
}

TriangleMesh latitude_ball(std::uint32_t rings, std::uint32_t sectors, double bump) {
    TriangleMesh mesh;
    const auto add = [&](double theta, double phi) {
        const double r = 1 + bump * std::sin(40 * theta) * std::sin(40 * phi);
        mesh.positions.push_back({r * std::sin(theta) * std::cos(phi),
                                  r * std::sin(theta) * std::sin(phi), r * std::cos(theta)});
    };
    mesh.positions.reserve(std::size_t{rings} * sectors + 2);
    mesh.triangles.reserve(std::size_t{2} * rings * sectors);
    for (std::uint32_t i = 0; i < rings; ++i) {
        for (std::uint32_t j = 0; j < sectors; ++j) {
            add(std::numbers::pi * (i + 1) / (rings + 1), 2 * std::numbers::pi * j / sectors);
        }
    }
    add(0, 0);
    add(std::numbers::pi, 0);
    const std::uint32_t top = rings * sectors;
    for (std::uint32_t j = 0; j < sectors; ++j) {
        const std::uint32_t k = (j + 1) % sectors;
        mesh.triangles.push_back({top, j, k});
        for (std::uint32_t i = 0; i + 1 < rings; ++i) {
            const std::uint32_t a = i * sectors, b = a + sectors;
            mesh.triangles.push_back({a + j, b + j, b + k});
            mesh.triangles.push_back({a + j, b + k, a + k});
        }
        const std::uint32_t last = (rings - 1) * sectors;
        mesh.triangles.push_back({top + 1, last + k, last + j});
    }
    return mesh;
}

void split_triangles(TriangleMesh& mesh) {
    std::unordered_map<std::uint64_t, std::uint32_t> middles;
    middles.reserve(2 * mesh.triangles.size());
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [lo, hi] = std::minmax(a, b);
        const auto [place, fresh] =
            middles.try_emplace(std::uint64_t{hi} << 32 | lo, mesh.positions.size());
        if (fresh) mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
        return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const Vec3& center, double radius) {
    const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : part.positions) mesh.positions.push_back(center + radius * p);
    for (const auto& [a, b, c] : part.triangles) {
        mesh.triangles.push_back({a + offset, b + offset, c + offset});
    }
}

double to_float(double x) {
    return static_cast<double>(static_cast<float>(x));
}

Vec3 to_float(const Vec3& v) {
    return {to_float(v.x), to_float(v.y), to_float(v.z)};
}

void round_to_float(TriangleMesh& mesh) {
    for (Vec3& p : mesh.positions) p = to_float(p);
}

}  // namespace alhazen::bench
