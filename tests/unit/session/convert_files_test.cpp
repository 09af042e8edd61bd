#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/session/conversion/convert.h"
#include "alhazen/session/load.h"
#include "support/same_description.h"
#include "support/scene_maker.h"
#include "support/scratch_folder.h"
#include "unit/session/convert_scenes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::message_of;
using testing::SceneMaker;
using testing::ScratchFolder;
using testing::textured;
using testing::two_tetrahedra;

TEST(ConvertNative, TheFolderCanBeMovedWithTheScene) {
    const ScratchFolder folder;
    std::filesystem::create_directories(folder.path() / "a");
    SceneDescription scene = two_tetrahedra();
    scene.meshes[0].mesh->generate_normals();
    const ConvertReport report = convert(scene, folder.path() / "a" / "my \"scene\".alhazen");
    ASSERT_EQ(report.files.size(), 2U);
    EXPECT_EQ(report.files[0], folder.path() / "a" / "my \"scene\"_files" / "mesh_0.ply");
    std::filesystem::rename(folder.path() / "a", folder.path() / "b");
    Diagnostics diagnostics;
    const SceneDescription moved =
        load_description(folder.path() / "b" / "my \"scene\".alhazen", {}, diagnostics);
    EXPECT_EQ(moved.meshes.at(0).mesh->triangles.size(), 4U);
}

TEST(ConvertNative, TheSceneItselfIsNeverOverwritten) {
    const ScratchFolder folder;
    SceneDescription scene = two_tetrahedra();
    scene.meshes[0].mesh->generate_normals();
    scene.path = folder.write("out_files/mesh_0.ply", std::string("precious"));
    EXPECT_NE(message_of(scene, folder.path() / "out.alhazen", ErrorKind::Usage)
                  .find("could be overwritten"),
              std::string::npos);
    EXPECT_EQ(read_file(scene.path), "precious");
    scene.path = folder.write("in.alhazen", std::string("precious"));
    std::filesystem::create_symlink(scene.path, folder.path() / "link.alhazen");
    for (const char* name : {"in.alhazen", "./in.alhazen", "link.alhazen"}) {
        EXPECT_NE(message_of(scene, folder.path() / name, ErrorKind::Usage).find("scene itself"),
                  std::string::npos);
    }
    EXPECT_EQ(read_file(scene.path), "precious");
}

TEST(ConvertMeshes, FilesOfTheSceneAreNeverOverwritten) {
    const ScratchFolder folder;
    const auto in = folder.write(
        "in.obj", std::string("mtllib out.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"));
    const std::string text = "newmtl m\nmap_Kd out_files/texture_0.pfm\n";
    const auto library = folder.write("out.mtl", text);
    (void)folder.write("out_files/texture_0.pfm", "PF\n1 1\n-1\n" + std::string(12, '\0'));
    Diagnostics found;
    const SceneDescription scene = load_description(in, {}, found);
    EXPECT_EQ(scene.textures.size(), 1U);
    EXPECT_NE(message_of(scene, folder.path() / "out.obj", ErrorKind::Usage).find("out.mtl"),
              std::string::npos);
    EXPECT_NE(message_of(scene, folder.path() / "out.alhazen", ErrorKind::Usage).find("texture_0"),
              std::string::npos);
    EXPECT_EQ(read_file(library), text);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out.obj"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out_files/texture_0.exr"));
    // Entries that are not written may exist already.
    EXPECT_EQ(convert(scene, folder.path() / "out.ply").triangles, 1U);
    EXPECT_EQ(convert(scene, folder.path() / "other.obj").triangles, 1U);
}

