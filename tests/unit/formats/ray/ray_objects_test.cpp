/// Transforms, solids, materials and meshes of .ray files.

#include <gtest/gtest.h>

#include <cmath>

#include "ray_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;
using testing::import_ray;
using testing::Imported;
using testing::kSquareMesh;
using testing::material_of;

TEST(RayImporter, SmallShininessDecidesNothingWhereTheTokenFamilySpellsItself) {
    const std::string material = "sphere { material = { shininess = 0.2; } }\n";
    using ShadowTint = ShadingConventions::ShadowTint;
    EXPECT_EQ(import_ray(material).scene.conventions.shading.shadow_tint, ShadowTint::PerCrossing);
    const std::string mesh =
        "polymesh { points = ((0,0,0),(1,0,0),(0,1,0)); faces = ((0,1,2)); gennormals; }\n";
    EXPECT_EQ(import_ray(material + mesh).scene.conventions.shading.shadow_tint,
              ShadowTint::PerDistance);
}

TEST(RayImporter, MultipliesTransformsFromTheOutsideIn) {
    const Imported i = import_ray(
        "translate(1,2,3, rotate(0,0,1, 1.5707963267948966, scale(2, translate(1,0,0, "
        "sphere{}))))");
    ASSERT_EQ(i.parts().size(), 1u) << i.messages();
    expect_near(i.parts()[0].object_from_part.point({0, 0, 0}), {1, 4, 3});
    expect_near(i.parts()[0].object_from_part.point({1, 0, 0}), {1, 6, 3});
}

TEST(RayImporter, TakesTheRowsOfAMatrix) {
    const Imported i = import_ray("transform((1,2,3,4),(0,1,5,6),(0,0,1,7),(0,0,0,1), box{})");
    expect_near(i.parts().at(0).object_from_part.point({1, 1, 1}), {10, 12, 8});
    EXPECT_TRUE(
        import_ray("transform((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,1,1), box{})").says("last row"));
}

TEST(RayImporter, DividesRoundedMatricesByTheirLastNumberAndSaysSoOnce) {
    const std::string rounded = "transform((2,0,0,4),(0,2,0,0),(0,0,2,0),(9e-10,0,0,2), box{})";
    const Imported i = import_ray(rounded + rounded);
    expect_near(i.parts().at(1).object_from_part.point({1, 1, 1}), {3, 1, 1});
    EXPECT_TRUE(i.says("warning: transform: the last row is rounded"));
    EXPECT_EQ(i.diagnostics.all().size(), 1u) << i.messages();
}

TEST(RayImporter, GivesTheSolidsTheSizesOfTheFormat) {
    const Imported i = import_ray(
        "sphere{} box{} square{} cylinder{} cone{}"
        "cone{ height = -2; bottom_radius = -.5; top_radius = .25; capped = false }");
    ASSERT_EQ(i.parts().size(), 6u) << i.messages();
    EXPECT_EQ(std::get<Sphere>(std::get<AnyShape>(i.parts()[0].what)).radius, 1);
    EXPECT_EQ(std::get<BoxShape>(std::get<AnyShape>(i.parts()[1].what)).lo, (Vec3{-.5, -.5, -.5}));
    EXPECT_EQ(std::get<Rectangle>(std::get<AnyShape>(i.parts()[2].what)).corner,
              (Vec3{-.5, -.5, 0}));
    EXPECT_EQ(std::get<Cylinder>(std::get<AnyShape>(i.parts()[3].what)).top, (Vec3{0, 0, 1}));
    const auto& cone = std::get<Cone>(std::get<AnyShape>(i.parts()[5].what));
    EXPECT_EQ(cone.top, (Vec3{0, 0, -2}));
    EXPECT_EQ(cone.base_radius, .5);
    EXPECT_EQ(cone.top_radius, .25);
    EXPECT_FALSE(cone.capped);
}

