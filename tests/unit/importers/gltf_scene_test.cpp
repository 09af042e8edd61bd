#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <numbers>

#include "alhazen/base/file.h"
#include "alhazen/importers/gltf/gltf_geometry.h"
#include "alhazen/importers/gltf/gltf_textures.h"
#include "unit/importers/gltf_text.h"

namespace alhazen::testing {
namespace {

using gltf::PrimitiveMode;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::string number(int i) {
    return std::to_string(i);
}

/// A file with one triangle as mesh 0 and these nodes, all of `shown` in its scene.
std::string with_nodes(const std::string& nodes, const std::string& shown = "0",
                       const std::string& more = "") {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    return t.file(R"("scenes": [{"nodes": [)" + shown + R"(]}], "nodes": [)" + nodes +
                  R"(], "meshes": [{"name": "tri", "primitives": [{"attributes": {"POSITION": )" +
                  number(p) + "}}]}]" + more);
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
    // (1, 0, 0) -> (4, 0, 0) -> scaled (8, 0, 0) -> turned (0, 8, 0) -> moved.
    EXPECT_NEAR_VEC((Vec3{10, 8, 0}), world_positions(result.scene)[1], 1e-12);
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
    // Three times as large, half a turn about z.
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
    // A mesh of three vertices that every node bends in its own way.
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
         std::filesystem::directory_iterator(ALHAZEN_SOURCE_DIR "/tests/corpus/hostile")) {
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

TEST(GltfMaterial, KeepsWhatTheFileSays) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0})", "0", R"(,
        "extensionsUsed": ["KHR_materials_ior", "KHR_materials_emissive_strength",
          "KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_specular"],
        "materials": [{"name": "m", "alphaMode": "MASK", "alphaCutoff": 0.25,
          "emissiveFactor": [1, 0.5, 0],
          "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5,
            "roughnessFactor": 0.6},
          "extensions": {"KHR_materials_ior": {"ior": 1.4},
            "KHR_materials_emissive_strength": {"emissiveStrength": 4},
            "KHR_materials_transmission": {"transmissionFactor": 0.7},
            "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 3,
              "attenuationColor": [0.5, 0.6, 0.7]},
            "KHR_materials_specular": {"specularFactor": 0.8, "specularColorFactor": [1, 0, 1]}}}])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    // And the default material of the primitive that names none.
    ASSERT_EQ(result.scene.materials.size(), 2u);
    const Material& m = result.scene.materials[0].material;
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(m.alpha_cutoff, 0.25);
    EXPECT_EQ(m.alpha.value, 0.4);
    EXPECT_FALSE(m.double_sided);
    EXPECT_EQ(m.emission.color, (Rgb{4, 2, 0}));
    EXPECT_EQ(m.index.value, 1.4);
    ASSERT_TRUE(m.metallic_roughness);
    EXPECT_EQ(m.metallic_roughness->base_color.color, (Rgb{0.1, 0.2, 0.3}));
    EXPECT_EQ(m.metallic_roughness->metallic.value, 0.5);
    EXPECT_EQ(m.metallic_roughness->roughness.value, 0.6);
    EXPECT_EQ(m.metallic_roughness->transmission.value, 0.7);
    EXPECT_EQ(m.metallic_roughness->thickness.value, 2);
    EXPECT_EQ(m.metallic_roughness->attenuation_distance, 3);
    EXPECT_EQ(m.metallic_roughness->attenuation_color, (Rgb{0.5, 0.6, 0.7}));
    EXPECT_EQ(m.metallic_roughness->specular.value, 0.8);
    EXPECT_EQ(m.metallic_roughness->specular_color.color, (Rgb{1, 0, 1}));
    const Material& plain = result.scene.materials[1].material;
    ASSERT_TRUE(plain.metallic_roughness);
    EXPECT_EQ(plain.metallic_roughness->metallic.value, 1);
    EXPECT_EQ(plain.index.value, 1.5);
}

/// A PNG of one white pixel.
constexpr const char* kPng =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAA"
    "AACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg==";

