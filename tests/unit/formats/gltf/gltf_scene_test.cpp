#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "alhazen/base/file.h"
#include "alhazen/formats/gltf/scene/gltf_geometry.h"
#include "support/test_data.h"
#include "unit/formats/gltf/gltf_nodes_text.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

using gltf::PrimitiveMode;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::string number(int i) {
    return std::to_string(i);
}

TEST(GltfScene, IsRecognisedByItsContentAndElseByItsName) {
    const GltfImporter importer;
    const ImportOptions options;
    const auto sure = [&](std::string_view bytes, const char* path) {
        return importer.recognise({bytes, path, options});
    };
    EXPECT_EQ(sure("glTF\2\0\0\0", "x"), 2);
    EXPECT_EQ(sure(" {\"a\": \"asset\", \"asset\" : {}}", "x"), 2);
    EXPECT_EQ(sure("{\"a\": \"asset\"}", "x"), 0);
    EXPECT_EQ(sure("", "x.GLB"), 1);
    EXPECT_EQ(sure("{}", "x.gltf"), 1);
}

TEST(GltfScene, TransformsMultiplyAlongTheHierarchy) {
    const Imported result = import_gltf(with_nodes(R"(
        {"name": "a", "children": [1], "translation": [10, 0, 0],
         "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757], "scale": [2, 2, 2]},
        {"name": "b", "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1]})"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    ASSERT_EQ(result.parts().size(), 1u);
    EXPECT_EQ(result.parts()[0].name, "b/tri");
    // (1, 0, 0) -> (4, 0, 0) -> scaled (8, 0, 0) -> rotated (0, 8, 0) -> translated.
    EXPECT_NEAR_VEC((Vec3{10, 8, 0}), world_positions(result.scene)[1], 1e-12);
}

TEST(GltfScene, HiddenNodesHideWhatIsBelowThem) {
    const Imported result = import_gltf(with_nodes(R"(
        {"name": "a", "mesh": 0, "children": [1, 2], "extensions": {"KHR_node_visibility": {}}},
        {"name": "b", "mesh": 0, "children": [3], "extensions": {"KHR_node_visibility":
         {"visible": false}}},
        {"name": "c", "mesh": 0},
        {"name": "d", "mesh": 0, "extensions": {"KHR_node_visibility": {"visible": true}}},
        {"name": "e", "camera": 0, "extensions": {"KHR_node_visibility": {"visible": false},
         "KHR_lights_punctual": {"light": 0}}})",
                                                   "0, 4", R"(,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
        "extensionsUsed": ["KHR_node_visibility", "KHR_lights_punctual"])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    ASSERT_EQ(result.parts().size(), 2u);
    EXPECT_EQ(result.parts()[0].name, "a/tri");
    EXPECT_EQ(result.parts()[1].name, "c/tri");
    EXPECT_EQ(result.scene.cameras.size(), 1u);
    EXPECT_TRUE(result.scene.lights.empty());
}

TEST(GltfScene, RoundedMatricesAreDividedByTheirLastNumberAndToldOnce) {
    const Imported result = import_gltf(with_nodes(R"(
        {"mesh": 0, "matrix": [1, 0, 0, 9e-10, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0.9999996]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1.0000004]})",
                                                   "0, 1"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_TRUE(result.says("#/nodes/0/matrix: the last row of a matrix is rounded"));
    EXPECT_EQ(result.diagnostics.warning_count(), 1u) << result.messages();
    EXPECT_NEAR_VEC((Vec3{4 / 0.9999996, 0, 0}), world_positions(result.scene)[1], 1e-12);
    for (const char* refused : {"[1, 0, 0, 2e-5, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1]",
                                "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 2]"}) {
        const std::string node = std::string(R"({"mesh": 0, "matrix": )") + refused + "}";
        EXPECT_EQ(import_gltf(with_nodes(node)).errors(), 1u) << refused;
    }
}

TEST(GltfScene, NodesShareTheirMesh) {
    const Imported result =
        import_gltf(with_nodes(R"({"mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]})", "0, 1"));
    EXPECT_EQ(result.parts().size(), 2u);
    EXPECT_EQ(result.scene.meshes.size(), 1u);
    EXPECT_EQ(result.scene.objects.size(), 2u);
}

TEST(GltfScene, OnlyTheDefaultSceneIsShown) {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const Imported result =
        import_gltf(t.file(R"("scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [1]}], "nodes": [
          {"name": "no", "mesh": 0}, {"name": "yes", "mesh": 0}],
          "meshes": [{"primitives": [{"attributes": {"POSITION": )" +
                           number(p) + "}}]}]"));
    ASSERT_EQ(result.parts().size(), 1u);
    EXPECT_EQ(result.parts()[0].name, "yes/mesh 0");
}

TEST(GltfScene, AFileWithoutScenesShowsAllAndSaysSo) {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const Imported result =
        import_gltf(t.file(R"("nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes":
            {"POSITION": )" +
                           number(p) + "}}]}]"));
    EXPECT_EQ(result.parts().size(), 1u);
    EXPECT_TRUE(result.says("the file has no scene")) << result.messages();
}

TEST(GltfScene, ANodeOfZeroSizeIsNotSeen) {
    const Imported result =
        import_gltf(with_nodes(R"({"mesh": 0, "scale": [0, 0, 0]}, {"mesh": 0})", "0, 1"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_EQ(result.parts().size(), 1u);
}

TEST(GltfScene, LongChainsOfNodesDoNotNest) {
    constexpr int kDepth = 20000;
    std::string nodes;
    for (int i = 0; i + 1 < kDepth; ++i) {
        nodes += R"({"translation": [1, 0, 0], "children": [)" + number(i + 1) + "]}, ";
    }
    const Imported result = import_gltf(with_nodes(nodes + R"({"mesh": 0})"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_EQ(world_positions(result.scene)[0], (Vec3{kDepth - 1, 0, 0}));
}

TEST(GltfScene, InstancesOfTheExtensionAreParts) {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const int moves = t.floats("VEC3", {0, 0, 0, 5, 0, 0});
    const int turns =
        t.signed_bytes("VEC4", {0, 0, 0, 127, 0, 0, 127, 0}, R"(, "normalized": true)");
    const int scales = t.floats("VEC3", {1, 1, 1, 3, 3, 3});
    const Imported result = import_gltf(t.file(
        R"("extensionsUsed": ["EXT_mesh_gpu_instancing"], "scenes": [{"nodes": [0]}], "nodes": [
          {"name": "n", "mesh": 0, "translation": [0, 7, 0], "extensions":
           {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": )" +
        number(moves) + R"(, "ROTATION": )" + number(turns) + R"(, "SCALE": )" + number(scales) +
        R"(}}}}], "meshes": [{"primitives": [{"attributes": {"POSITION": )" + number(p) + "}}]}]"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    ASSERT_EQ(result.parts().size(), 2u);
    EXPECT_EQ(result.parts()[1].name, "n/mesh 0[1]");
    EXPECT_EQ(world_positions(result.scene, 0)[1], (Vec3{1, 7, 0}));
    // Scaled by three, half a turn about z.
    EXPECT_NEAR_VEC((Vec3{2, 7, 0}), world_positions(result.scene, 1)[1], 1e-12);
}

TEST(GltfScene, InstancesAreCountedByAnyAttribute) {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const int ids = t.floats("SCALAR", {7, 8, 9, 10});
    const Imported result = import_gltf(t.file(
        R"("extensionsUsed": ["EXT_mesh_gpu_instancing"], "scenes": [{"nodes": [0]}], "nodes": [
          {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"_ID": )" +
        number(ids) + R"(}}}}], "meshes": [{"primitives": [{"attributes": {"POSITION": )" +
        number(p) + "}}]}]"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_EQ(result.parts().size(), 4u);
}

TEST(GltfScene, WhatIsMadeOfAFileIsBounded) {
    // A mesh of three vertices, with other morph weights in every node.
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    std::string nodes, roots;
    for (int i = 0; i < 20; ++i) {
        nodes += std::string(i == 0 ? "" : ",") + R"({"mesh": 0, "weights": [)" + number(i) + "]}";
        roots += (i == 0 ? "" : ",") + number(i);
    }
    const std::string text = t.file(R"("scenes": [{"nodes": [)" + roots + R"(]}], "nodes": [)" +
                                    nodes + R"(], "meshes": [{"primitives": [{"attributes":
           {"POSITION": )" + number(p) +
                                    R"(}, "targets": [{"POSITION": )" + number(p) + "}]}]}]");
    ImportOptions options;
    options.max_made_bytes = 100'000;
    EXPECT_EQ(import_gltf(text, options).scene.meshes.size(), 20u);
    options.max_made_bytes = 5'000;
    try {
        import_gltf(text, options);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Resource);
        EXPECT_NE(std::string(error.what()).find("max_made_bytes"), std::string::npos);
    }
}

TEST(GltfScene, SmallFilesThatMakeMuchAreRefusedOrReadWithinAMoment) {
    std::size_t refused = 0, files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(testing::source_folder() / "tests/corpus/hostile")) {
        if (entry.path().extension() != ".gltf") continue;
        ++files;
        const auto start = std::chrono::steady_clock::now();
        try {
            const Imported result = import_gltf(read_file(entry.path()));
            EXPECT_EQ(result.errors(), 0u) << entry.path() << '\n' << result.messages();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Resource) << entry.path();
            ++refused;
        }
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        EXPECT_LT(seconds.count(), 10.0) << entry.path();
    }
    EXPECT_EQ(files, 4u);
    EXPECT_EQ(refused, 3u);
}

TEST(GltfGeometry, StripsAndFansKeepTheirWinding) {
    const std::vector<std::uint32_t> order{4, 5, 6, 7, 8};
    EXPECT_EQ(gltf::triangles_of(PrimitiveMode::Triangles, order), (Triangles{{4, 5, 6}}));
    EXPECT_EQ(gltf::triangles_of(PrimitiveMode::TriangleStrip, order),
              (Triangles{{4, 5, 6}, {5, 7, 6}, {6, 7, 8}}));
    EXPECT_EQ(gltf::triangles_of(PrimitiveMode::TriangleFan, order),
              (Triangles{{5, 6, 4}, {6, 7, 4}, {7, 8, 4}}));
    EXPECT_TRUE(gltf::triangles_of(PrimitiveMode::TriangleFan, {order.data(), 2}).empty());
}

TEST(GltfGeometry, AttributesBecomeThoseOfTheMesh) {
    GltfText t;
    // Vertex 0 is not used by the triangle.
    const int p =
        t.floats("VEC3", {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "9, 9, 9"));
    const int n = t.floats("VEC3", {1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int uv = t.shorts("VEC2", {0, 0, 0, 0, 65535, 0, 0, 65535}, R"(, "normalized": true)");
    const int uv2 = t.floats("VEC2", {0, 0, 2, 0.25, 0, 0, 0, 0});
    const int color =
        t.bytes("VEC3", {0, 0, 0, 255, 0, 51, 0, 0, 0, 0, 0, 0}, R"(, "normalized": true)");
    const int tangent = t.floats("VEC4", {0, 0, 1, 1, 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1});
    const int indices = t.shorts("SCALAR", {1, 2, 3});
    const Imported result = import_gltf(t.file(
        R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [
           {"indices": )" +
        number(indices) + R"(, "attributes": {"POSITION": )" + number(p) + R"(, "NORMAL": )" +
        number(n) + R"(, "TEXCOORD_0": )" + number(uv) + R"(, "TEXCOORD_1": )" + number(uv2) +
        R"(, "TEXCOORD_2": )" + number(uv2) + R"(, "COLOR_0": )" + number(color) +
        R"(, "TANGENT": )" + number(tangent) + "}}]}]"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    ASSERT_EQ(result.scene.meshes.size(), 1u);
    const TriangleMesh& mesh = *result.scene.meshes[0].mesh;
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
    EXPECT_EQ(mesh.uvs, (std::vector<Vec2>{{0, 1}, {1, 1}, {0, 0}}));
    EXPECT_EQ(mesh.uvs2[0], (Vec2{2, 0.75}));
    EXPECT_EQ(mesh.colors[0], (VertexColor{1, 0, 0.2f, 1}));
    EXPECT_EQ(mesh.tangents[0], (VertexTangent{1, 0, 0, -1}));
    EXPECT_TRUE(result.says("TEXCOORD_2 is not read (1 primitive)")) << result.messages();
}

TEST(GltfGeometry, PointsAndLinesAreLeftOutWithOneWarning) {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const std::string attributes = R"("attributes": {"POSITION": )" + number(p) + "}}";
    const Imported result = import_gltf(
        t.file(R"("scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 0}], "meshes": [
          {"primitives": [{"mode": 0, )" +
               attributes + R"(, {"mode": 1, )" + attributes + R"(, {"mode": 3, )" + attributes +
               ", {" + attributes + "]}]"));
    EXPECT_EQ(result.scene.meshes.size(), 1u);
    EXPECT_TRUE(result.says("left out: 1 primitive of points, 2 primitives of lines"))
        << result.messages();
}

TEST(GltfGeometry, WhatIsReadIsBounded) {
    ImportOptions options;
    options.max_elements = 5;
    try {
        import_gltf(with_nodes(R"({"mesh": 0})"), options);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Resource);
    }
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
