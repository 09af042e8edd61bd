/// Shapes, transforms, materials, meshes and instances of the native format.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "alhazen/formats/native/read/native_shapes.h"
#include "alhazen/math/constants.h"
#include "native_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;
using testing::import_native;
using testing::Imported;
using testing::material_of;
using testing::shape_of;

TEST(NativeImporter, CallsABentPolygonAPolygonInItsErrors) {
    const std::string bent = "polygon { vertices = [(0,0,0), (2,0,0), (2,2,.5), (0,2,0)] }";
    const auto checked = [](const std::string& text) {
        Imported i = import_native(text);
        validate(i.scene, i.diagnostics);
        return i;
    };
    for (const std::string& text :
         {"union { box {} " + bent + " }",
          "object \"o\" { box {} " + bent + " } union { sphere {} instance \"o\" { } }"}) {
        const Imported i = checked(text);
        EXPECT_EQ(i.errors(), 1u) << i.messages();
        EXPECT_NE(i.messages().find("polygon bounds no volume, so it cannot be part of a solid"),
                  std::string::npos)
            << i.messages();
    }
    const Imported far =
        checked("polygon { vertices = [(0,0,0), (2e71,0,0), (2e71,2e71,1e70), (0,2e71,0)] }");
    EXPECT_NE(far.messages().find("polygon: each vertex must be three finite numbers below 1e70"),
              std::string::npos)
        << far.messages();
    EXPECT_EQ(far.messages().find("mesh"), std::string::npos) << far.messages();
}

TEST(NativeImporter, ReadsPolygonsWithCornersOffThePlaneAsTriangles) {
    const auto bent = [](const char* off) {
        return import_native("polygon \"p\" { vertices = [(0,0,0), (2,0,0), (2,2," +
                             std::string(off) + "), (0,2,0)] }");
    };
    // A bow tie, whose plane is not Newell's.
    const Imported tie =
        import_native("polygon { vertices = [(0,0,0), (2,2,0), (2,0,1e-9), (0,2,0)] }");
    EXPECT_EQ(tie.messages(), "");
    EXPECT_NEAR(std::abs(shape_of<Polygon>(tie, 0).vertices[1].x), 2, 0);
    const Imported flat = bent("1e-4");
    EXPECT_EQ(flat.messages(), "");
    EXPECT_EQ(shape_of<Polygon>(flat, 0).vertices.size(), 4u);
    const Imported cut = bent("0.4");
    EXPECT_NE(
        cut.messages().find("warning: polygon: its corners are not in a plane, but up to 0.0"),
        std::string::npos)
        << cut.messages();
    EXPECT_NE(cut.messages().find("read as triangles"), std::string::npos);
    const Part& part = cut.scene.objects[0].parts.at(0);
    EXPECT_EQ(part.name, "p");
    ASSERT_TRUE(std::holds_alternative<MeshIndex>(part.what));
    const TriangleMesh& mesh = *cut.scene.meshes.at(0).mesh;
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.positions[2], (Vec3{2, 2, 0.4}));
    EXPECT_EQ(mesh.uvs[0], (Vec2{0, 0}));
    EXPECT_GT(mesh.uvs[2].x, 1.9);
    EXPECT_GT(mesh.uvs[2].y, 1.9);
    // One that crosses itself stays what it is: triangles on its corners cover more.
    const Imported bow =
        import_native("polygon { vertices = [(-1,-1,0), (1,1,0), (1,-1,0), (-1,1,0.01)] }");
    EXPECT_NE(bow.messages().find("mean plane"), std::string::npos) << bow.messages();
    EXPECT_EQ(shape_of<Polygon>(bow, 0).vertices.size(), 4u);
    // A corner written twice, or again at the end, is one.
    const Imported closed = import_native(
        "polygon { vertices = [(0,0,0), (2,0,0), (2,1,.1), (2,1,.1), (1,1,0), (1,2,0), (0,2,0), "
        "(0,0,0)] }");
    EXPECT_NE(closed.messages().find("read as triangles"), std::string::npos) << closed.messages();
    EXPECT_EQ(closed.scene.meshes.at(0).mesh->triangles.size(), 4u);
    // Triangles are those of the loop as seen along the normal: here it crosses itself along z.
    const Imported steep = import_native(
        "polygon { vertices = [(-.8,-1,.6), (.8,-1,-.6), (-.84,0,.38), (.8,1,-.6), (-.8,1,.6)] }");
    Vec3 whole;
    double seen = 0;  // along the normal
    const TriangleMesh& folded = *steep.scene.meshes.at(0).mesh;
    const auto twice_area = [&](const std::array<std::uint32_t, 3>& t) {
        const Vec3& a = folded.positions[t[0]];
        return cross(folded.positions[t[1]] - a, folded.positions[t[2]] - a);
    };
    for (const auto& t : folded.triangles) whole += twice_area(t);
    for (const auto& t : folded.triangles) seen += std::abs(dot(twice_area(t), normalize(whole)));
    EXPECT_NEAR(seen, length(whole), 1e-12);
    // A star of more corners than can be tested stays what it is.
    std::string star = "polygon { vertices = [";
    for (int i = 0; i < 20003; ++i) {
        const double turn = 2 * kPi * i * 10000 / 20003;
        star += (i == 0 ? "(" : ", (") + std::to_string(std::cos(turn)) + "," +
                std::to_string(std::sin(turn)) + (i == 0 ? ",0.1)" : ",0)");
    }
    const Imported refused = import_native(star + "] }");
    EXPECT_NE(refused.messages().find("mean plane"), std::string::npos) << refused.messages();
    // With a hole it stays what it is, too.
    const Imported loops = import_native(
        "polygon { loops = [[(0,0,0), (4,0,0), (4,4,1), (0,4,0)], [(1,1,0), (2,1,0), (1,2,0)]] }");
    EXPECT_NE(loops.messages().find("mean plane"), std::string::npos);
    EXPECT_EQ(shape_of<Polygon>(loops, 0).loop_ends.size(), 2u);
}

