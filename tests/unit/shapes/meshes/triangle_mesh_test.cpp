#include "alhazen/shapes/meshes/triangle_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/shapes/meshes/mesh_edges.h"
#include "support/box_mesh.h"
#include "support/quad.h"
#include "support/random.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Quad;
using testing::QuadVec;
using testing::Random;

TriangleMesh sphere_mesh(int levels) {
    testing::SphereMesh sphere(levels);
    return {.positions = std::move(sphere.positions), .triangles = std::move(sphere.triangles)};
}

/// Gives each triangle three vertices of its own, as in many files.
TriangleMesh unshared(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const auto& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (const std::uint32_t v : triangle) soup.positions.push_back(mesh.positions[v]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

TEST(TriangleMesh, ClosedMeshesAreRecognisedAfterMergingEqualPositions) {
    TriangleMesh mesh = sphere_mesh(3);
    EXPECT_TRUE(mesh.closed());
    TriangleMesh soup = unshared(mesh);
    EXPECT_TRUE(soup.closed());
    // Orientation, the sign of zero and triangles without area do not matter.
    std::swap(soup.triangles[5][0], soup.triangles[5][1]);
    for (Vec3& p : soup.positions) {
        if (p.x == 0.0) p.x = (&p - soup.positions.data()) % 2 == 0 ? 0.0 : -0.0;
    }
    soup.triangles.push_back({7, 7, 9});
    EXPECT_TRUE(soup.closed());
}

TEST(TriangleMesh, OpenMeshesAreRecognised) {
    const TriangleMesh closed = sphere_mesh(2);
    TriangleMesh hole = closed;
    hole.triangles.pop_back();
    EXPECT_FALSE(hole.closed());
    TriangleMesh fin = closed;  // three triangles at an edge
    fin.positions.push_back({5, 5, 5});
    const auto tip = static_cast<std::uint32_t>(fin.positions.size() - 1);
    fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], tip});
    EXPECT_FALSE(fin.closed());
    TriangleMesh cracked = unshared(closed);
    cracked.positions[0].x = std::nextafter(cracked.positions[0].x, 9.0);
    EXPECT_FALSE(cracked.closed());
    TriangleMesh four_at_an_edge = closed;  // everything twice
    four_at_an_edge.triangles.insert(four_at_an_edge.triangles.end(), closed.triangles.begin(),
                                     closed.triangles.end());
    EXPECT_TRUE(four_at_an_edge.closed());
    EXPECT_FALSE(TriangleMesh{}.closed());
    EXPECT_FALSE((TriangleMesh{.positions = {{0, 0, 0}}, .triangles = {{0, 0, 0}}}).closed());
}

TEST(TriangleMesh, WhatKeepsItOpenIsCounted) {
    const TriangleMesh closed = sphere_mesh(2);
    EXPECT_TRUE(mesh_edges(closed).oriented());
    EXPECT_EQ(mesh_edges(closed).description(), "closed");
    EXPECT_EQ(mesh_edges(closed).count, closed.triangles.size() * 3 / 2);
    TriangleMesh hole = closed;
    hole.triangles.pop_back();
    EXPECT_EQ(mesh_edges(hole).open, 3u);
    EXPECT_NE(mesh_edges(hole).description().find("3 of "), std::string::npos);
    TriangleMesh turned = closed;
    std::swap(turned.triangles[4][0], turned.triangles[4][1]);
    EXPECT_TRUE(mesh_edges(turned).closed());
    EXPECT_FALSE(mesh_edges(turned).oriented());
    EXPECT_EQ(mesh_edges(turned).turned, 3u);
    TriangleMesh twice = closed;
    twice.triangles.push_back(closed.triangles[0]);
    EXPECT_EQ(mesh_edges(twice).open, 3u);  // three triangles each
    EXPECT_EQ(mesh_edges(twice).crowded, 0u);
    EXPECT_EQ(mesh_edges({}).description(), "no triangles");
}

