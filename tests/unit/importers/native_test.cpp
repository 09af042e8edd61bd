#include "alhazen/importers/native/native_importer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include "alhazen/base/file.h"
#include "alhazen/importers/native/native_shapes.h"
#include "text_scene.h"

namespace alhazen {
namespace {

using testing::Imported;

Imported import(const std::string& body, const ImportOptions& options = {}) {
    return testing::import_text<NativeImporter>("alhazen 1\n" + body, "scene.alhazen", options);
}

Imported import_file(const std::filesystem::path& path, const ImportOptions& options = {}) {
    return testing::import_text<NativeImporter>(read_file(path), path, options);
}

const Material& material_of(const Imported& i, std::size_t part) {
    return i.scene.materials.at(static_cast<std::size_t>(i.parts().at(part).material)).material;
}

template <class S>
const S& shape_of(const Imported& i, std::size_t part) {
    return std::get<S>(std::get<AnyShape>(i.parts().at(part).what));
}

void expect_near(const Vec3& a, const Vec3& b) {
    EXPECT_NEAR(a.x, b.x, 1e-12);
    EXPECT_NEAR(a.y, b.y, 1e-12);
    EXPECT_NEAR(a.z, b.z, 1e-12);
}

/// A folder of files that is removed at the end of a test.
class Folder {
  public:
    Folder() {
        const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        path_ = std::filesystem::temp_directory_path() /
                ("alhazen_native_" + test +
                 std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                 std::to_string(reinterpret_cast<std::uintptr_t>(this)));
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name) << text;
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

TEST(NativeImporter, RecognisesItsHeader) {
    const ImportOptions options;
    const NativeImporter importer;
    EXPECT_EQ(importer.recognise({"alhazen 1", "x", options}), 2);
    EXPECT_EQ(importer.recognise({"// a\nalhazen 7", "x", options}), 2);
    EXPECT_EQ(importer.recognise({"sphere", "x.alhazen", options}), 1);
    EXPECT_EQ(importer.recognise({"alhazen", "x", options}), 0);
    EXPECT_EQ(importer.recognise({"SBT-raytracer 1.0", "x.ray", options}), 0);
}

TEST(NativeImporter, RefusesOtherHeadersAndVersions) {
    for (const char* text : {"", "alhazen", "alhazen 2", "sphere { }", "alhazen { }"}) {
        const Imported i = testing::import_text<NativeImporter>(text, "a.alhazen");
        EXPECT_EQ(i.errors(), 1u) << text << i.messages();
        EXPECT_TRUE(i.says("alhazen 1")) << i.messages();
    }
}

TEST(NativeImporter, LoadsTheExampleOfItsDocumentation) {
    const std::string page =
        read_file(std::filesystem::path(ALHAZEN_SOURCE_DIR) / "docs/formats/native.md");
    const std::string fence = "```alhazen\n";
    const std::size_t begin = page.find(fence);
    ASSERT_NE(begin, std::string::npos);
    const std::string text =
        page.substr(begin + fence.size(), page.find("```", begin + 3) - begin - fence.size());
    const Imported i = testing::import_text<NativeImporter>(text, "example.alhazen");
    EXPECT_EQ(i.messages(), "");
    EXPECT_EQ(i.parts().size(), 5u);
    EXPECT_EQ(i.scene.objects.size(), 2u);
    EXPECT_EQ(i.scene.lights.size(), 2u);
    EXPECT_NEAR(i.scene.cameras.at(0).aspect, 320.0 / 240.0, 1e-15);
    EXPECT_EQ(*i.scene.picture.width, 320);
}

TEST(NativeImporter, LoadsTheScenesOfTheRepository) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(
             std::filesystem::path(ALHAZEN_SOURCE_DIR) / "scenes")) {
        if (entry.path().extension() != ".alhazen") continue;
        ++count;
        const Imported i = import_file(entry.path());
        EXPECT_EQ(i.messages(), "");
        EXPECT_FALSE(i.parts().empty()) << entry.path();
        EXPECT_FALSE(i.scene.cameras.empty()) << entry.path();
    }
    EXPECT_GE(count, 3);
}

TEST(NativeImporter, ShowsEveryShapeInTheShowcase) {
    const Imported i =
        import_file(std::filesystem::path(ALHAZEN_SOURCE_DIR) / "scenes/showcase.alhazen");
    std::vector<bool> seen(AnalyticShapes::kCount);
    for (const ObjectDescription& object : i.scene.objects) {
        for (const Part& part : object.parts) {
            if (const auto* shape = std::get_if<AnyShape>(&part.what)) seen[shape->index()] = true;
        }
    }
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_TRUE(seen[k]) << "shape type " << k;
    EXPECT_FALSE(i.scene.meshes.empty());
}

TEST(NativeImporter, ReadsEveryFieldOfEveryShape) {
    const Imported i = import(
        "sphere { center = (1,2,3); radius = 4 }"
        "plane { point = (1,2,3); normal = (4,5,6) }"
        "disc { center = (1,2,3); normal = (4,5,6); radius = 7; inner_radius = 2 }"
        "rectangle { corner = (1,2,3); edge_u = (4,5,6); edge_v = (7,8,9) }"
        "box { lo = (1,2,3); hi = (4,5,6) }"
        "cylinder { base = (1,2,3); top = (4,5,6); radius = 7; capped = false }"
        "cone { base = (1,2,3); top = (4,5,6); base_radius = 7; top_radius = 8; capped = false }"
        "polygon { loops = [[(0,0,0),(3,0,0),(0,3,0)], [(1,1,0),(2,1,0),(1,2,0)]] }"
        "polygon { vertices = ((0,0,0),(3,0,0),(0,3,0)) }");
    ASSERT_EQ(i.messages(), "");
    const Vec3 a{1, 2, 3}, b{4, 5, 6}, c{7, 8, 9};
    EXPECT_EQ(shape_of<Sphere>(i, 0).center, a);
    EXPECT_EQ(shape_of<Sphere>(i, 0).radius, 4);
    EXPECT_EQ(shape_of<Plane>(i, 1).point, a);
    EXPECT_EQ(shape_of<Plane>(i, 1).normal, b);
    EXPECT_EQ(shape_of<Disc>(i, 2).center, a);
    EXPECT_EQ(shape_of<Disc>(i, 2).normal, b);
    EXPECT_EQ(shape_of<Disc>(i, 2).radius, 7);
    EXPECT_EQ(shape_of<Disc>(i, 2).inner_radius, 2);
    EXPECT_EQ(shape_of<Rectangle>(i, 3).corner, a);
    EXPECT_EQ(shape_of<Rectangle>(i, 3).edge_u, b);
    EXPECT_EQ(shape_of<Rectangle>(i, 3).edge_v, c);
    EXPECT_EQ(shape_of<BoxShape>(i, 4).lo, a);
    EXPECT_EQ(shape_of<BoxShape>(i, 4).hi, b);
    EXPECT_EQ(shape_of<Cylinder>(i, 5).base, a);
    EXPECT_EQ(shape_of<Cylinder>(i, 5).top, b);
    EXPECT_EQ(shape_of<Cylinder>(i, 5).radius, 7);
    EXPECT_FALSE(shape_of<Cylinder>(i, 5).capped);
    EXPECT_EQ(shape_of<Cone>(i, 6).base, a);
    EXPECT_EQ(shape_of<Cone>(i, 6).top, b);
    EXPECT_EQ(shape_of<Cone>(i, 6).base_radius, 7);
    EXPECT_EQ(shape_of<Cone>(i, 6).top_radius, 8);
    EXPECT_FALSE(shape_of<Cone>(i, 6).capped);
    EXPECT_EQ(shape_of<Polygon>(i, 7).loop_ends, (std::vector<std::uint32_t>{3, 6}));
    EXPECT_EQ(shape_of<Polygon>(i, 8).vertices.size(), 3u);
}

TEST(NativeImporter, HasABlockForEveryShapeWithItsOwnName) {
    for (const std::string_view name : native_shape_names()) {
        const Imported i = import(std::string(name) + " { transform = scale(2) }");
        const bool polygon = name == "polygon";  // the only one without defaults
        EXPECT_EQ(i.errors(), polygon ? 1u : 0u) << i.messages();
        EXPECT_EQ(i.parts().size(), 1u);
    }
}

TEST(NativeImporter, AppliesAListOfTransformsInTheWrittenOrder) {
    const Imported i = import(
        "sphere { transform = [translate(1,0,0), rotate((0,0,1), 90), scale(2,3,4)] }"
        "group { transform = translate(0,0,5); sphere { transform = scale(2) } }"
        "sphere { transform = matrix((1,2,3,4),(0,1,5,6),(0,0,1,7)) }");
    ASSERT_EQ(i.messages(), "");
    expect_near(i.parts()[0].object_from_part.point({0, 0, 0}), {0, 3, 0});
    expect_near(i.parts()[0].object_from_part.point({0, 1, 1}), {-2, 3, 4});
    expect_near(i.parts()[1].object_from_part.point({1, 0, 0}), {2, 0, 5});
    expect_near(i.parts()[2].object_from_part.point({1, 1, 1}), {10, 12, 8});
}

TEST(NativeImporter, SaysWhatATransformMayBe) {
    for (const char* bad :
         {"3", "shear(1,2,3)", "translate(1,2)", "rotate((0,0,0), 3)", "rotate(0,0,1)",
          "scale(1,2)", "scale()", "matrix((1,2,3,4))", "[translate(1,2,3), 7]", "translate"}) {
        const Imported i = import(std::string("sphere { transform = ") + bad + " }");
        EXPECT_EQ(i.errors(), 1u) << bad << "\n" << i.messages();
    }
}

TEST(NativeImporter, ReadsMaterialsByNameInlineAndByDefault) {
    const Imported i = import(
        "sphere { }"
        "material \"m\" { diffuse = (1,.5,0); specular = .25; emission = (0,0,1); reflective = .5;"
        " transmissive = (.1,.2,.3); shininess = 12; index = 1.5 }"
        "sphere { material = \"m\" } sphere { material = { diffuse = (0,1,0); ambient = 0 } }"
        "defaults { material = \"m\" } sphere { }"
        "group { defaults { material = { diffuse = .1 } } sphere { } } sphere { }"
        "group { material = { diffuse = .2 } sphere { } }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(material_of(i, 0).diffuse.color, (Rgb{.7, .7, .7}));
    const Material& m = material_of(i, 1);
    EXPECT_EQ(m.diffuse.color, (Rgb{1, .5, 0}));
    EXPECT_EQ(m.ambient.color, m.diffuse.color);
    EXPECT_EQ(m.specular.color, (Rgb{.25, .25, .25}));
    EXPECT_EQ(m.emission.color, (Rgb{0, 0, 1}));
    EXPECT_EQ(m.transmissive.color, (Rgb{.1, .2, .3}));
    EXPECT_EQ(m.shininess.value, 12);
    EXPECT_EQ(m.index.value, 1.5);
    EXPECT_EQ(material_of(i, 2).ambient.color, (Rgb{}));
    EXPECT_EQ(i.parts()[3].material, i.parts()[1].material);
    EXPECT_EQ(material_of(i, 4).diffuse.color, (Rgb{.1, .1, .1}));
    EXPECT_EQ(i.parts()[5].material, i.parts()[1].material);
    EXPECT_EQ(material_of(i, 6).diffuse.color, (Rgb{.2, .2, .2}));
}

TEST(NativeImporter, ListsTheNamesThereAre) {
    const Imported i =
        import("material \"red\" { } material \"blue\" { } sphere {\n material = \"green\" }");
    EXPECT_EQ(i.errors(), 1u);
    EXPECT_TRUE(
        i.says("scene.alhazen:3:13: error: material \"green\" is not defined; defined are "
               "blue, red"))
        << i.messages();
    EXPECT_TRUE(import("sphere {\n raduis = 1 }")
                    .says("scene.alhazen:3:2: error: sphere: unknown key 'raduis'; known are "
                          "transform, center, radius, material"));
    EXPECT_TRUE(import("sphare { }").says("unknown block 'sphare'; known are picture"));
    EXPECT_TRUE(import("conventions { highlight = gloss }").says("one of phong, blinn_phong"));
    EXPECT_TRUE(import("sphere { radius = 1; radius = 2 }").says("given twice"));
    EXPECT_TRUE(import("material \"a\" { } material \"a\" { }").says("already defined"));
    EXPECT_TRUE(import("instance \"x\";").says("object \"x\" is not defined before its use"));
}

TEST(NativeImporter, InstancesObjectsInsteadOfCopyingThem) {
    const Imported i = import(
        "object \"leg\" { cylinder { } }"
        "object \"table\" { instance \"leg\" { transform = translate(1,0,0) } instance \"leg\"; "
        "box { } }"
        "instance \"table\" { name = \"first\" }");
    ASSERT_EQ(i.messages(), "");
    ASSERT_EQ(i.scene.objects.size(), 3u);
    EXPECT_EQ(i.scene.root, ObjectIndex{0});
    ASSERT_EQ(i.parts().size(), 1u);
    EXPECT_EQ(std::get<ObjectIndex>(i.parts()[0].what), ObjectIndex{2});
    EXPECT_EQ(i.parts()[0].name, "first");
    const auto& table = i.scene.objects[2].parts;
    ASSERT_EQ(table.size(), 3u);
    EXPECT_EQ(std::get<ObjectIndex>(table[0].what), ObjectIndex{1});
    expect_near(table[0].object_from_part.point({0, 0, 0}), {1, 0, 0});
}

TEST(NativeImporter, CannotInstanceAnObjectInsideItself) {
    EXPECT_TRUE(import("object \"a\" { instance \"a\"; }").says("object \"a\" is not defined"));
}

TEST(NativeImporter, ReadsCameras) {
    const Imported i = import(
        "picture { width = 200; height = 100 }"
        "perspective_camera \"p\" { eye = (0,0,5); look_at = (0,0,0); fov_deg = 90 }"
        "perspective_camera { eye = (0,0,5); direction = (0,0,-7); fov_deg = 90; aspect = 1 }"
        "sheared_camera { eye = (1,0,0); look = (0,0,-2); right = (3,0,1); up = (0,4,0); aspect = "
        "1 }"
        "orthographic_camera { eye = (0,0,5); direction = (0,0,-1); height = 6 }");
    ASSERT_EQ(i.messages(), "");
    const auto& p = std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera);
    expect_near(p.look, {0, 0, -1});
    expect_near(p.right, {4, 0, 0});
    expect_near(p.up, {0, 2, 0});
    EXPECT_EQ(i.scene.cameras[0].aspect, 2);
    EXPECT_EQ(i.scene.cameras[0].name, "p");
    expect_near(std::get<PerspectiveCamera>(i.scene.cameras.at(1).camera).right, {2, 0, 0});
    expect_near(std::get<PerspectiveCamera>(i.scene.cameras.at(2).camera).right, {3, 0, 1});
    const auto& o = std::get<OrthographicCamera>(i.scene.cameras.at(3).camera);
    expect_near(o.right, {12, 0, 0});
    expect_near(o.up, {0, 6, 0});
}

TEST(NativeImporter, ReadsLights) {
    const Imported i = import(
        "ambient_light { color = (.1,.2,.3) }"
        "directional_light \"sun\" { direction = (0,0,-2); color = (1,.5,0); ambient = (.1,.1,.1) }"
        "directional_light { to_light = (0,0,2) }"
        "point_light { position = (1,2,3); attenuation = (1,2,3) }"
        "spot_light { position = (0,0,5); look_at = (0,0,0); inner_angle_deg = 10; outer_angle_deg "
        "= 20 }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(std::get<AmbientLight>(i.scene.lights.at(0).light).ambient, (Rgb{.1, .2, .3}));
    const auto& sun = std::get<DirectionalLight>(i.scene.lights.at(1).light);
    expect_near(sun.to_light, {0, 0, 2});  // `compile` makes it unit
    EXPECT_EQ(sun.ambient, (Rgb{.1, .1, .1}));
    expect_near(std::get<DirectionalLight>(i.scene.lights.at(2).light).to_light, {0, 0, 2});
    EXPECT_EQ(std::get<PointLight>(i.scene.lights.at(3).light).attenuation.quadratic, 3);
    const auto& spot = std::get<SpotLight>(i.scene.lights.at(4).light);
    expect_near(spot.direction, {0, 0, -5});
    EXPECT_NEAR(spot.outer_angle, std::numbers::pi / 9, 1e-15);
}

TEST(NativeImporter, ReadsRangesGreyColorsAndAnglesInRadians) {
    const Imported i = import(
        "picture { background = 0.25; up_axis = z }"
        "point_light { position = (1,2,3); color = 0.5; range = 7 }"
        "spot_light { position = (0,0,5); direction = (0,0,-1); inner_angle_rad = 0.1;"
        " outer_angle_deg = 20; range = 3 }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(i.scene.picture.background, (Rgb{.25, .25, .25}));
    EXPECT_EQ(i.scene.up_axis, UpAxis::Z);
    const auto& point = std::get<PointLight>(i.scene.lights.at(0).light);
    EXPECT_EQ(point.color, (Rgb{.5, .5, .5}));
    EXPECT_EQ(point.range, 7);
    const auto& spot = std::get<SpotLight>(i.scene.lights.at(1).light);
    EXPECT_EQ(spot.inner_angle, 0.1);
    EXPECT_EQ(spot.range, 3);
    EXPECT_TRUE(import("point_light { position = (0,0,0); range = 0 }").says("greater than 0"));
    EXPECT_TRUE(import("spot_light { position = (0,0,0); direction = (0,0,1); inner_angle_rad = 1;"
                       " inner_angle_deg = 1 }")
                    .says("say the same"));
}

TEST(NativeImporter, StringsMayEscapeQuotesAndBytes) {
    const Imported i = import("sphere \"a \\\"b\\\" \\\\ \\x41\\n\" { }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(i.parts().at(0).name, "a \"b\" \\ A\n");
    EXPECT_TRUE(import("sphere \"a\\q\" { }").says("a string may escape"));
    EXPECT_TRUE(import("sphere \"a\\x4\" { }").says("a string may escape"));
    EXPECT_TRUE(import("sphere \"a\\").says("unterminated string"));
    EXPECT_TRUE(import("sphere \"a\\\" { }").says("unterminated string"));
}

TEST(NativeImporter, GeometriesArePlacedByName) {
    const Imported i = import(
        "material \"red\" { }"
        "geometry \"tent\" { points = [(0,0,0), (1,0,0), (0,1,0)]; faces = [(0,1,2)] }"
        "mesh \"a\" { geometry = \"tent\" }"
        "mesh { geometry = \"tent\"; transform = scale(2); material = \"red\" }");
    ASSERT_EQ(i.messages(), "");
    ASSERT_EQ(i.scene.meshes.size(), 1U);
    EXPECT_EQ(i.scene.meshes[0].name, "tent");
    ASSERT_EQ(i.parts().size(), 2U);
    EXPECT_EQ(std::get<MeshIndex>(i.parts()[1].what), MeshIndex{0});
    EXPECT_TRUE(import("mesh { geometry = \"tent\" }").says("not defined"));
    EXPECT_TRUE(import("mesh { geometry = 5 }").says("the name of a geometry"));
    EXPECT_TRUE(import("geometry { points = []; faces = [] }").says("expected a name"));
}

TEST(NativeImporter, TheListOfObjectsNumbersThem) {
    const Imported i = import(
        "objects { names = [\"car\", \"world\", \"wheel\"]; root = \"world\"; root_name = \"\" }"
        "object \"car\" { instance \"wheel\" { } }"
        "instance \"car\";"
        "object \"wheel\" { name = \"round\"; sphere { } }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(i.scene.root, ObjectIndex{1});
    ASSERT_EQ(i.scene.objects.size(), 3U);
    EXPECT_EQ(i.scene.objects[0].name, "car");
    EXPECT_EQ(i.scene.objects[1].name, "");
    EXPECT_EQ(i.scene.objects[2].name, "round");
    EXPECT_EQ(std::get<ObjectIndex>(i.scene.objects[0].parts.at(0).what), ObjectIndex{2});
    EXPECT_TRUE(import("objects { names = [\"a\", \"b\"]; root = \"a\" }").says("not defined"));
    EXPECT_TRUE(
        import("objects { names = [\"a\", \"c\"]; root = \"b\" } object \"c\" { } sphere { }")
            .says("one of the names"));
    EXPECT_TRUE(import("objects { names = []; root = \"b\" } object \"b\" { }").says("is empty"));
    EXPECT_TRUE(import("objects { names = [\"a\", \"a\"]; root = \"a\" }").says("already defined"));
    EXPECT_TRUE(import("sphere { } objects { names = [\"a\"]; root = \"a\" }").says("before"));
    EXPECT_TRUE(import("objects { names = [\"a\"]; root = \"a\" } object \"a\" { }")
                    .says("already defined"));
}

TEST(NativeImporter, ReadsMetallicRoughnessAndAlpha) {
    const Imported i = import(
        "material \"m\" { alpha_mode = mask; alpha = 0.5; alpha_cutoff = 0.25; double_sided = "
        "false;"
        " metallic_roughness = { base_color = 0.5; metallic = 0; roughness = 0.25; unlit = true;"
        " attenuation_distance = 2; attenuation_color = (1, 0.5, 0) } }"
        "sphere { material = \"m\" }");
    ASSERT_EQ(i.messages(), "");
    const Material& m = material_of(i, 0);
    EXPECT_EQ(m.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(m.alpha.value, 0.5);
    EXPECT_EQ(m.alpha_cutoff, 0.25);
    EXPECT_FALSE(m.double_sided);
    ASSERT_TRUE(m.metallic_roughness);
    EXPECT_EQ(m.metallic_roughness->base_color.color, (Rgb{.5, .5, .5}));
    EXPECT_EQ(m.metallic_roughness->metallic.value, 0);
    EXPECT_EQ(m.metallic_roughness->roughness.value, 0.25);
    EXPECT_EQ(m.metallic_roughness->occlusion.value, 1);
    EXPECT_EQ(m.metallic_roughness->attenuation_distance, 2);
    EXPECT_TRUE(m.metallic_roughness->unlit);
    EXPECT_TRUE(import("material \"m\" { metallic_roughness = 5 }").says("expected a block"));
    EXPECT_TRUE(import("material \"m\" { normal_map = 5 }").says("texture(\"NAME\")"));
    EXPECT_TRUE(
        import("material \"m\" { metallic_roughness = { metal = 5 } }").says("unknown key"));
}

TEST(NativeImporter, ReadsEveryConvention) {
    const Imported i = import(
        "conventions { highlight = phong; shadow_tint = opaque; refraction_tint = per_distance;"
        " ambient_factor = diffuse; ambient_inside_times_kt = true; clamp_attenuation = true;"
        " truncate_material_colors = true; transmitting_surfaces_reflect = true; air_index = 1.1;"
        " pixel_sample = lower_left_corner; linear_output = true; max_depth = 9;"
        " min_contribution = 0.01 }");
    ASSERT_EQ(i.messages(), "");
    const ShadingConventions& c = i.scene.conventions;
    EXPECT_EQ(c.highlight, ShadingConventions::Highlight::Phong);
    EXPECT_EQ(c.shadow_tint, ShadingConventions::ShadowTint::Opaque);
    EXPECT_EQ(c.refraction_tint, ShadingConventions::RefractionTint::PerDistance);
    EXPECT_EQ(c.ambient_factor, ShadingConventions::AmbientFactor::Diffuse);
    EXPECT_TRUE(c.ambient_inside_times_kt && c.clamp_attenuation && c.truncate_material_colors &&
                c.transmitting_surfaces_reflect && c.linear_output);
    EXPECT_EQ(c.air_index, 1.1);
    EXPECT_EQ(c.pixel_sample, ShadingConventions::PixelSample::LowerLeftCorner);
    EXPECT_EQ(c.max_depth, 9);
    EXPECT_EQ(c.min_contribution, 0.01);
}

TEST(NativeImporter, ReadsMeshes) {
    const Imported i = import(
        "material \"a\" { } material \"b\" { }"
        "mesh { points = [(0,0,0),(1,0,0),(1,1,0),(0,1,0)]; faces = [[0,1,2,3]]; smooth = true;"
        " uvs = [(0,0),(1,0),(1,1),(0,1)]; vertex_materials = [\"a\",\"b\",\"a\",\"a\"] }");
    ASSERT_EQ(i.messages(), "");
    const TriangleMesh& mesh = *i.scene.meshes.at(0).mesh;
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.uvs.at(2), (Vec2{1, 1}));
    expect_near(mesh.normals.at(0), {0, 0, 1});
    EXPECT_EQ(mesh.vertex_materials, (std::vector<std::uint32_t>{0, 1, 0, 0}));
    EXPECT_TRUE(import("mesh { points = [(0,0,0)]; faces = [(0,0,7)] }").says("from 0 to 0"));
    EXPECT_EQ(import("mesh { points = [(0,0,0)]; faces = [(0,0,0)]; uvs = [] }").errors(), 1u);
    EXPECT_EQ(
        import("mesh { points = [(0,0,0)]; faces = [(0,0,0)]; normals = [(0,0,0)] }").errors(), 1u);
}

TEST(NativeImporter, ReadsMeshFilesAndReportsMissingOnes) {
    const Folder folder;
    folder.write("m/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Imported good =
        import_file(folder.write("a.alhazen", "alhazen 1 mesh { file = \"m/tri.obj\" }"));
    EXPECT_EQ(good.messages(), "");
    EXPECT_EQ(good.scene.meshes.at(0).mesh->triangles.size(), 1u);
    const Imported bad = import_file(
        folder.write("b.alhazen", "alhazen 1\nmesh {\n file = \"m/none.obj\"; material = \"x\" }"));
    EXPECT_EQ(bad.errors(), 2u) << bad.messages();
    EXPECT_TRUE(bad.says("b.alhazen:3:9: error: ")) << bad.messages();
    EXPECT_EQ(import("mesh { file = \"../x.obj\" }").errors(), 1u);
    EXPECT_EQ(import("mesh { file = \"/x.obj\" }").errors(), 1u);
    EXPECT_EQ(import("texture \"t\" { file = \"none.png\" }").errors(), 1u);
    EXPECT_EQ(import("texture \"t\" { }").errors(), 1u);
}

TEST(NativeImporter, IncludesFilesRelativeToTheIncludingOne) {
    const Folder folder;
    folder.write("parts/inner.alhazen", "alhazen 1 material \"m\" { diffuse = .3 } sphere { }");
    folder.write("parts/outer.alhazen",
                 "alhazen 1 include \"inner.alhazen\"; defaults { material = \"m\" }");
    const Imported i = import_file(
        folder.write("scene.alhazen", "alhazen 1 include \"parts/outer.alhazen\"\nbox { }"));
    EXPECT_EQ(i.messages(), "");
    ASSERT_EQ(i.parts().size(), 2u);
    EXPECT_EQ(material_of(i, 1).diffuse.color, (Rgb{.3, .3, .3}));
    EXPECT_EQ(i.parts()[0].location.file,
              (std::filesystem::path(i.scene.path).parent_path() / "parts/inner.alhazen").string());
}

TEST(NativeImporter, RefusesIncludesThatAreMissingOutsideOrCircular) {
    const Folder folder;
    folder.write("b.alhazen", "alhazen 1\n include \"a.alhazen\"");
    const Imported circle =
        import_file(folder.write("a.alhazen", "alhazen 1 include \"b.alhazen\" sphere { }"));
    EXPECT_EQ(circle.errors(), 1u);
    EXPECT_TRUE(circle.says("b.alhazen:2:10: error: include: the file includes itself"))
        << circle.messages();
    EXPECT_EQ(circle.parts().size(), 1u);
    EXPECT_EQ(import("include \"none.alhazen\"").errors(), 1u);
    EXPECT_EQ(import("include \"../x.alhazen\"").errors(), 1u);
    EXPECT_EQ(import("include \"/etc/passwd\"").errors(), 1u);
    EXPECT_EQ(import("include x").errors(), 2u);  // neither word is a block
    EXPECT_EQ(import("include \"x\" { }").errors(), 1u);
    folder.write("plain.txt", "hello");
    const Imported plain =
        import_file(folder.write("c.alhazen", "alhazen 1 include \"plain.txt\""));
    EXPECT_TRUE(plain.says("expected the header 'alhazen 1'")) << plain.messages();
}

TEST(NativeImporter, BoundsTheDepthCountAndSizeOfIncludedFiles) {
    const Folder folder;
    for (int k = 0; k < 15; ++k) {
        const std::string next = "include \"f" + std::to_string(k + 1) + ".alhazen\"\n";
        folder.write("f" + std::to_string(k) + ".alhazen", "alhazen 1\n" + next + next);
    }
    folder.write("f15.alhazen", "alhazen 1");
    const auto kind_of = [&](const ImportOptions& options) {
        try {
            (void)import_file(folder.write("s.alhazen", "alhazen 1 include \"f0.alhazen\""),
                              options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Render;
    };
    EXPECT_EQ(kind_of({.max_include_depth = 30}), ErrorKind::Resource);  // 2^15 files
    EXPECT_EQ(kind_of({.max_include_depth = 5}), ErrorKind::Resource);
    EXPECT_EQ(kind_of({.max_include_depth = 30, .max_included_bytes = 100}), ErrorKind::Resource);
}

TEST(NativeImporter, CountsNestingThroughIncludedFiles) {
    const Folder folder;
    std::string groups = "alhazen 1\n";
    for (int k = 0; k < 150; ++k) groups += "group {";
    std::string closers(150, '}');
    folder.write("b.alhazen", groups + "sphere { }" + closers);
    const Imported i =
        import_file(folder.write("a.alhazen", groups + "include \"b.alhazen\"" + closers));
    EXPECT_EQ(i.errors(), 1u) << i.messages();
    EXPECT_TRUE(i.says("nested deeper than 256"));
}

TEST(NativeImporter, ReadsTheDeepestNestingItAllows) {
    std::string text;
    for (int k = 0; k < 498; ++k) text += "group {";
    const Imported i =
        import(text + "sphere { }" + std::string(498, '}'), {.max_nesting = 1'000'000});
    EXPECT_EQ(i.messages(), "");
    EXPECT_EQ(i.parts().size(), 1u);
}

TEST(NativeImporter, ReportsEachMistakeOnceAndGoesOn) {
    const Imported i = import(
        "sphere { radius = \"x\" }\n"
        "box { lo = (1,2); hi = nan }\n"
        "disc { radius = 1e999 }\n"
        "plane { normal = (0,inf,1) }\n"
        "radius = 3\n"
        "picture { width = 0; height = 1.5 }\n"
        "group { camera { } }\n"
        "sphere { center = (1,2,3 }\n"
        "point_light { }\n"
        "sphere\n"
        "spot_light { position = (0,0,0); look_at = (0,0,0) }\n"
        "perspective_camera { eye = (0,0,0); direction = (0,1,0) }\n"
        "cylinder { }\n");
    EXPECT_EQ(i.errors(), 14u) << i.messages();
    for (int line = 2; line <= 13; ++line) {
        EXPECT_TRUE(i.says("scene.alhazen:" + std::to_string(line) + ":")) << line << i.messages();
    }
}

TEST(NativeImporter, RefusesWhatBelongsAtTheTop) {
    EXPECT_TRUE(import("object \"a\" { point_light { position = (0,0,0) } }")
                    .says("point_light belongs at the top level"));
    EXPECT_TRUE(import("group { picture { } }").says("picture belongs at the top level"));
    EXPECT_TRUE(import("group { colour = 1 }").says("group: unknown key 'colour'"));
}

TEST(NativeImporter, SurvivesEveryTruncationAndManyMutationsOfAScene) {
    const std::string scene =
        "alhazen 1 picture { width = 2 } material \"m\" { diffuse = (1,0,0) } "
        "perspective_camera { eye = (0,0,5); look_at = (0,0,0) } object \"o\" { sphere { material "
        "= "
        "\"m\" } } instance \"o\" { transform = [translate(1,2,3), rotate((0,0,1), 3)] } polygon { "
        "loops = [[(0,0,0),(1,0,0),(0,1,0)]] } mesh { points = [(0,0,0),(1,0,0),(0,1,0)]; faces = "
        "[(0,1,2)] } group { defaults { material = \"m\" } box { } } include \"x\"";
    for (std::size_t n = 0; n < scene.size(); ++n) {
        (void)testing::import_text<NativeImporter>(scene.substr(0, n), "a.alhazen");
    }
    std::mt19937 random(1021);
    const std::string bytes = "(){}[],;=\"x1-./*\n\xff";
    for (int round = 0; round < 2000; ++round) {
        std::string mutant = scene;
        for (int k = 0; k < 4; ++k) {
            mutant[random() % mutant.size()] = bytes[random() % bytes.size()];
        }
        SCOPED_TRACE(mutant);
        (void)testing::import_text<NativeImporter>(mutant, "a.alhazen");
    }
}

TEST(NativeImporter, MakesAValidSceneOfNothing) {
    Imported i = import("perspective_camera { eye = (0,0,0); direction = (1,0,0) }");
    validate(i.scene, i.diagnostics);
    EXPECT_EQ(i.errors(), 0u) << i.messages();
}

TEST(NativeImporter, StopsAtTheLimitOfElements) {
    std::string text;
    for (int k = 0; k < 200; ++k) text += "sphere { }";
    EXPECT_THROW((void)import(text, {.max_elements = 100}), Error);
}

}  // namespace
}  // namespace alhazen
