#include "alhazen/session/conversion/convert.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/session/conversion/placed_meshes.h"
#include "alhazen/session/conversion/tessellated.h"
#include "alhazen/session/load.h"
#include "support/image_texture.h"
#include "support/scene_maker.h"
#include "support/scratch_folder.h"
#include "unit/formats/native/native_scene.h"
#include "unit/session/convert_scenes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::message_of;
using testing::SceneMaker;
using testing::ScratchFolder;
using testing::textured;
using testing::two_tetrahedra;

TriangleMesh read_back(const std::filesystem::path& path) {
    Diagnostics diagnostics;
    const SceneDescription scene = load_description(path, {}, diagnostics);
    TriangleMesh all;
    for (const MeshDescription& m : scene.meshes) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), m.mesh->positions.begin(),
                             m.mesh->positions.end());
        for (const auto& t : m.mesh->triangles) {
            all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        }
    }
    return all;
}

TEST(ConvertMeshes, InstancesAreMultipliedOutAndStayTurnedOutward) {
    const ScratchFolder folder;
    const SceneDescription scene = two_tetrahedra();
    const double volume = signed_volume(testing::tetrahedron());
    for (const char* suffix : {".ply", ".obj", ".stl", ".STL"}) {
        const auto path = folder.path() / (std::string("out") + suffix);
        const ConvertReport report = convert(scene, path);
        EXPECT_EQ(report.triangles, 8U);
        EXPECT_EQ(report.files.back(), path);
        const TriangleMesh mesh = read_back(path);
        EXPECT_EQ(mesh.triangles.size(), 8U) << suffix;
        EXPECT_NEAR(signed_volume(mesh), volume * (1 + 8), 1e-9) << suffix;
        EXPECT_EQ(mesh.box().hi.y, 12) << suffix;
    }
}

TEST(ConvertMeshes, ObjNamesItsMaterials) {
    const ScratchFolder folder;
    const ConvertReport report = convert(two_tetrahedra(), folder.path() / "a b.obj");
    ASSERT_EQ(report.files.size(), 2U);
    EXPECT_EQ(report.files[0].filename(), "a b.mtl");
    const std::string text = read_file(report.files[1]);
    EXPECT_NE(text.find("mtllib a b.mtl\n"), std::string::npos);
    EXPECT_NE(text.find("usemtl red_paint\n"), std::string::npos);
    EXPECT_NE(read_file(report.files[0]).find("newmtl red_paint\n"), std::string::npos);
}

TEST(ConvertMeshes, ShapesAreRefusedByKindOrLeftOut) {
    const ScratchFolder folder;
    SceneMaker maker;
    maker.description() = two_tetrahedra();
    maker.add(Sphere{}, MaterialId{0}, {}, ObjectIndex{1});
    maker.add(BoxShape{}, MaterialId{0}, {}, ObjectIndex{1});
    maker.add(Plane{}, MaterialId{0});
    const auto path = folder.path() / "out.stl";
    const std::string message = message_of(maker.description(), path, ErrorKind::Usage);
    EXPECT_NE(message.find("2 spheres, 1 plane, 2 boxes"), std::string::npos) << message;
    EXPECT_NE(message.find("--meshes-only"), std::string::npos) << message;
    EXPECT_NE(message.find("--tolerance X"), std::string::npos) << message;
    EXPECT_FALSE(std::filesystem::exists(path));
    try {
        (void)convert(maker.description(), path,
                      {.meshes_only_setting = "", .tolerance_setting = ""});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos) << error.what();
    }
    const ConvertReport report = convert(maker.description(), path, {.meshes_only = true});
    EXPECT_EQ(report.left_out, "2 spheres, 1 plane, 2 boxes");
    EXPECT_EQ(read_back(path).triangles.size(), 8U);
}