TEST(NativeImporter, ReadsPolygonLightsWithCornersOffThePlaneAsTriangles) {
    const auto light_of = [](const Imported& found) {
        return std::get<AreaLight>(found.scene.lights.at(0).light);
    };
    const auto read = [](const std::string& vertices) {
        return import_native("polygon_light { vertices = [" + vertices + "]; power_watts = 6 }");
    };
    const Imported flat = read("(-1,-1,2), (-1,1,2), (1,1,2.0001), (1,-1,2)");
    EXPECT_EQ(flat.messages(), "");
    EXPECT_TRUE(std::holds_alternative<PolygonExtent>(light_of(flat).extent));
    const Imported bent = read("(-1,-1,2), (-1,1,2), (1,1,3), (1,-1,2)");
    EXPECT_NE(bent.messages().find("warning: polygon_light: its corners are not in a plane, but"),
              std::string::npos);
    EXPECT_NE(bent.messages().find("read as triangles"), std::string::npos);
    // The same light as a mesh: of the same power, thus radiance.
    const AreaLight mesh =
        light_of(import_native("mesh_light { points = [(-1,-1,2), (-1,1,2), (1,1,3), (1,-1,2)]\n"
                               "  faces = [(0,1,2,3)]; power_watts = 6 }"));
    const AreaLight light = light_of(bent);
    const auto& triangles = std::get<MeshExtent>(light.extent);
    EXPECT_EQ(triangles.points, std::get<MeshExtent>(mesh.extent).points);
    EXPECT_EQ(triangles.triangles.size(), 2u);
    EXPECT_NEAR(light.radiance.r, mesh.radiance.r, 0.05 * mesh.radiance.r);
    // It emits to the same side.
    const Vec3 down = LightSurface(light.extent, false).projected_area({0, 0, -1}) > 0
                          ? Vec3{0, 0, -1}
                          : Vec3{0, 0, 1};
    EXPECT_GT(LightSurface(mesh.extent, false).projected_area(down), 0.0);
    // One that crosses itself is in the mean plane.
    const Imported bow = read("(-1,-1,0), (1,1,0), (1,-1,0), (-1,1,0.01)");
    EXPECT_NE(bow.messages().find("mean plane"), std::string::npos) << bow.messages();
    Polygon plane;
    const AreaLight tie_light = light_of(bow);
    plane.vertices = std::get<PolygonExtent>(tie_light.extent).vertices;
    ASSERT_EQ(plane.vertices.size(), 4u);
    plane.prepare();
    EXPECT_LT(plane.off_plane, 1e-12);
}

TEST(NativeImporter, ReadsEveryFieldOfEveryShape) {
    const Imported i = import_native(
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
        const Imported i = import_native(std::string(name) + " { transform = scale(2) }");
        // Those whose form has no default.
        const bool must_be_told = name == "polygon" || name == "polyhedron" || name == "prism" ||
                                  name == "lathe" || name == "blob" || name == "height_field";
        EXPECT_EQ(i.errors(), must_be_told ? 1u : 0u) << i.messages();
        EXPECT_EQ(i.parts().size(), 1u);
    }
}