/// Two tetrahedra on either side of an edge that is theirs alike, along z.
TriangleMesh touching_tetrahedra() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}};
    for (const auto& [a, b] : {std::pair{2u, 3u}, std::pair{5u, 4u}}) {
        mesh.triangles.insert(mesh.triangles.end(), {{0, 1, b}, {0, a, 1}, {1, a, b}, {0, b, a}});
    }
    return mesh;
}

TEST(TriangleMesh, AnEdgeOfFourTrianglesIsNoOpening) {
    const TriangleMesh mesh = touching_tetrahedra();
    const MeshEdges edges = mesh_edges(mesh);
    EXPECT_EQ(edges.crowded, 1u);
    EXPECT_EQ(edges.open, 0u);
    EXPECT_TRUE(edges.oriented());
    EXPECT_EQ(edges.description(), "closed");
    TriangleMesh turned = mesh;  // one of the two inside out: still evenly many
    for (std::size_t i = 0; i < 4; ++i) std::swap(turned.triangles[i][0], turned.triangles[i][1]);
    EXPECT_TRUE(mesh_edges(turned).oriented());  // equally often in both directions
    std::swap(turned.triangles[0][0], turned.triangles[0][1]);
    EXPECT_TRUE(mesh_edges(turned).closed());
    EXPECT_EQ(mesh_edges(turned).turned, 3u);
}

TEST(TriangleMesh, OpenEdgesAreNamed) {
    TriangleMesh mesh = touching_tetrahedra();
    mesh.triangles.pop_back();
    const MeshEdges edges = mesh_edges(mesh);
    EXPECT_EQ(edges.open, 3u);
    EXPECT_EQ(edges.description(),
              "3 of 11 edges are open: (0, 0, 0) to (-1, 1, 0), (0, 0, 0) to (-1, -1, 0), "
              "(-1, 1, 0) to (-1, -1, 0)");
    mesh.triangles = {mesh.triangles[0], mesh.triangles[4]};
    EXPECT_EQ(mesh_edges(mesh).count, 5u);
    mesh.triangles.resize(1);
    mesh.triangles.push_back({2, 4, 5});
    EXPECT_NE(
        mesh_edges(mesh).description().find("and 2 more, all between (-1, -1, 0) and (1, 1, 1)"),
        std::string::npos)
        << mesh_edges(mesh).description();
}

TEST(TriangleMesh, ClosednessOfPositionsThatAreNotNumbersIsAnswered) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    TriangleMesh mesh = sphere_mesh(1);
    for (Vec3& p : mesh.positions) p.y = nan;
    (void)mesh.closed();
}

TEST(TriangleMesh, VolumeAndAreaAreThoseOfTheSolid) {
    TriangleMesh cube = testing::box_mesh({{1, 1, 1}, {3, 3, 3}});
    ASSERT_TRUE(cube.closed());
    EXPECT_DOUBLE_EQ(signed_volume(cube), 8.0);
    EXPECT_DOUBLE_EQ(area(cube), 24.0);
    for (auto& t : cube.triangles) std::swap(t[0], t[1]);
    EXPECT_DOUBLE_EQ(signed_volume(cube), -8.0);
    EXPECT_EQ(signed_volume({}), 0.0);

    TriangleMesh sphere = sphere_mesh(5);
    const double volume = signed_volume(sphere);
    EXPECT_NEAR(volume, 4.18879, 0.01);
    EXPECT_NEAR(area(sphere), 12.56637, 0.02);
    sphere.transform(Affine::translate({1e6, -1e6, 1e6}));
    EXPECT_NEAR(signed_volume(sphere), volume,
                1e-9);  // positions lose 1e-10, volumes do not cancel
}