TEST(ConvertMeshes, BuffersMeshesAndIncludedFilesBelongToTheScene) {
    const ScratchFolder folder;
    const auto names = [&](const std::string& file) {
        Diagnostics found;
        std::set<std::string> read;
        for (const auto& path : load_description(folder.path() / file, {}, found).files) {
            read.insert(path.filename().string());
        }
        return read;
    };
    (void)folder.write("tri.stl", std::string("solid a\nfacet normal 0 0 1\nouter loop\n"
                                              "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                                              "endloop\nendfacet\nendsolid a\n"));
    (void)folder.write("more.alhazen", std::string("alhazen 1\nmesh { file = \"tri.stl\" }\n"));
    (void)folder.write("a.alhazen", std::string("alhazen 1\ninclude \"more.alhazen\"\n"));
    EXPECT_EQ(names("a.alhazen"), (std::set<std::string>{"more.alhazen", "tri.stl"}));
    (void)folder.write("b.bin", std::string(36, '\0'));
    (void)folder.write("b.gltf",
                       std::string(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [0, 0, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "b.bin"}]})"));
    EXPECT_EQ(names("b.gltf"), (std::set<std::string>{"b.bin"}));
}

/// The only texel of the first texture of a scene file.
double texel_of(const std::filesystem::path& path) {
    Diagnostics found;
    const SceneDescription scene = load_description(path, {}, found);
    return std::round(255 * testing::image_texture(scene.textures.at(0)).image->pixel(0, false).r);
}

std::size_t entries_in(const std::filesystem::path& folder) {
    return std::size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(ConvertNative, FilesOfAnotherSceneAreNotReplaced) {
    const ScratchFolder folder;
    const auto native = folder.path() / "out.alhazen", obj = folder.path() / "out.obj";
    (void)convert(textured(10), native);
    (void)convert(textured(20), obj);  // writes to the same folder under another name
    EXPECT_EQ(texel_of(native), 10);
    EXPECT_EQ(texel_of(obj), 20);
    EXPECT_EQ(entries_in(folder.path() / "out_files"), 2U);
    // Its own files are replaced, equal ones shared.
    (void)convert(textured(30), obj);
    EXPECT_EQ(texel_of(obj), 30);
    (void)convert(textured(10), obj);
    EXPECT_EQ(texel_of(obj), 10);
    EXPECT_EQ(texel_of(native), 10);
    // A copy under another name also refers to them.
    std::filesystem::copy_file(native, folder.path() / "copy.alhazen");
    (void)convert(textured(40), native);
    EXPECT_EQ(texel_of(folder.path() / "copy.alhazen"), 10);
    EXPECT_EQ(texel_of(native), 40);
}

TEST(ConvertNative, WithoutAnotherSceneTheNamesStayTheSame) {
    const ScratchFolder folder;
    const auto out = folder.path() / "out.alhazen";
    for (const std::uint8_t grey : std::array<std::uint8_t, 3>{10, 20, 30}) {
        const ConvertReport report = convert(textured(grey), out);
        EXPECT_EQ(report.files.at(0).filename(), "texture_0.png");
        EXPECT_EQ(texel_of(out), grey);
    }
    EXPECT_EQ(entries_in(folder.path() / "out_files"), 1U);
    // A link may lead to any file.
    (void)folder.write("precious.png", std::string("precious"));
    std::filesystem::remove(folder.path() / "out_files" / "texture_0.png");
    std::filesystem::create_symlink("../precious.png",
                                    folder.path() / "out_files" / "texture_0.png");
    (void)convert(textured(40), out);
    EXPECT_EQ(read_file(folder.path() / "precious.png"), "precious");
    EXPECT_EQ(texel_of(out), 40);
}

TEST(ConvertNative, WhatFailsLeavesNothingBehind) {
    const ScratchFolder folder;
    SceneDescription broken = textured(10);
    broken.materials[0].material.emission.color.r = std::nan("");
    // The image is written before the material fails.
    (void)message_of(broken, folder.path() / "out.alhazen", ErrorKind::Scene);
    EXPECT_EQ(entries_in(folder.path()), 0U);
    // Images and materials are written before OUT, which cannot be created.
    std::filesystem::create_symlink("/dev/null", folder.path() / "out.obj");
    (void)message_of(textured(10), folder.path() / "out.obj", ErrorKind::File);
    EXPECT_EQ(entries_in(folder.path()), 1U);
    // Existing files stay.
    (void)folder.write("out_files/mine.txt", std::string("mine"));
    (void)message_of(textured(10), folder.path() / "out.obj", ErrorKind::File);
    EXPECT_EQ(entries_in(folder.path()), 2U);
    EXPECT_EQ(entries_in(folder.path() / "out_files"), 1U);
}

TEST(ConvertNative, BumpMapsStayBitForBit) {
    const ScratchFolder folder;
    (void)folder.write("a.obj", std::string("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                            "vt 3 0\nvt 0 3\nusemtl m\nf 1/1 2/2 3/3\n"));
    (void)folder.write("a.mtl", std::string("newmtl m\nKd 1 1 1\nmap_Kd b.pfm\n"
                                            "map_bump -bm 4 -o .25 0 -s 2 2 b.pfm\n"));
    std::string picture = "Pf\n4 4\n-1\n";
    for (int i = 0; i < 16; ++i) {
        const float height = float(i * i % 7) / 7;
        picture.append(reinterpret_cast<const char*>(&height), sizeof height);
    }
    (void)folder.write("b.pfm", picture);
    Diagnostics found;
    const SceneDescription scene = load_description(folder.path() / "a.obj", {}, found);
    ASSERT_EQ(found.all().size(), 0U) << to_string(found.all()[0]);
    (void)convert(scene, folder.path() / "out.alhazen");
    testing::expect_same(scene, load_description(folder.path() / "out.alhazen", {}, found));
    // MTL declares it as a normal map.
    const ConvertReport report = convert(scene, folder.path() / "out.obj");
    EXPECT_TRUE(report.lost.empty()) << report.lost[0];
    const SceneDescription back = load_description(folder.path() / "out.obj", {}, found);
    const auto map_of = [](const SceneDescription& s) {
        return testing::image_texture(
            s.textures.at(std::size_t(s.materials.at(0).material.normal_map.texture)));
    };
    EXPECT_EQ(map_of(back).image->samples, map_of(scene).image->samples);
    EXPECT_EQ(map_of(back).uv_transform, map_of(scene).uv_transform);
}

TEST(ConvertNative, WhatCannotBeWrittenIsToldAndLeavesNoScene) {
    const ScratchFolder folder;
    SceneDescription scene = two_tetrahedra();
    scene.meshes[0].mesh->generate_normals();
    (void)folder.write("out_files", std::string("a file, not a folder"));
    EXPECT_NE(message_of(scene, folder.path() / "out.alhazen", ErrorKind::File).find("out_files"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out.alhazen"));
    (void)message_of(scene, folder.path() / "missing" / "out.alhazen", ErrorKind::File);
    EXPECT_NE(message_of(scene, folder.path() / "out.gltf", ErrorKind::Usage).find(".alhazen"),
              std::string::npos);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
