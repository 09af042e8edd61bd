// Merged triangles: flat parts become few, all else keeps its distance, materials and coordinates.

#include "alhazen/solids/triangles/collapsed_edges.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "alhazen/geometry/polygon/merged_positions.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/shapes/meshes/mesh_edges.h"
#include "mesh_distance.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;

/// A cube of edge 2 with n x n squares on each face; each face has vertices of its own.
TriangleMesh cube(int n, const std::function<std::uint32_t(const Vec3&)>& material_at,
                  const std::function<Vec2(const Vec3&)>& uv_at) {
    TriangleMesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double side = face % 2 == 0 ? -1 : 1;
        for (int i = 0; i < n; ++i) {
            for (int k = 0; k < n; ++k) {
                const auto first = static_cast<std::uint32_t>(mesh.positions.size());
                Vec3 middle, normal;
                normal[axis] = side;
                for (int corner = 0; corner < 4; ++corner) {
                    Vec3 p;
                    p[axis] = side;
                    p[u] = -1 + 2.0 * (i + corner % 2) / n;
                    p[v] = -1 + 2.0 * (k + corner / 2) / n;
                    middle += 0.25 * p;
                    mesh.positions.push_back(p);
                    mesh.normals.push_back(normal);
                    mesh.uvs.push_back(uv_at(p));
                }
                mesh.vertex_materials.resize(mesh.positions.size(), material_at(middle));
                const std::uint32_t a = side > 0 ? 1 : 2, b = 3 - a;
                mesh.triangles.push_back({first, first + a, first + b});
                mesh.triangles.push_back({first + 3, first + b, first + a});
            }
        }
    }
    return mesh;
}
std::uint32_t one(const Vec3&) {
    return 0;
}
Vec2 none(const Vec3&) {
    return {0, 0};
}

std::map<std::uint32_t, double> area_of_materials(const TriangleMesh& mesh) {
    std::map<std::uint32_t, double> areas;
    for (const auto& [a, b, c] : mesh.triangles) {
        EXPECT_EQ(mesh.vertex_materials[a], mesh.vertex_materials[b]);
        EXPECT_EQ(mesh.vertex_materials[a], mesh.vertex_materials[c]);
        areas[mesh.vertex_materials[a]] +=
            0.5 * length(cross(mesh.positions[b] - mesh.positions[a],
                               mesh.positions[c] - mesh.positions[a]));
    }
    return areas;
}

TEST(CollapsedEdges, LeaveACubeItsTwelveTriangles) {
    for (const int n : {2, 7, 16}) {
        TriangleMesh mesh = cube(n, one, none);
        collapse_edges(mesh, merged_positions(mesh.positions), 1e-3, 1);
        EXPECT_EQ(mesh.triangles.size(), 12u);
        EXPECT_TRUE(mesh_edges(mesh).oriented());
        EXPECT_NEAR(signed_volume(mesh), 8, 1e-12);
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3 face =
                cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
            for (const std::uint32_t v : {a, b, c}) {
                EXPECT_NEAR(dot(unit_or(face, {}), mesh.normals[v]), 1, 1e-12);
            }
        }
    }
}

TEST(CollapsedEdges, KeepTheLinesBetweenMaterials) {
    // Straight lines.
    TriangleMesh halves = cube(
        8, [](const Vec3& p) { return p.x > 0 ? 1u : 0u; }, none);
    collapse_edges(halves, merged_positions(halves.positions), 1e-3, 1);
    EXPECT_LE(halves.triangles.size(), 24u);
    EXPECT_NEAR(area_of_materials(halves)[1], 12, 1e-12);
    // A stair along a circle on each of two faces: flat, so that heights bound nothing.
    const auto in_disc = [](const Vec3& p) {
        return std::abs(p.z) > 0.99 && std::hypot(p.x, p.y) < 0.7 ? 1u : 0u;
    };
    const TriangleMesh fine = cube(48, in_disc, none);
    const double area = area_of_materials(fine).at(1);
    for (const double distance : {0.01, 0.05}) {
        TriangleMesh mesh = fine;
        collapse_edges(mesh, merged_positions(mesh.positions), distance, 1);
        EXPECT_LT(mesh.triangles.size(), distance == 0.01 ? 3000u : 300u);
        EXPECT_NEAR(area_of_materials(mesh).at(1), area, 2 * 5.6 * distance);
        EXPECT_TRUE(mesh_edges(mesh).oriented());
    }
}