TEST(NativeImporter, AppliesAListOfTransformsInTheWrittenOrder) {
    const Imported i = import_native(
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
        const Imported i = import_native(std::string("sphere { transform = ") + bad + " }");
        EXPECT_EQ(i.errors(), 1u) << bad << "\n" << i.messages();
    }
}

TEST(NativeImporter, ReadsMaterialsByNameInlineAndByDefault) {
    const Imported i = import_native(
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
    const Imported i = import_native(
        "material \"red\" { } material \"blue\" { } sphere {\n material = \"green\" }");
    EXPECT_EQ(i.errors(), 1u);
    EXPECT_TRUE(
        i.says("scene.alhazen:3:13: error: material \"green\" is not defined; defined are "
               "blue, red"))
        << i.messages();
    EXPECT_TRUE(import_native("sphere {\n raduis = 1 }")
                    .says("scene.alhazen:3:2: error: sphere: unknown key 'raduis'; known are "
                          "transform, motion, visible_to, center, radius, material"));
    EXPECT_TRUE(import_native("patch_mesh { zzz = 1 }").says("patches, file, material"));
    EXPECT_TRUE(import_native("height_field { zzz = 1; file = \"x\" }")
                    .says("heights, columns, file, low, high, material"));
    EXPECT_TRUE(import_native("sphare { }").says("unknown block 'sphare'; known are picture"));
    EXPECT_TRUE(
        import_native("conventions { highlight = gloss }").says("one of phong, blinn_phong"));
    EXPECT_TRUE(import_native("sphere { radius = 1; radius = 2 }").says("given twice"));
    EXPECT_TRUE(import_native("material \"a\" { } material \"a\" { }").says("already defined"));
    EXPECT_TRUE(
        import_native("instance \"x\";").says("object \"x\" is not defined before its use"));
}

TEST(NativeImporter, NamesWhatUsersOfOtherProgramsLeaveOut) {
    for (const char* text :
         {"sphere { radius 2 }", "sphere { center (1, 2, 3) }", "sphere { radius }",
          "sphere { material \"m\" }", "sphere { material { } }"}) {
        const Imported i = import_native(text);
        const std::string key = std::string(text).substr(9, std::string(text).find(' ', 9) - 9);
        EXPECT_EQ(i.errors(), 1u) << i.messages();
        EXPECT_TRUE(i.says("sphere: expected '=' after '" + key + "'")) << i.messages();
    }
    EXPECT_TRUE(import_native("sphere { radus 2 }").says("sphere: unexpected 'radus ...'"));
    for (const char* text : {"material red { diffuse = 1 }", "union red { sphere { } }",
                             "instance red;", "group { object red { } }"}) {
        const Imported i = import_native(text);
        const std::size_t name = std::string(text).find("red");
        EXPECT_EQ(i.errors(), 1u) << i.messages();
        EXPECT_TRUE(i.says("names are in quotes: ")) << i.messages();
        EXPECT_TRUE(i.says(":2:" + std::to_string(name + 1) + ": ")) << i.messages();
    }
    EXPECT_TRUE(import_native("material red { }").says("names are in quotes: material \"red\""));
    EXPECT_TRUE(import_native("union sphere { }").says("expected a block such as sphere { }"));
    EXPECT_TRUE(import_native("height_field { file = \"x\"; columns = 2 }")
                    .says("'columns' needs 'heights'"));
    EXPECT_TRUE(import_native("height_field { columns = 2; heights = [1, 2, 3, 4]; low = 0 }")
                    .says("'low' needs 'file'"));
    EXPECT_TRUE(import_native("sphere_light { center = (0,0,0); radius = 1 }")
                    .says("'radiance = ...', 'power_watts = ...' or 'lumens = ...' is missing"));
}

TEST(NativeImporter, InstancesObjectsInsteadOfCopyingThem) {
    const Imported i = import_native(
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
    EXPECT_TRUE(
        import_native("object \"a\" { instance \"a\"; }").says("object \"a\" is not defined"));
}

TEST(NativeImporter, GeometriesArePlacedByName) {
    const Imported i = import_native(
        "material \"red\" { }"
        "geometry \"tent\" { points = [(0,0,0), (1,0,0), (0,1,0)]; faces = [(0,1,2)] }"
        "mesh \"a\" { geometry = \"tent\" }"
        "mesh { geometry = \"tent\"; transform = scale(2); material = \"red\" }");
    ASSERT_EQ(i.messages(), "");
    ASSERT_EQ(i.scene.meshes.size(), 1U);
    EXPECT_EQ(i.scene.meshes[0].name, "tent");
    ASSERT_EQ(i.parts().size(), 2U);
    EXPECT_EQ(std::get<MeshIndex>(i.parts()[1].what), MeshIndex{0});
    EXPECT_TRUE(import_native("mesh { geometry = \"tent\" }").says("not defined"));
    EXPECT_TRUE(import_native("mesh { geometry = 5 }").says("the name of a geometry"));
    EXPECT_TRUE(import_native("geometry { points = []; faces = [] }").says("expected a name"));
}

TEST(NativeImporter, TheListOfObjectsNumbersThem) {
    const Imported i = import_native(
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
    EXPECT_TRUE(
        import_native("objects { names = [\"a\", \"b\"]; root = \"a\" }").says("not defined"));
    EXPECT_TRUE(import_native(
                    "objects { names = [\"a\", \"c\"]; root = \"b\" } object \"c\" { } sphere { }")
                    .says("one of the names"));
    EXPECT_TRUE(
        import_native("objects { names = []; root = \"b\" } object \"b\" { }").says("is empty"));
    EXPECT_TRUE(
        import_native("objects { names = [\"a\", \"a\"]; root = \"a\" }").says("already defined"));
    EXPECT_TRUE(
        import_native("sphere { } objects { names = [\"a\"]; root = \"a\" }").says("before"));
    EXPECT_TRUE(import_native("objects { names = [\"a\"]; root = \"a\" } object \"a\" { }")
                    .says("already defined"));
}

TEST(NativeImporter, ReadsMetallicRoughnessAndAlpha) {
    const Imported i = import_native(
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
    EXPECT_TRUE(
        import_native("material \"m\" { metallic_roughness = 5 }").says("expected a block"));
    EXPECT_TRUE(import_native("material \"m\" { normal_map = 5 }").says("texture(\"NAME\")"));
    EXPECT_TRUE(
        import_native("material \"m\" { metallic_roughness = { metal = 5 } }").says("unknown key"));
}

TEST(NativeImporter, ReadsMeshes) {
    const Imported i = import_native(
        "material \"a\" { } material \"b\" { }"
        "mesh { points = [(0,0,0),(1,0,0),(1,1,0),(0,1,0)]; faces = [[0,1,2,3]]; smooth = true;"
        " uvs = [(0,0),(1,0),(1,1),(0,1)]; vertex_materials = [\"a\",\"b\",\"a\",\"a\"] }");
    ASSERT_EQ(i.messages(), "");
    const TriangleMesh& mesh = *i.scene.meshes.at(0).mesh;
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.uvs.at(2), (Vec2{1, 1}));
    expect_near(mesh.normals.at(0), {0, 0, 1});
    EXPECT_EQ(mesh.vertex_materials, (std::vector<std::uint32_t>{0, 1, 0, 0}));
    EXPECT_TRUE(
        import_native("mesh { points = [(0,0,0)]; faces = [(0,0,7)] }").says("from 0 to 0"));
    EXPECT_EQ(import_native("mesh { points = [(0,0,0)]; faces = [(0,0,0)]; uvs = [] }").errors(),
              1u);
    EXPECT_EQ(import_native("mesh { points = [(0,0,0)]; faces = [(0,0,0)]; normals = [(0,0,0)] }")
                  .errors(),
              1u);
}

TEST(NativeObjects, NormalsMayHaveAnyLength) {
    for (const std::string size : {"e-320", "e-200", "e200", "e307"}) {
        const Imported i = import_native(
            "mesh { points = [(0,0,0), (1,0,0), (0,1,0)]; faces = [(0,1,2)]; normals = [(3" + size +
            ", 0, 4" + size + "), (0,0,1), (0,0,1)] }");
        ASSERT_EQ(i.messages(), "") << size;
        const Vec3& normal = i.scene.meshes.at(0).mesh->normals.at(0);
        const double error = size == "e-320" ? 1e-3 : 1e-15;
        EXPECT_NEAR(normal.x, 0.6, error) << size;
        EXPECT_NEAR(normal.z, 0.8, error) << size;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
