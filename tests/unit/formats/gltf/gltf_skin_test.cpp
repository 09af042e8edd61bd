#include "alhazen/formats/gltf/scene/gltf_skin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/formats/gltf/gltf_text.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

/// A triangle whose corners follow joint 1 (node 1), joint 2 (node 2), and both by halves. The
/// transform of the mesh node must have no effect. `weights`: those of the three corners.
std::string skinned_triangle(std::initializer_list<double> weights) {
    GltfText t;
    const auto n = [](int i) { return std::to_string(i); };
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0}, bounds("0, 0, 0", "2, 0, 0"));
    const int normals = t.floats("VEC3", {1, 0, 0, 1, 0, 0, 1, 0, 0});
    const int joints = t.bytes("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    const int w = t.floats("VEC4", weights);
    // Joint 0 was bound at the origin, joint 1 at x = 1.
    const int bind = t.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
    return t.file(R"("scenes": [{"nodes": [0, 1]}], "nodes": [
          {"name": "skinned", "mesh": 0, "skin": 0, "translation": [100, 0, 0]},
          {"children": [2], "translation": [0, 5, 0]},
          {"translation": [1, 0, 0], "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757]}],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": )" +
                  n(bind) + R"(}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": )" +
                  n(p) + R"(, "NORMAL": )" + n(normals) + R"(, "JOINTS_0": )" + n(joints) +
                  R"(, "WEIGHTS_0": )" + n(w) + "}}]}]");
}

TEST(GltfSkin, VerticesFollowTheirJointsAndNotTheirNode) {
    const Imported result = import_gltf(skinned_triangle({1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0}));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    const std::vector<Vec3> points = world_positions(result.scene);
    ASSERT_EQ(points.size(), 3u);
    // Joint 0 only translates by 5 along y.
    EXPECT_NEAR_VEC((Vec3{0, 5, 0}), points[0], 1e-12);
    // Joint 1 rotates by 90 degrees about its position (1, 5, 0): a corner bound there stays.
    EXPECT_NEAR_VEC((Vec3{1, 5, 0}), points[1], 1e-12);
    // Halfway between (2, 5, 0) and (1, 6, 0).
    EXPECT_NEAR_VEC((Vec3{1.5, 5.5, 0}), points[2], 1e-12);
    const std::vector<Vec3>& normals = result.scene.meshes.at(0).mesh->normals;
    EXPECT_NEAR_VEC((Vec3{1, 0, 0}), normals[0], 1e-12);
    EXPECT_NEAR_VEC((Vec3{0, 1, 0}), normals[1], 1e-12);
    EXPECT_NEAR_VEC((Vec3{std::sqrt(0.5), std::sqrt(0.5), 0}), normals[2], 1e-12);
}

TEST(GltfSkin, WeightsAreUsedAsShares) {
    alhazen::gltf::PrimitiveGeometry geometry;
    geometry.mesh.positions = {{0, 0, 0}, {0, 0, 0}};
    geometry.joints = {4, {0, 1, 0, 0, 1, 0, 0, 0}, {0.25, 0.25, 0, 0, 0, 0, 0, 0}};
    gltf::apply_skin(geometry, {Affine::translate({2, 0, 0}), Affine::translate({4, 0, 0})});
    EXPECT_EQ(geometry.mesh.positions[0], (Vec3{3, 0, 0}));
    // A vertex without weights follows the first joint it names.
    EXPECT_EQ(geometry.mesh.positions[1], (Vec3{4, 0, 0}));
}

TEST(GltfSkin, JointsBeyondTheSkinMoveNothing) {
    alhazen::gltf::PrimitiveGeometry geometry;
    geometry.mesh.positions = {{1, 2, 3}, {1, 2, 3}};
    geometry.joints = {4, {0, 77, 0, 0, 77, 0, 0, 0}, {0.5, 0.5, 0, 0, 1, 0, 0, 0}};
    gltf::apply_skin(geometry, {Affine::translate({2, 0, 0})});
    EXPECT_EQ(geometry.mesh.positions[0], (Vec3{3, 2, 3}));
    EXPECT_EQ(geometry.mesh.positions[1], (Vec3{1, 2, 3}));
}

TEST(GltfSkin, NormalsStandOnStretchedSurfaces) {
    // Scaling x by 4 turns the normal of the plane x + y = 0 to (1, 4, 0).
    alhazen::gltf::PrimitiveGeometry geometry;
    geometry.mesh.positions = {{0, 0, 0}};
    geometry.mesh.normals = {{std::sqrt(0.5), std::sqrt(0.5), 0}};
    geometry.joints = {1, {0}, {1}};
    gltf::apply_skin(geometry, {Affine::scale({4, 1, 1})});
    EXPECT_NEAR_VEC(normalize(Vec3{1, 4, 0}), geometry.mesh.normals[0], 1e-12);
    // A reflection keeps it on the same side of the surface.
    geometry.mesh.normals = {{0, 1, 0}};
    gltf::apply_skin(geometry, {Affine::scale({-1, 1, 1})});
    EXPECT_NEAR_VEC((Vec3{0, 1, 0}), geometry.mesh.normals[0], 1e-12);
}