TEST(RayImporter, CarriesADefaultMaterialOnAndBackOutOfAGroup) {
    const Imported i = import_ray(
        "material = { diffuse = (1,0,0); shininess = 9 }"
        "sphere {}"
        "{ material = { specular = (0,1,0) } sphere {} }"
        "translate(1,0,0, { material = { diffuse = (0,0,1) } sphere {} })"
        "sphere { material = { ambient = (1,1,1) } }"
        "sphere {}");
    ASSERT_EQ(i.parts().size(), 5u) << i.messages();
    EXPECT_EQ(material_of(i, 0).diffuse.color, (Rgb{1, 0, 0}));
    EXPECT_EQ(material_of(i, 1).diffuse.color, (Rgb{1, 0, 0}));
    EXPECT_EQ(material_of(i, 1).specular.color, (Rgb{0, 1, 0}));
    EXPECT_EQ(material_of(i, 2).diffuse.color, (Rgb{0, 0, 1}));
    EXPECT_EQ(material_of(i, 3).shininess.value, 9);
    EXPECT_EQ(material_of(i, 4).specular.color, (Rgb{}));
    EXPECT_EQ(material_of(i, 4).ambient.color, (Rgb{}));
}

TEST(RayImporter, FindsMaterialsByNameInBothSpellings) {
    const Imported i = import_ray(
        "material = { name red; diffuse = (1,0,0) } "
        "material { name = \"#2\"; diffuse = (0,1,0); } "
        "sphere { material = \"#2\" } sphere { material = red } sphere { }");
    ASSERT_EQ(i.parts().size(), 3u) << i.messages();
    EXPECT_EQ(i.errors(), 0u) << i.messages();
    EXPECT_EQ(material_of(i, 0).diffuse.color, (Rgb{0, 1, 0}));
    EXPECT_EQ(material_of(i, 1).diffuse.color, (Rgb{1, 0, 0}));
    EXPECT_EQ(i.parts()[1].material, i.parts()[2].material);
}

TEST(RayImporter, AGroupMayFollowTheNameOfAMaterialWithoutASemicolon) {
    const Imported i = import_ray(
        "material = { name red; diffuse = (1,0,0) } material = { diffuse = (0,1,0) } "
        "material = red { sphere {} { material = red { box {} } } } square {}");
    EXPECT_EQ(i.messages(), "");
    ASSERT_EQ(i.parts().size(), 3u);
    for (std::size_t part = 0; part < 3; ++part) {
        EXPECT_EQ(material_of(i, part).diffuse.color, (Rgb{1, 0, 0})) << part;
    }
}

TEST(RayImporter, ReportsUndefinedAndRepeatedNames) {
    const Imported i = import_ray("material = { name red; } sphere { material = blue }");
    EXPECT_TRUE(i.says("scene.ray:2:46: error: material 'blue' is not defined; defined are red"))
        << i.messages();
    EXPECT_TRUE(import_ray("material = { name red; } material = { name red; }")
                    .says("'red' is already defined in line 2"));
}

TEST(RayImporter, ListsTheFirstOfManyNames) {
    std::string text;
    for (int k = 1000; k < 2000; ++k) text += "material = { name m" + std::to_string(k) + "; } ";
    const Imported i = import_ray("material = { name " + std::string(200, 'a') + "; } " + text +
                                  "sphere { material = x }");
    EXPECT_TRUE(i.says("defined are " + std::string(60, 'a') + ", m1000, m1001,"));
    EXPECT_TRUE(i.says("m1017, m1018, ...\n")) << i.messages();
    EXPECT_FALSE(i.says("m1019"));
}

TEST(RayImporter, KeepsAWrittenReflectiveWhateverTheSpecular) {
    const Imported i = import_ray(
        "sphere { material = { reflective = (0,0,0); specular = (.5,.5,.5); shininess = .2 } }");
    EXPECT_EQ(material_of(i, 0).reflective.color, (Rgb{}));
}