TEST(CollapsedEdges, ChangeTextureCoordinatesByNoMoreThanGiven) {
    const auto uv_at = [](const Vec3& p) { return Vec2{p.x * p.x, p.y + 0.3 * p.z * p.x}; };
    constexpr int kSquares = 32;
    const TriangleMesh fine = cube(kSquares, one, uv_at);
    // The error of linear coordinates in the squares.
    const double own = 0.25 / (0.25 * kSquares * kSquares) * 1.6;
    for (const double most : {0.01, 0.1}) {
        TriangleMesh mesh = fine;
        collapse_edges(mesh, merged_positions(mesh.positions), 1e-3, most);
        EXPECT_LT(mesh.triangles.size(), fine.triangles.size() / 2);
        Random random(5);
        for (const auto& t : mesh.triangles) {
            for (int i = 0; i < 20; ++i) {
                double a = random.uniform(), b = random.uniform();
                if (a + b > 1) a = 1 - a, b = 1 - b;
                const double w[3] = {a, b, 1 - a - b};
                Vec3 p;
                Vec2 uv{0, 0};
                for (std::size_t k = 0; k < 3; ++k) {
                    p += w[k] * mesh.positions[t[k]];
                    uv = uv + w[k] * mesh.uvs[t[k]];
                }
                const Vec2 off = uv - uv_at(p);
                ASSERT_LE(std::max(std::abs(off.x), std::abs(off.y)), most + own);
            }
        }
    }
}

TEST(CollapsedEdges, KeepTheirDistanceInBothDirections) {
    Random random(9);
    for (int round = 0; round < 4; ++round) {
        // A sphere with random waves, through the same cube.
        TriangleMesh fine = cube(10, one, none);
        const Vec3 wave = 4 * random.unit_vector(), other = 9 * random.unit_vector();
        const double rough = round % 3 == 0 ? 0.0 : 0.02 * round;
        std::map<std::array<double, 3>, double> noise;
        for (Vec3& p : fine.positions) {
            const Vec3 d = normalize(p);
            const auto [at, is_new] = noise.try_emplace(std::array<double, 3>{p.x, p.y, p.z});
            if (is_new) at->second = 0.1 * rough * random.uniform(-1, 1);
            p = (1 + rough * (std::sin(dot(wave, d)) + std::sin(dot(other, d))) + at->second) * d;
        }
        fine.generate_normals();
        for (std::size_t v = 0; v < fine.normals.size(); ++v) {
            fine.normals[v] = normalize(fine.positions[v]);
        }
        for (const double distance : {0.01, 0.05}) {
            TriangleMesh mesh = fine;
            collapse_edges(mesh, merged_positions(mesh.positions), distance, 1);
            EXPECT_LT(mesh.triangles.size(), fine.triangles.size());
            EXPECT_TRUE(mesh_edges(mesh).oriented());
            EXPECT_LE(testing::largest_distance(mesh, fine, 1), distance) << round;
            EXPECT_LE(testing::largest_distance(fine, mesh, 1), distance) << round;
        }
    }
}

TEST(CollapsedEdges, LeaveWhatTouchesItselfClosed) {
    // Two cubes that share an edge, and two that share a corner.
    for (const Vec3& to : {Vec3{2, 2, 0}, Vec3{2, 2, 2}}) {
        TriangleMesh mesh = cube(4, one, none);
        const TriangleMesh second = mesh;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3& p : second.positions) mesh.positions.push_back(p + to);
        mesh.normals.insert(mesh.normals.end(), second.normals.begin(), second.normals.end());
        mesh.uvs.resize(mesh.positions.size());
        mesh.vertex_materials.resize(mesh.positions.size());
        for (const auto& [a, b, c] : second.triangles) {
            mesh.triangles.push_back({first + a, first + b, first + c});
        }
        collapse_edges(mesh, merged_positions(mesh.positions), 1e-3, 1);
        EXPECT_TRUE(mesh.closed());
        EXPECT_LT(mesh.triangles.size(), 60u);
        EXPECT_NEAR(signed_volume(mesh), 16, 1e-12);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