TEST(GltfSkin, MirrorsKeepTheFrontAndTurnTheBitangent) {
    alhazen::gltf::PrimitiveGeometry geometry;
    geometry.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    geometry.mesh.normals.assign(4, {0, 0, 1});
    geometry.mesh.tangents.assign(4, {1, 0, 0, 1});
    geometry.mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 2, 0}};
    // Only corners 0 and 1 are reflected.
    geometry.joints = {1, {0, 0, 1, 1}, {1, 1, 1, 1}};
    gltf::apply_skin(geometry, {Affine::scale({-1, 1, 1}), Affine{}});
    const std::vector<std::array<std::uint32_t, 3>> expected{{0, 2, 1}, {1, 3, 2}, {3, 2, 0}};
    EXPECT_EQ(geometry.mesh.triangles, expected);
    // The front of the first triangle is the side of its normals.
    const std::vector<Vec3>& p = geometry.mesh.positions;
    const auto [a, b, c] = geometry.mesh.triangles[0];
    EXPECT_GT(dot(cross(p[b] - p[a], p[c] - p[a]), geometry.mesh.normals[0]), 0.0);
    // The bitangent cross(n, t) * sign stays y, which the reflection preserves.
    EXPECT_EQ(geometry.mesh.tangents[0].x, -1.0f);
    EXPECT_EQ(geometry.mesh.tangents[0].sign, -1.0f);
    EXPECT_EQ(geometry.mesh.tangents[2].x, 1.0f);
    EXPECT_EQ(geometry.mesh.tangents[2].sign, 1.0f);
}

TEST(GltfSkin, PrimitivesWithoutJointsFollowTheNodeThoseWithFollowTheJoints) {
    GltfText t;
    const auto n = [](int i) { return std::to_string(i); };
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const int joints = t.bytes("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const int w = t.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const Imported result = import_gltf(t.file(
        R"("scenes": [{"nodes": [0]}], "nodes": [{"translation": [10, 0, 0], "children": [1, 2]},
             {}, {"mesh": 0, "skin": 0}], "skins": [{"joints": [1]}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": )" +
        n(p) + R"(, "JOINTS_0": )" + n(joints) + R"(, "WEIGHTS_0": )" + n(w) +
        R"(}}, {"attributes": {"POSITION": )" + n(p) + "}}]}]"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    ASSERT_EQ(result.parts().size(), 2u);
    EXPECT_EQ(world_positions(result.scene, 0)[1], (Vec3{11, 0, 0}));
    EXPECT_EQ(world_positions(result.scene, 1)[1], (Vec3{11, 0, 0}));
    EXPECT_EQ(result.scene.meshes.size(), 2u);
}

TEST(GltfSkin, NodesWithTheSameMeshAndSkinShareIt) {
    std::string text = skinned_triangle({1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0});
    const std::string children = R"({"children": [2])";
    // A second skinned node, in place of a node without a mesh.
    text.replace(text.find(children), children.size(), R"({"mesh": 0, "skin": 0, "children": [2])");
    const Imported result = import_gltf(text);
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_EQ(result.parts().size(), 2u);
    EXPECT_EQ(result.scene.meshes.size(), 1u);
}

TEST(GltfMorph, TargetsAreAddedByTheirWeights) {
    GltfText t;
    const auto n = [](int i) { return std::to_string(i); };
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const int up = t.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1}, bounds("0, 0, 1", "0, 0, 1"));
    const int right = t.floats("VEC3", {8, 0, 0, 0, 0, 0, 0, 0, 0}, bounds("0, 0, 0", "8, 0, 0"));
    const std::string text = t.file(R"("scenes": [{"nodes": [0, 1, 2]}], "nodes": [{"mesh": 0},
          {"mesh": 0, "weights": [0, 1]}, {"mesh": 0}],
          "meshes": [{"weights": [0.5, 0.25], "primitives": [{"attributes": {"POSITION": )" +
                                    n(p) + R"(}, "targets": [{"POSITION": )" + n(up) +
                                    R"(}, {"POSITION": )" + n(right) + "}]}]}]");
    const Imported result = import_gltf(text);
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_EQ(world_positions(result.scene, 0)[0], (Vec3{2, 0, 0.5}));
    EXPECT_EQ(world_positions(result.scene, 0)[2], (Vec3{0, 1, 0.5}));
    EXPECT_EQ(world_positions(result.scene, 1)[0], (Vec3{8, 0, 0}));
    // The first and the last node share their mesh.
    EXPECT_EQ(result.scene.meshes.size(), 2u);
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
