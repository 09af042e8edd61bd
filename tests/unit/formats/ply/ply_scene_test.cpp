/// PLY files as scenes, and extensions by other programs: colours, strips, extra lists.

#include <gtest/gtest.h>

#include <sstream>

#include "support/test_data.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_text;
using testing::mentions;
using testing::mesh_of;
using testing::text_of;

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "property list uchar int vertex_indices\n";

std::string header(const std::string& rest) {
    return "ply\nformat ascii 1.0\n" + rest + "end_header\n";
}
std::string square(const std::string& vertex_properties, const std::string& values) {
    return header("element vertex 4\n" + kXyz + vertex_properties + "element face 1\n" + kFaces) +
           "0 0 0 " + values + "\n1 0 0 " + values + "\n1 1 0 " + values + "\n0 1 0 " + values +
           "\n4 0 1 2 3\n";
}

TEST(PlyScene, IntegerColoursAreDecodedAndFloatsAreLinear) {
    Diagnostics found;
    const auto color = [&](const char* type, const char* names, const std::string& values) {
        std::string properties;
        std::istringstream list(names);
        for (std::string name; list >> name;) {
            properties += std::string("property ") + type + ' ' + name + '\n';
        }
        const TriangleMesh mesh = mesh_of(square(properties, values), "a.ply", found);
        return mesh.colors.empty() ? VertexColor{-1, -1, -1, -1} : mesh.colors[2];
    };
    const VertexColor coded = color("uchar", "red green blue alpha", "0 255 188 51");
    EXPECT_EQ(coded.r, 0.0f);
    EXPECT_EQ(coded.g, 1.0f);
    EXPECT_NEAR(coded.b, 0.50288, 1e-5);
    EXPECT_EQ(coded.a, 0.2f);
    EXPECT_EQ(color("uint8", "blue red green", "0 255 0"), (VertexColor{1, 0, 0, 1}));
    EXPECT_EQ(color("uchar", "diffuse_red diffuse_green diffuse_blue", "255 0 0"),
              (VertexColor{1, 0, 0, 1}));
    EXPECT_EQ(color("float", "red green blue alpha", "0.25 1 0 0.75"),
              (VertexColor{0.25f, 1, 0, 0.75f}));
    EXPECT_EQ(color("ushort", "red green blue", "65535 0 0"), (VertexColor{1, 0, 0, 1}));
    EXPECT_EQ(color("uchar", "red green blue", "256 -1 0"), (VertexColor{1, 0, 0, 1})) << "clamped";
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(color("uchar", "red green", "1 2"), (VertexColor{-1, -1, -1, -1}));
    EXPECT_EQ(text_of(found),
              "a.ply:3:1: warning: 'red' of a vertex is ignored: only all of red, green and blue "
              "have a meaning\n");
}

TEST(PlyScene, FloatColoursAboveWhiteAreKeptAndToldOf) {
    Diagnostics found;
    const TriangleMesh mesh = mesh_of(
        square("property float red\nproperty float green\nproperty double blue\n", "-0.5 2 0.25"),
        "a.ply", found);
    EXPECT_EQ(mesh.colors[2], (VertexColor{-0.5f, 2, 0.25f, 1}));
    EXPECT_TRUE(mentions(found,
                         "a.ply: warning: 4 of 4 vertices have colours outside of 0 to 1, "
                         "from -0.5 to 2: "))
        << text_of(found);
}

TEST(PlyScene, StripsOfTrianglesKeepTheirOrientation) {
    Diagnostics found;
    // Two rows of a grid joined by a repeated vertex, and a second strip.
    const TriangleMesh mesh =
        mesh_of(header("element vertex 6\n" + kXyz +
                       "element tristrips 1\nproperty list int int vertex_indices\n") +
                    "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n11 1 0 3 2 2 5 4 -1 0 1 2\n",
                "a.ply", found);
    EXPECT_EQ(text_of(found), "");
    ASSERT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{1, 0, 3}));
    EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{3, 0, 2}));
    for (std::size_t i = 0; i < 2; ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        EXPECT_GT(
            cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]).z,
            0.0);
    }
    Diagnostics bad;
    (void)mesh_of(header("element vertex 1\n" + kXyz +
                         "element tristrips 1\nproperty list int int vertex_indices\n") +
                      "0 0 0\n3 0 7 0\n",
                  "a.ply", bad);
    EXPECT_TRUE(mentions(bad, "tristrips 0: a vertex index outside the range")) << text_of(bad);
}