TEST(TriangleMesh, GeneratedNormalsPointOutward) {
    TriangleMesh mesh = sphere_mesh(4);
    mesh.positions.push_back({9, 9, 9});  // used by no triangle
    mesh.generate_normals();
    EXPECT_EQ(mesh.normals.back(), Vec3{});
    mesh.positions.pop_back();
    mesh.normals.pop_back();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        ASSERT_NEAR(length(mesh.normals[i]), 1.0, 1e-14);
        ASSERT_GT(dot(mesh.normals[i], mesh.positions[i]), 0.999) << i;
    }
}

TEST(TriangleMesh, NormalsStayPerpendicularUnderTransforms) {
    Random random(71);
    for (int i = 0; i < 200; ++i) {
        TriangleMesh mesh{.positions = {random.in_cube(2), random.in_cube(2), random.in_cube(2)},
                          .triangles = {{0, 1, 2}}};
        mesh.generate_normals();
        const bool mirror = random.coin();
        const Affine move =
            Affine::translate(random.in_cube(5)) * Affine::rotate(random.unit_vector(), i) *
            Affine::scale({random.uniform(0.1, 4), mirror ? -0.5 : 2.0, random.uniform(0.1, 4)});
        const auto triangles = mesh.triangles;
        mesh.transform(move);
        ASSERT_EQ(mesh.triangles, triangles);
        const Vec3 e1 = mesh.positions[1] - mesh.positions[0];
        const Vec3 e2 = mesh.positions[2] - mesh.positions[0];
        const Vec3 normal = normalize(mesh.normals[0]);
        ASSERT_NEAR(dot(normal, e1), 0.0, 1e-12 * length(e1)) << "seed 71, case " << i;
        ASSERT_NEAR(dot(normal, e2), 0.0, 1e-12 * length(e2)) << "seed 71, case " << i;
        // The normal keeps its side; a reflection reverses the winding.
        ASSERT_EQ(dot(normal, cross(e1, e2)) < 0.0, mirror) << "seed 71, case " << i;
    }
}