TEST(RayImporter, MakesFansOfPolygons) {
    const Imported i = import_ray(std::string("polymesh { ") + kSquareMesh + " gennormals; }");
    ASSERT_EQ(i.scene.meshes.size(), 1u) << i.messages();
    const TriangleMesh& mesh = *i.scene.meshes[0].mesh;
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    ASSERT_EQ(mesh.normals.size(), 4u);
    expect_near(mesh.normals[0], {0, 0, 1});
}

// As in the programs of the course: the area of a face does not count.
TEST(RayImporter, OfTwoGennormalsTheLastCountsWithAWarning) {
    const auto read = [](const std::string& items) {
        return import_ray(std::string("polymesh { ") + kSquareMesh + items + " }");
    };
    for (const char* off :
         {"gennormals; gennormals = false;", "gennormals = true; gennormals = false;"}) {
        const Imported i = read(off);
        EXPECT_TRUE(i.scene.meshes.at(0).mesh->normals.empty()) << off;
        EXPECT_TRUE(i.says("warning: polymesh: 'gennormals' is given twice")) << i.messages();
        EXPECT_EQ(i.diagnostics.all().size(), 1U) << i.messages();
    }
    const Imported on = read("gennormals = false; gennormals;");
    EXPECT_EQ(on.scene.meshes.at(0).mesh->normals.size(), 4U);
    EXPECT_TRUE(on.says("warning: polymesh: 'gennormals' is given twice"));
    EXPECT_EQ(read("gennormals;").messages(), "");
    EXPECT_EQ(read("gennormals = true").messages(), "");
}

TEST(RayImporter, GeneratedNormalsAreMeansOfUnitNormals) {
    const Imported i = import_ray(
        "trimesh { points = ((0,0,0),(1,0,0),(0,9,0),(0,0,1)); faces = ((0,1,2),(0,3,1),(0,0,1)); "
        "gennormals; }");
    ASSERT_EQ(i.scene.meshes.size(), 1u) << i.messages();
    // Its faces' normals are z, y and none.
    expect_near(i.scene.meshes[0].mesh->normals.at(0), Vec3{0, 0.5, 0.5});
    expect_near(i.scene.meshes[0].mesh->normals.at(2), Vec3{0, 0, 1});
}

TEST(RayImporter, NormalsKeepTheLengthsWithWhichTheyAreInterpolated) {
    const Imported i = import_ray(
        "trimesh { points = ((0,0,0),(1,0,0),(0,1,0)); faces = ((0,1,2)); "
        "normals = ((3,0,0),(0,0,1),(0,0,1)); }");
    ASSERT_EQ(i.errors(), 0u) << i.messages();
    const ShapeSurface surface = i.scene.meshes.at(0).mesh->surface(0, {1, 0, 0.5, 0});
    expect_near(surface.shading_normal, Vec3{3, 0, 1} / std::sqrt(10.0));
}

TEST(RayImporter, ReadsNormalsAndMaterialsAtTheVertices) {
    const Imported i = import_ray(
        std::string("material = { name a; diffuse = (1,0,0) } trimesh { ") + kSquareMesh +
        "normals = ((0,0,2),(0,0,2),(0,0,2),(0,2,0)); "
        "materials = (a, { diffuse = (0,1,0) }, a, a); }");
    ASSERT_EQ(i.errors(), 0u) << i.messages();
    const TriangleMesh& mesh = *i.scene.meshes.at(0).mesh;
    expect_near(mesh.normals.at(3), {0, 2, 0});
    ASSERT_EQ(mesh.vertex_materials.size(), 4u);
    EXPECT_EQ(mesh.vertex_materials[0], mesh.vertex_materials[2]);
    EXPECT_EQ(i.scene.materials[mesh.vertex_materials[1]].material.diffuse.color, (Rgb{0, 1, 0}));
}