TEST(ConvertMeshes, ASceneWithoutTrianglesIsAnError) {
    const ScratchFolder folder;
    SceneMaker maker;
    (void)maker.material({});
    maker.add(Sphere{}, MaterialId{0});
    const ConvertOptions options{.meshes_only = true};
    EXPECT_NE(message_of(maker.description(), folder.path() / "a.ply", ErrorKind::Scene, options)
                  .find("no triangles"),
              std::string::npos);
}

TEST(Tessellate, TooManyTrianglesNameALargerTolerance) {
    SceneMaker maker;
    (void)maker.material({});
    const ObjectIndex object = maker.object("twice");
    maker.add(Superellipsoid{}, MaterialId{0}, {}, object);
    maker.add(object, MaterialId{0}, Affine::scale({2, 2, 2}));
    const auto message_with = [&](double tolerance, std::uint64_t most) {
        SceneDescription scene = maker.description();
        try {
            (void)tessellate(scene, tolerance, false, most);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Resource);
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string message = message_with(1e-6, 20'000);
    EXPECT_NE(message.find("with a tolerance of 1e-06 the scene has more than 20000 triangles; "),
              std::string::npos)
        << message;
    const std::size_t end = message.find(" may do");
    ASSERT_NE(end, std::string::npos) << message;
    const double larger = std::stod(message.substr(message.rfind(' ', end - 1)));
    EXPECT_GT(larger, 1e-6);
    EXPECT_LT(larger, 0.1);
    EXPECT_EQ(message_with(8 * larger, 20'000), "");
}

/// Each object places the previous one twice: 2^30 placements of the first.
SceneDescription doubling_scene(bool with_mesh) {
    SceneMaker maker;
    (void)maker.material({});
    ObjectIndex below = maker.object("0");
    if (with_mesh) maker.add(maker.mesh(testing::tetrahedron()), MaterialId{0}, {}, below);
    maker.add(Sphere{}, MaterialId{0}, {}, below);
    for (int i = 1; i <= 30; ++i) {
        const ObjectIndex object = maker.object(std::to_string(i));
        maker.add(below, {}, {}, object);
        maker.add(below, {}, {}, object);
        below = object;
    }
    maker.add(below);
    return maker.description();
}

TEST(ConvertMeshes, InstancesThatMultiplyBeyondMemoryAreRefused) {
    const ScratchFolder folder;
    const auto path = folder.path() / "out.ply";
    const ConvertOptions options{.meshes_only = true};
    EXPECT_EQ(count_placed(doubling_scene(true)).triangles, std::uint64_t{4} << 30);
    EXPECT_NE(message_of(doubling_scene(true), path, ErrorKind::Resource, options)
                  .find("4294967296 triangles"),
              std::string::npos);
    // A scene without meshes has no tree to traverse.
    SceneMaker maker;
    maker.description() = doubling_scene(false);
    maker.add(maker.mesh(testing::tetrahedron()), MaterialId{0});
    EXPECT_EQ(convert(maker.description(), path, options).triangles, 4U);
}

TEST(ConvertMeshes, WhatMtlCannotSayIsReported) {
    const ScratchFolder folder;
    SceneDescription scene = textured(10);
    std::get<ImageTexture>(scene.textures[0].texture).wrap_u = Wrap::Mirror;
    const ConvertReport report = convert(scene, folder.path() / "out.obj");
    ASSERT_FALSE(report.lost.empty());
    EXPECT_NE(report.lost[0].find("mirrored repeat"), std::string::npos) << report.lost[0];
    EXPECT_TRUE(convert(scene, folder.path() / "out.ply").lost.empty());
}

/// A material written to an OBJ and read back, and the losses that were told.
struct MaterialTrip {
    Material back;
    std::vector<std::string> lost;

    explicit MaterialTrip(const Material& material) {
        const ScratchFolder folder;
        SceneMaker maker;
        maker.add(maker.mesh(testing::tetrahedron()), maker.material(material));
        lost = convert(maker.description(), folder.path() / "out.obj").lost;
        Diagnostics found;
        back = load_description(folder.path() / "out.obj", {}, found).materials.at(0).material;
        EXPECT_TRUE(found.all().empty()) << to_string(found.all()[0]);
    }
};

TEST(ConvertMeshes, ABlackAmbientColourDoesNotReadBackAsTheDiffuseOne) {
    Material matt;
    matt.diffuse.color = {.5, .5, .5};
    const MaterialTrip trip(matt);
    EXPECT_LT(trip.back.ambient.color.max(), 1e-20);
    EXPECT_EQ(trip.back.diffuse.color, matt.diffuse.color);
    EXPECT_TRUE(trip.lost.empty()) << trip.lost[0];
}

TEST(ConvertMeshes, ConductorsAndDielectricsLookAlikeAsMtl) {
    const auto expect_alike = [](const Material& a, const Material& b) {
        const MaterialSample before = evaluate(a, {}, Vec2{}), after = evaluate(b, {}, Vec2{});
        EXPECT_EQ(before.diffuse, after.diffuse);
        EXPECT_EQ(before.ambient, after.ambient);
        EXPECT_EQ(before.specular, after.specular);
        EXPECT_EQ(before.reflective, after.reflective);
        EXPECT_EQ(before.transmissive, after.transmissive);
        EXPECT_EQ(before.grazing, after.grazing);
        EXPECT_EQ(before.index, after.index);
        EXPECT_EQ(before.thin, after.thin);
    };
    Material metal;
    metal.conductor = Conductor{{0.2, 0.4, 1.4}, {3, 2.4, 1.9}, ""};
    metal.roughness.value = 0.3;
    const MaterialTrip of_metal(metal);
    expect_alike(metal, of_metal.back);
    ASSERT_EQ(of_metal.lost.size(), 1U);
    EXPECT_NE(of_metal.lost[0].find("complex index of a conductor"), std::string::npos);

    Material glass;
    glass.dielectric.emplace();
    glass.index.value = 1.5;
    const MaterialTrip of_glass(glass);
    expect_alike(glass, of_glass.back);
    EXPECT_TRUE(of_glass.lost.empty()) << of_glass.lost[0];
    glass.dielectric->absorption = {1, 2, 3};
    glass.dispersion = Dispersion{.abbe = 30};
    const MaterialTrip of_tinted(glass);
    expect_alike(glass, of_tinted.back);
    ASSERT_EQ(of_tinted.lost.size(), 2U);
    EXPECT_NE(of_tinted.lost[0].find("absorption"), std::string::npos);
    EXPECT_NE(of_tinted.lost[1].find("dispersion"), std::string::npos);
}

TEST(ConvertMeshes, ACoatReadsBackFromMtl) {
    Material coated;
    MetallicRoughness& p = coated.metallic_roughness.emplace();
    p.metallic.value = 0;
    p.coat.strength.value = 0.5;
    p.coat.roughness.value = 0.25;
    const MaterialTrip trip(coated);
    ASSERT_TRUE(trip.back.metallic_roughness);
    EXPECT_EQ(trip.back.metallic_roughness->coat.strength.value, 0.5);
    EXPECT_EQ(trip.back.metallic_roughness->coat.roughness.value, 0.25);
    EXPECT_TRUE(trip.lost.empty()) << trip.lost[0];
}

TEST(ConvertMeshes, MaterialsOfVerticesBecomeMaterialsOfFaces) {
    const ScratchFolder folder;
    SceneMaker maker;
    (void)maker.material({.name = "red"});
    (void)maker.material({.name = "blue"});
    TriangleMesh mesh = testing::tetrahedron();
    mesh.vertex_materials = {1, 1, 1, 0};
    maker.add(maker.mesh(mesh));
    const ConvertReport report = convert(maker.description(), folder.path() / "out.obj");
    EXPECT_EQ(report.mixed_faces, 3U);
    ASSERT_EQ(losses_of(report).size(), 1U);
    EXPECT_NE(losses_of(report)[0].find("3 faces between vertices of different materials"),
              std::string::npos);
    Diagnostics found;
    const SceneDescription back = load_description(folder.path() / "out.obj", {}, found);
    ASSERT_EQ(back.materials.size(), 1U);  // each face has a first vertex of blue
    EXPECT_EQ(back.materials[0].material.name, "blue");
    EXPECT_EQ(convert(maker.description(), folder.path() / "out.ply").mixed_faces, 0U);
}

TEST(ConvertMeshes, AnObjTellsWhatItLosesOfVertices) {
    const ScratchFolder folder;
    SceneMaker maker;
    Material mapped{.name = "mapped"};
    ImageTexture blue;
    blue.image = std::make_shared<StoredImage>(
        StoredImage{1, 1, 3, false, std::vector<std::uint8_t>{128, 128, 255}});
    maker.description().textures.push_back({"blue", blue, {}});
    mapped.normal_map.texture = TextureId{0};
    const MaterialId plain = maker.material({.name = "plain"}), other = maker.material(mapped);
    TriangleMesh mesh = testing::tetrahedron();
    mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
    maker.add(maker.mesh(mesh), plain);
    EXPECT_EQ(convert(maker.description(), folder.path() / "a.obj").lost_mapped_tangents, 0U);
    maker.add(maker.mesh(mesh), other);
    mesh.tangents.clear();
    mesh.colors.assign(mesh.positions.size(), {1, 1, 1, 1});
    mesh.colors[2].a = 0.5f;
    maker.add(maker.mesh(mesh), plain);
    mesh.colors[2] = {0.5f, 1.5f, 1, 1};
    maker.add(maker.mesh(mesh), plain);
    const ConvertReport report = convert(maker.description(), folder.path() / "b.obj");
    EXPECT_EQ(report.lost_mapped_tangents, 1U);
    EXPECT_EQ(report.lost_alpha, 1U);
    EXPECT_EQ(report.clamped_colors, 1U);
    EXPECT_EQ(losses_of(report).size(), 3U + report.lost.size());
    EXPECT_THROW((void)convert(maker.description(), folder.path() / "c.obj", {.strict = true}),
                 Error);
}

TEST(ConvertMeshes, AnObjTellsThatItsNormalsAreUnit) {
    const ScratchFolder folder;
    SceneMaker maker;
    TriangleMesh mesh = testing::tetrahedron();
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    mesh.normals[1] = {0.6, 0.8, 0};
    const MaterialId plain = maker.material({.name = "plain"});
    const MeshIndex index = maker.mesh(mesh);
    maker.add(index, plain, Affine::scale({2, 2, 2}));
    EXPECT_TRUE(losses_of(convert(maker.description(), folder.path() / "a.obj")).empty());
    maker.add(index, plain, Affine::scale({1, 1, 3}));
    const ConvertReport report = convert(maker.description(), folder.path() / "b.obj");
    EXPECT_EQ(report.unit_normals, 1U);
    ASSERT_EQ(losses_of(report).size(), 1U);
    EXPECT_NE(losses_of(report)[0].find("those of 1 mesh are made unit"), std::string::npos)
        << losses_of(report)[0];
    EXPECT_TRUE(losses_of(convert(maker.description(), folder.path() / "b.ply")).empty());
}

TEST(ConvertMeshes, AnStlTellsOfCornersThatComeTogether) {
    const ScratchFolder folder;
    SceneMaker maker;
    const MeshIndex index = maker.mesh(testing::tetrahedron());
    const MaterialId plain = maker.material({.name = "plain"});
    maker.add(index, plain);
    EXPECT_TRUE(losses_of(convert(maker.description(), folder.path() / "a.stl")).empty());
    // Floats near 1e9 are 64 apart.
    maker.add(index, plain, Affine::translate({1e9, 1e9, 1e9}));
    const ConvertReport report = convert(maker.description(), folder.path() / "b.stl");
    EXPECT_EQ(report.collapsed, 4U);
    ASSERT_EQ(losses_of(report).size(), 1U);
    EXPECT_NE(losses_of(report)[0].find("corners of 4 triangles"), std::string::npos)
        << losses_of(report)[0];
    EXPECT_TRUE(losses_of(convert(maker.description(), folder.path() / "b.ply")).empty());
    EXPECT_THROW((void)convert(maker.description(), folder.path() / "c.stl", {.strict = true}),
                 Error);
}

TEST(ConvertMeshes, AnStlTellsHowFarItsFloatsMoveCorners) {
    const ScratchFolder folder;
    SceneMaker maker;
    // Floats near 1e6 are 1/16 apart: the corners are 1/64, 1/64 and 1/32 beside them.
    auto mesh = testing::tetrahedron();
    for (Vec3& p : mesh.positions) p = {1e6 + 1.0 / 64, 1e6 + 3.0 / 64 + p.y, 1e6 + 1.0 / 32 + p.z};
    maker.add(maker.mesh(mesh), maker.material({.name = "plain"}));
    const double moved = std::sqrt(1.0 + 1.0 + 4.0) / 64;
    const auto written = [&](const char* name, const ConvertOptions& options) {
        return convert(maker.description(), folder.path() / name, options);
    };
    const ConvertReport far = written("a.stl", {.tolerance = 0.05});
    EXPECT_GE(far.moved, moved);
    EXPECT_NEAR(far.moved, moved, 1e-12);
    EXPECT_TRUE(losses_of(far).empty());
    EXPECT_EQ(written("a.ply", {.tolerance = 0.05}).moved, 0.0);
    const ConvertReport farther = written("b.stl", {.tolerance = 0.03});
    ASSERT_EQ(losses_of(farther).size(), 1U);
    EXPECT_EQ(losses_of(farther)[0].substr(0, 94),
              "an STL holds floats: corners move by up to 0.0385, more than the tolerance of 0.03 "
              "(.alhazen, ");
    EXPECT_THROW((void)written("c.stl", {.tolerance = 0.03, .strict = true}), Error);
    EXPECT_TRUE(losses_of(written("d.ply", {.tolerance = 0.03, .strict = true})).empty());
    for (const double value : {0.1, 1.0049, 1.005, 9.995, 4.7684e-7}) {
        EXPECT_GE(std::stod(rounded_up(value)), value);
    }
}

TEST(ConvertMeshes, MotionThatIsLostIsCounted) {
    const ScratchFolder folder;
    const auto scene = folder.write(
        "in.alhazen",
        std::string("alhazen 1\n"
                    "picture { shutter = (0.5, 1) }\n"
                    "mesh { points = [(0,0,0), (1,0,0), (0,1,0)]; faces = [(0,1,2)];\n"
                    "    motion = [(0, translate(0,0,0)), (1, translate(8,0,0))] }\n"
                    "mesh { points = [(0,0,0), (1,0,0), (0,1,0)]; faces = [(0,1,2)];\n"
                    "    point_keys = [(0, [(0,0,0), (1,0,0), (0,1,0)]),\n"
                    "                  (1, [(0,0,6), (1,0,0), (0,1,0)])] }\n"
                    "mesh { points = [(0,0,0), (1,0,0), (0,1,0)]; faces = [(0,1,2)] }\n"));
    Diagnostics found;
    const SceneDescription description = load_description(scene, {}, found);
    for (const char* suffix : {".ply", ".obj", ".stl"}) {
        const auto path = folder.path() / (std::string("out") + suffix);
        const ConvertReport report = convert(description, path);
        EXPECT_EQ(report.moving_parts, 2U) << suffix;
        ASSERT_EQ(losses_of(report).size(), 1U) << suffix;
        EXPECT_NE(losses_of(report)[0].find("the motion of 2 parts, written as at time 0.5"),
                  std::string::npos)
            << losses_of(report)[0];
        EXPECT_NEAR(read_back(path).box().hi.x, 5, 1e-6) << suffix;
        EXPECT_NEAR(read_back(path).box().hi.z, 3, 1e-6) << suffix;
    }
    EXPECT_EQ(convert(description, folder.path() / "out.alhazen").moving_parts, 0U);
}

TEST(ConvertMeshes, TrianglesOfASolidAreTheSameIfAnOperandIsShown) {
    const auto mesh_of = [](const std::string& shown) {
        SceneDescription scene = testing::import_native(
                                     "object \"a\" { combine = union sphere { radius = 1 }\n"
                                     "  box { lo = (-2,-0.1,-0.1) hi = (2,0.1,0.1) } }\n" +
                                     shown +
                                     "object \"b\" { combine = difference\n"
                                     "  box { lo = (-3,-3,-3) hi = (3,3,3) } instance \"a\" }\n"
                                     "instance \"b\"\n")
                                     .scene;
        (void)tessellate(scene, 0.3, false, 1'000'000);
        return *scene.meshes.back().mesh;
    };
    const TriangleMesh alone = mesh_of(""), both = mesh_of("instance \"a\"\n");
    EXPECT_GT(alone.triangles.size(), 20U);
    EXPECT_EQ(both.triangles, alone.triangles);
    EXPECT_EQ(both.positions, alone.positions);
    EXPECT_EQ(both.normals, alone.normals);
}

TEST(ConvertMeshes, StrictRefusesLosses) {
    const ScratchFolder folder;
    SceneDescription scene = two_tetrahedra();
    const auto path = folder.path() / "out.obj";
    (void)convert(scene, path, {.strict = true});
    std::filesystem::remove(path);
    scene.materials[0].material.density = 3;
    const std::string message = message_of(scene, path, ErrorKind::Scene, {.strict = true});
    EXPECT_NE(message.find("error: the MTL file cannot express a density"), std::string::npos)
        << message;
    EXPECT_FALSE(std::filesystem::exists(path));
    (void)convert(scene, folder.path() / "out.alhazen", {.strict = true});
}

TEST(ConvertMeshes, TangentsOfAPlyAreKeptOrTold) {
    const ScratchFolder folder;
    TriangleMesh mesh = testing::tetrahedron();
    mesh.generate_normals();
    mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
    SceneMaker maker;
    (void)maker.material({.name = "paint"});
    maker.add(maker.mesh(mesh), {}, Affine::translate({1, 0, 0}));
    const auto path = folder.path() / "out.ply";
    EXPECT_TRUE(losses_of(convert(maker.description(), path, {.strict = true})).empty());
    Diagnostics found;
    EXPECT_EQ(load_description(path, {}, found).meshes.at(0).mesh->tangents, mesh.tangents);
    maker.add(maker.mesh(testing::tetrahedron()));
    const std::vector<std::string> losses = losses_of(convert(maker.description(), path));
    ASSERT_EQ(losses.size(), 1U);
    EXPECT_NE(losses[0].find("those of 1 mesh are left out"), std::string::npos) << losses[0];
    (void)message_of(maker.description(), path, ErrorKind::Scene, {.strict = true});
    EXPECT_TRUE(losses_of(convert(maker.description(), folder.path() / "out.stl")).empty());
}

TEST(ConvertMeshes, KindsOfShapesHaveProperPlurals) {
    SceneMaker maker;
    for (int i = 0; i < 2; ++i) {
        maker.add(Torus{});
        maker.add(BoxShape{});
        maker.add(Sphere{});
    }
    EXPECT_EQ(shapes_in_words(count_placed(maker.description())), "2 spheres, 2 boxes, 2 tori");
}

TEST(ConvertMeshes, MasksThatAreLostAreCounted) {
    const ScratchFolder folder;
    SceneDescription scene = textured(10);
    EXPECT_EQ(convert(scene, folder.path() / "out.ply").masked_parts, 0U);
    scene.objects.front().parts.front().visible_to = RayMask{1};
    EXPECT_EQ(convert(scene, folder.path() / "out.ply").masked_parts, 1U);
    EXPECT_EQ(convert(scene, folder.path() / "out.alhazen").masked_parts, 0U);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