TEST(PlyScene, SeveralMistakesOfAnAsciiFileAreToldAtOnce) {
    Diagnostics found;
    std::string text = square("", "");
    text.replace(text.find("1 0 0"), 5, "1 x 0");
    text.replace(text.find("0 1 0"), 5, "0 1 y");
    text.replace(text.find("4 0 1"), 5, "4 0 9");
    EXPECT_TRUE(mesh_of(text, "a.ply", found).triangles.empty());
    EXPECT_EQ(found.error_count(), 3u) << text_of(found);
    EXPECT_TRUE(mentions(found, "vertex 1: expected a number, found 'x'"));
    EXPECT_TRUE(mentions(found, "vertex 3: expected a number, found 'y'"));
    EXPECT_TRUE(mentions(found, "face 0: a vertex index"));
}

TEST(PlyScene, WhatOnlyFacesHaveIsIgnoredWithAWarning) {
    Diagnostics found;
    const TriangleMesh mesh =
        mesh_of(header("element vertex 3\n" + kXyz + "element face 1\n" + kFaces +
                       "property list uchar float texcoord\nproperty uchar red\n") +
                    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 255\n",
                "a.ply", found);
    EXPECT_EQ(mesh.triangles.size(), 1u) << text_of(found);
    EXPECT_EQ(found.warning_count(), 2u);
    EXPECT_TRUE(mentions(found, "'texcoord' of a face is ignored"));
}

TEST(PlyScene, AScenesMeshIsWhiteBelowItsColours) {
    Diagnostics found;
    const SceneDescription plain = import_text(square("", ""), "my.ply", found);
    EXPECT_EQ(plain.format, "ply") << text_of(found);
    EXPECT_EQ(plain.meshes.at(0).name, "my");
    EXPECT_EQ(plain.materials.at(0).material.diffuse.color, (Rgb{.7, .7, .7}));
    const SceneDescription colored = import_text(
        square("property uchar red\nproperty uchar green\nproperty uchar blue\n", "1 2 3"),
        "my.ply", found);
    EXPECT_EQ(colored.materials.at(0).material.diffuse.color, (Rgb{1, 1, 1}));
}

TEST(PlyScene, PointsWithoutFacesAreAnErrorThatCountsThem) {
    Diagnostics found;
    (void)import_text(header("element vertex 2\n" + kXyz) + "0 0 0\n1 1 1\n", "a.ply", found);
    EXPECT_TRUE(mentions(found, "2 points but no faces")) << text_of(found);
    for (const char* bad : {"", "ply", "ply\n", "ply\nformat ascii 1.0\nend_header\n"}) {
        Diagnostics more;
        (void)import_text(bad, "a.ply", more);
        EXPECT_GT(more.error_count(), 0u) << bad;
    }
}

TEST(PlyScene, ANumberOfAMaterialIsOnlyReadFromOurOwnFiles) {
    Diagnostics found;
    std::string text = square("property uint vertex_material\n", "7");
    EXPECT_TRUE(mesh_of(text, "a.ply", found).vertex_materials.empty());
    text.insert(text.find("element"), "comment alhazen exact\n");
    EXPECT_EQ(mesh_of(text, "a.ply", found).vertex_materials.size(), 4u);
    EXPECT_TRUE(import_text(text, "a.ply", found).meshes.at(0).mesh->vertex_materials.empty());
    EXPECT_EQ(text_of(found), "");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