TEST(TriangleMesh, InterpolatedNormalsOfATransformedMeshAreTransformedOnes) {
    Random random(73);
    for (int i = 0; i < 200; ++i) {
        TriangleMesh mesh{.positions = {{}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
        mesh.normals = {random.unit_vector(), random.unit_vector(), random.unit_vector()};
        for (Vec3& normal : mesh.normals) normal.z = std::abs(normal.z);
        TriangleMesh moved = mesh;
        const double size = std::exp2(random.uniform(-200, 200));
        const Affine move = Affine::rotate(random.unit_vector(), i) *
                            Affine::scale({size, size * random.uniform(0.1, 4), -3 * size});
        moved.transform(move);
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const auto interpolated = [&](const TriangleMesh& m) {
            return (1 - u - v) * m.normals[0] + u * m.normals[1] + v * m.normals[2];
        };
        const Vec3 expected = size * transpose_times(inverse(move.linear), interpolated(mesh));
        ASSERT_LT(length(normalize(expected) - normalize(interpolated(moved))), 1e-14)
            << "seed 73, case " << i;
    }
}

TEST(TriangleMesh, SurfaceInterpolatesAndBoundsItsError) {
    Random random(72);
    int hit_count = 0;
    for (int i = 0; i < 50000; ++i) {
        const double far = random.log_uniform(1, 1e5);
        const Vec3 at = far * random.unit_vector();
        TriangleMesh mesh{
            .positions = {at + random.in_cube(1), at + random.in_cube(1), random.in_cube(2)},
            .triangles = {{0, 1, 2}}};
        const auto& p = mesh.positions;
        const double b = random.uniform(), c = random.uniform() * (1 - b);
        const Vec3 target = (1 - b - c) * p[0] + b * p[1] + c * p[2];
        const Vec3 d = random.unit_vector();
        const Ray ray = line(target - random.log_uniform(1, 1e3) * d, d);
        ShapeHit hit;
        if (!intersect_triangle(ray, RayShear(d), p[0], p[1], p[2], hit)) continue;
        const ShapeSurface s = mesh.surface(0, hit);
        const QuadVec n =
            normalize(cross(QuadVec(p[1]) - QuadVec(p[0]), QuadVec(p[2]) - QuadVec(p[0])));
        const auto off =
            static_cast<double>(testing::magnitude(dot(n, QuadVec(s.point) - QuadVec(p[0]))));
        const Vec3 exact_n{static_cast<double>(n.x), static_cast<double>(n.y),
                           static_cast<double>(n.z)};
        ASSERT_LE(off, dot(abs(exact_n), s.error)) << "seed 72, case " << i;
        ASSERT_EQ(s.uv, (Vec2{hit.u, hit.v}));
        ++hit_count;
    }
    EXPECT_GT(hit_count, 20000);
}

TEST(TriangleMesh, ShadingNormalFallsBackToTheGeometricOne) {
    TriangleMesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
    const ShapeHit hit{1, 0.25, 0.5, 0};
    EXPECT_EQ(mesh.surface(0, hit).normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(mesh.surface(0, hit).shading_normal, (Vec3{0, 0, 1}));
    mesh.normals = {{1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_NEAR(mesh.surface(0, hit).shading_normal.x, std::sqrt(0.5), 1e-15);
    EXPECT_EQ(mesh.surface(0, hit).normal, (Vec3{0, 0, 1}));
    mesh.normals.assign(3, {});
    EXPECT_EQ(mesh.surface(0, hit).shading_normal, (Vec3{0, 0, 1}));
    mesh.uvs = {{0, 0}, {4, 0}, {0, 8}};
    EXPECT_EQ(mesh.surface(0, hit).uv, (Vec2{1, 4}));
}

TEST(TriangleMesh, BoundsHoldTheTriangles) {
    const TriangleMesh mesh = sphere_mesh(3);
    EXPECT_EQ(mesh.box(), (Box3{{-1, -1, -1}, {1, 1, 1}}));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const std::uint32_t v : mesh.triangles[i]) {
            ASSERT_TRUE(mesh.triangle_box(i).contains(mesh.positions[v]));
        }
        ASSERT_LT(max_component(mesh.triangle_box(i).size()), 0.5) << i;
    }
}

TEST(TriangleMesh, ExtentsWhoseProductsUnderflowAreReported) {
    const auto errors = [](double scale, const Vec3& place) {
        TriangleMesh mesh = sphere_mesh(0);
        for (Vec3& position : mesh.positions) position = scale * position + place;
        Diagnostics diagnostics;
        mesh.validate({}, diagnostics);
        return diagnostics.error_count();
    };
    EXPECT_EQ(errors(1e-69, {}), 0u);
    EXPECT_EQ(errors(1e-71, {}), 1u);
    EXPECT_EQ(errors(1e-110, {}), 1u);
    EXPECT_EQ(errors(1e-310, {}), 1u);
    // Degenerate meshes are valid.
    EXPECT_EQ(errors(0, {}), 0u);
    EXPECT_EQ(errors(1e-110, {1, 1, 1}), 0u);
}

TEST(TriangleMesh, BadArraysAreReported) {
    const auto errors = [](const TriangleMesh& mesh) {
        Diagnostics diagnostics;
        mesh.validate({}, diagnostics);
        return diagnostics.error_count();
    };
    TriangleMesh mesh = sphere_mesh(0);
    EXPECT_EQ(errors(mesh), 0u);
    mesh.triangles[2][1] = 6;
    EXPECT_EQ(errors(mesh), 1u);
    mesh.positions[1].z = std::numeric_limits<double>::infinity();
    EXPECT_EQ(errors(mesh), 2u);
    mesh.normals.resize(5);
    EXPECT_EQ(errors(mesh), 3u);
    mesh.uvs.resize(7);
    EXPECT_EQ(errors(mesh), 4u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