std::string with_picture(const std::string& uri) {
    return with_nodes(R"({"mesh": 0})", "0",
                      R"(, "images": [{"name": "pic", "uri": ")" + uri +
                          R"("}], "samplers": [{"wrapS": 33071, "wrapT": 33648, "minFilter": 9728,
          "magFilter": 9728}],
        "textures": [{"source": 0, "sampler": 0}], "materials": [{
          "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1},
            "metallicRoughnessTexture": {"index": 0}},
          "normalTexture": {"index": 0, "scale": 2},
          "occlusionTexture": {"index": 0, "strength": 0.5}}])");
}

TEST(GltfMaterial, TexturesShareTheirPictureAndKeepTheirUse) {
    const Imported result = import_gltf(with_picture(kPng));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    const Material& m = result.scene.materials.at(0).material;
    const auto texture = [&](TextureId id) {
        return result.scene.textures.at(std::size_t(id)).texture;
    };
    ASSERT_TRUE(m.metallic_roughness);
    const Texture base = texture(m.metallic_roughness->base_color.texture);
    EXPECT_TRUE(base.decode_srgb);
    EXPECT_EQ(base.uv_set, 1);
    EXPECT_EQ(base.wrap_u, Wrap::Clamp);
    EXPECT_EQ(base.wrap_v, Wrap::Mirror);
    EXPECT_EQ(base.filter, TextureFilter::Nearest);
    EXPECT_EQ(m.alpha.texture, m.metallic_roughness->base_color.texture);
    const Texture normal = texture(m.normal_map.texture);
    EXPECT_FALSE(normal.decode_srgb);
    EXPECT_EQ(normal.image, base.image);
    EXPECT_EQ(m.normal_map.scale, 2);
    EXPECT_EQ(m.metallic_roughness->occlusion.value, 0.5);
    EXPECT_EQ(m.metallic_roughness->metallic.channel, Channel::Blue);
    EXPECT_EQ(m.metallic_roughness->roughness.channel, Channel::Green);
    EXPECT_EQ(m.metallic_roughness->metallic.texture, m.metallic_roughness->roughness.texture);
    // Base colour and the linear one, which three inputs share.
    EXPECT_EQ(result.scene.textures.size(), 2u);
}

TEST(GltfMaterial, AMissingPictureIsAWarningThatNamesItAndTheFactorsStay) {
    const Imported result = import_gltf(with_picture("gone.png"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_TRUE(result.says("gone.png")) << result.messages();
    EXPECT_TRUE(result.scene.textures.empty());
    ASSERT_FALSE(result.scene.materials.empty());
    EXPECT_EQ(result.scene.materials[0].material.diffuse.texture, kNoTexture);
}

TEST(GltfMaterial, APictureOutsideOfTheFolderIsAnError) {
    const Imported result = import_gltf(with_picture("../../../gone.png"));
    EXPECT_GT(result.errors(), 0u);
    EXPECT_TRUE(result.says("--allow-path")) << result.messages();
}

TEST(GltfTextures, TransformsAreRestatedForUpwardV) {
    gltf::TextureInfo info;
    EXPECT_EQ(gltf::uv_transform(info), UvTransform{});
    info.offset = {-0.2, 0.1};
    info.scale = {1.5, 3};
    info.rotation = 0.3;
    const UvTransform transform = gltf::uv_transform(info);
    for (const Vec2 st : {Vec2{0, 0}, {1, 0}, {0, 1}, {0.25, 0.75}}) {
        const double x = 1.5 * st.x, y = 3 * st.y;
        const double s = -0.2 + std::cos(0.3) * x + std::sin(0.3) * y;
        const double t = 0.1 - std::sin(0.3) * x + std::cos(0.3) * y;
        const Vec2 uv = transform.apply({st.x, 1 - st.y});
        EXPECT_NEAR(uv.x, s, 1e-12);
        EXPECT_NEAR(uv.y, 1 - t, 1e-12);
    }
}

TEST(GltfTextures, FiltersFollowTheSampler) {
    using gltf::Filter;
    EXPECT_EQ(gltf::filter_of({}), TextureFilter::Mipmapped);
    EXPECT_EQ(gltf::filter_of({Filter::Nearest, Filter::LinearMipmap}), TextureFilter::Mipmapped);
    EXPECT_EQ(gltf::filter_of({Filter::Unset, Filter::Linear}), TextureFilter::Bilinear);
    EXPECT_EQ(gltf::filter_of({Filter::Nearest, Filter::Nearest}), TextureFilter::Nearest);
    EXPECT_EQ(gltf::filter_of({Filter::Linear, Filter::Nearest}), TextureFilter::Bilinear);
}

TEST(GltfViews, CamerasLookAlongMinusZOfTheirNodes) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0},
        {"name": "eye", "camera": 0, "translation": [1, 2, 3], "scale": [5, 5, 5],
         "rotation": [0, 0.70710678118654757, 0, 0.70710678118654757]}, {"camera": 1})",
                                                   "0, 1, 2", R"(, "cameras": [
          {"type": "perspective", "perspective": {"yfov": 1.5707963267948966, "aspectRatio": 2,
            "znear": 0.1}},
          {"name": "flat", "type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0,
            "zfar": 10}}])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    ASSERT_EQ(result.scene.cameras.size(), 2u);
    EXPECT_EQ(result.scene.cameras[0].name, "eye");
    EXPECT_EQ(result.scene.cameras[0].aspect, 2);
    const auto& eye = std::get<PerspectiveCamera>(result.scene.cameras[0].camera);
    EXPECT_NEAR_VEC((Vec3{1, 2, 3}), eye.eye, 1e-12);
    EXPECT_NEAR_VEC((Vec3{-1, 0, 0}), normalize(eye.look), 1e-12);
    EXPECT_NEAR_VEC((Vec3{0, 0, -1}), normalize(eye.right), 1e-12);
    EXPECT_NEAR(length(eye.up) / length(eye.look), 2, 1e-12);
    EXPECT_NEAR(length(eye.right) / length(eye.look), 4, 1e-12);
    EXPECT_EQ(result.scene.cameras[1].name, "flat");
    const auto& flat = std::get<OrthographicCamera>(result.scene.cameras[1].camera);
    EXPECT_NEAR_VEC((Vec3{6, 0, 0}), flat.right, 1e-12);
    EXPECT_NEAR_VEC((Vec3{0, 4, 0}), flat.up, 1e-12);
}