/// The materials of the programs: the dictionary family starts from none, the token family from the
/// mesh's own or, if that is written after them, from the one around it.
TEST(RayImporter, MaterialsOfVerticesStartWhereTheFamilySays) {
    const auto emission = [](const std::string& before, const std::string& items) {
        const Imported i = import_ray(before + " trimesh { " + kSquareMesh + items + " }");
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        const TriangleMesh& mesh = *i.scene.meshes.at(0).mesh;
        return i.scene.materials[mesh.vertex_materials.at(1)].material.emission.color;
    };
    const std::string each = "materials = ({},{ ambient = (0,0,0); },{},{});";
    const std::string red = "material = { emissive = (.3,0,0); };";
    const std::string named = "material { name = \"red\"; emissive = (.3,0,0); }";
    EXPECT_EQ(emission(named, "material = \"red\"; " + each), (Rgb{}));
    EXPECT_EQ(emission("", red + each), (Rgb{.3, 0, 0}));
    const std::string around = "material = { emissive = (0,.2,0); }";
    EXPECT_EQ(emission(around, red + each), (Rgb{.3, 0, 0}));
    EXPECT_EQ(emission(around, each + red), (Rgb{0, .2, 0}));
    EXPECT_EQ(emission(around, each), (Rgb{0, .2, 0}));
}

TEST(RayImporter, ReportsBadValuesOfObjectsOnceWhereTheyStand) {
    Imported i = import_ray(
        "cone {\n  height = 0; }\n"
        "sphere { material = { emissive = (1,1,-1);\n  shininess = -5;\n  index = -1 } }");
    validate(i.scene, i.diagnostics);
    EXPECT_EQ(i.errors(), 4u) << i.messages();
    EXPECT_TRUE(i.says("scene.ray:3:12: error: cone: height must be")) << i.messages();
    EXPECT_TRUE(i.says("scene.ray:4:34: error: material: emissive must not be negative"))
        << i.messages();
    EXPECT_TRUE(i.says("scene.ray:5:15: error: material: shininess must not be negative"));
    EXPECT_TRUE(i.says("scene.ray:6:11: error: material: index must not be negative"));
    const Imported down = import_ray("cone { height = -2; }");
    EXPECT_EQ(down.errors(), 0u) << down.messages();
}

TEST(RayImporter, ReportsEveryBadIndexOfAMesh) {
    const Imported i = import_ray(
        "trimesh { points = ((0,0,0),(1,0,0),(1,1,0));\n"
        " faces = ((0,1,3),(0,1,-1),(0,1,.5),(0,1),(0,1,x),(0,1,2)); }");
    EXPECT_EQ(i.errors(), 5u) << i.messages();
    EXPECT_TRUE(
        i.says("scene.ray:3:16: error: faces: a vertex number must be a whole number "
               "from 0 to 2"))
        << i.messages();
    EXPECT_TRUE(i.scene.meshes.empty());
    EXPECT_EQ(import_ray("trimesh { faces = ((0,1,2)); points = ((0,0,0)) }").errors(), 1u);
    EXPECT_EQ(import_ray("trimesh { }").errors(), 2u);
    EXPECT_EQ(
        import_ray(std::string("trimesh { ") + kSquareMesh + "normals = ((0,0,1)); }").errors(),
        1u);
    EXPECT_EQ(import_ray(std::string("trimesh { ") + kSquareMesh + "materials = ({}); }").errors(),
              1u);
}

TEST(RayObjects, EmptyListsOfNormalsAndMaterialsAreAsNone) {
    const Imported i =
        import_ray(std::string("trimesh { ") + kSquareMesh + "normals = (); materials = (); }");
    EXPECT_EQ(i.messages(), "");
    ASSERT_EQ(i.scene.meshes.size(), 1u);
    EXPECT_TRUE(i.scene.meshes[0].mesh->normals.empty());
    EXPECT_TRUE(i.scene.meshes[0].mesh->vertex_materials.empty());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