TEST(GltfViews, LightsKeepTheirUnitsUpToPi) {
    const Imported result =
        import_gltf(with_nodes(R"({"mesh": 0},
        {"translation": [0, 5, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"rotation": [-0.70710678118654757, 0, 0, 0.70710678118654757],
         "extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 2}}})",
                               "0, 1, 2, 3", R"(, "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
          {"type": "point", "color": [1, 0.5, 0], "intensity": 40, "range": 10},
          {"type": "directional", "name": "sun", "intensity": 3},
          {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}]}})"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_FALSE(result.scene.conventions.clamp_attenuation);
    ASSERT_EQ(result.scene.lights.size(), 3u);
    // Half of the way to its range: 40 cd / pi / 25 m^2 * (1 - 1/16).
    const LightSample point = sample(result.scene.lights[0].light, {0, 0, 0}, false);
    EXPECT_NEAR(point.intensity.r, 40 / std::numbers::pi / 25 * 15 / 16, 1e-12);
    EXPECT_NEAR(point.intensity.g, 20 / std::numbers::pi / 25 * 15 / 16, 1e-12);
    EXPECT_EQ(sample(result.scene.lights[0].light, {0, -5, 0}, false).intensity, Rgb{});
    EXPECT_EQ(sample(result.scene.lights[0].light, {0, -9, 0}, false).intensity, Rgb{});
    // -z turned by -90 degrees about x points down.
    const auto& sun = std::get<DirectionalLight>(result.scene.lights[1].light);
    EXPECT_EQ(result.scene.lights[1].name, "sun");
    EXPECT_NEAR_VEC((Vec3{0, 1, 0}), sun.to_light, 1e-12);
    EXPECT_NEAR(sun.color.b, 3 / std::numbers::pi, 1e-12);
    const auto& spot = std::get<SpotLight>(result.scene.lights[2].light);
    EXPECT_EQ(result.scene.lights[2].name, "lamp");
    EXPECT_EQ(spot.inner_angle, 0.1);
    EXPECT_EQ(spot.outer_angle, 0.2);
    EXPECT_EQ(spot.range, kNoRange);
}

}  // namespace
}  // namespace alhazen::testing
