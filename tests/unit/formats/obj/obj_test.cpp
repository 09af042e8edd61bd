#include <gtest/gtest.h>

#include <random>

#include "support/test_data.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mentions;
using testing::mesh_of;
using testing::text_of;

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, AllFormsOfAFaceAreRead) {
    const std::string more = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\n";
    for (const char* face :
         {"f 1 2 3 4", "f 1/1 2/2 3/3 4/4", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/2/1 3/3/1 4/4/1",
          "f -4 -3 -2 -1", "f -4/-4/-1 -3/-3/-1 3/3/1 4/4/1", "f 1 2 \\\n 3 4", "f 1 2 \\ \t\n 3 4",
          "f 1 2 3\\\n 4", "f 1/1/1\\ \n2/2/1 3/3/1\\\r\n 4/4/1", "f 1 2 3 4 \\", "f 1 2 3 4\\",
          "f 1/ 2/ 3/ 4/", "  f\t1 2 3 4  # a comment"}) {
        Diagnostics found;
        const TriangleMesh mesh = mesh_of(kCorners + more + face, "a.obj", found);
        EXPECT_EQ(text_of(found), "") << face;
        EXPECT_EQ(mesh.positions.size(), 4u) << face;
        EXPECT_EQ(mesh.triangles.size(), 2u) << face;
        EXPECT_DOUBLE_EQ(area(mesh), 1.0) << face;
        if (!mesh.normals.empty()) {
            EXPECT_EQ(mesh.normals[3], (Vec3{0, 0, 1})) << face;
        }
        if (!mesh.uvs.empty()) {
            EXPECT_EQ(mesh.uvs[2], (Vec2{1, 1})) << face;
        }
    }
}

TEST(Obj, ABackslashBehindANumberContinuesTheLine) {
    Diagnostics found;
    const TriangleMesh mesh =
        mesh_of("v 0 0\\\n 0\nv 1\\\n0\\\r\n0\nv 1 1. \\\n0\nf 1 2 3\n", "a.obj", found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
    (void)mesh_of("v 0 0 0\\1\n", "a.obj", found);
    EXPECT_TRUE(mentions(found, "expected a number, found '0\\1'")) << text_of(found);
}

TEST(Obj, TrianglesOfPositionsAloneAreReadAsAnyOther) {
    for (const char* face : {"f 1 2 3", "f +1 2\t3 ", "f -4 -3 -2", "f 1 2 3#c", "f 1 2 3 # c",
                             "f 1 \\\n 2 \\\n3", "f 1\\\n2\\\n 3", "f 1/ 2 3"}) {
        Diagnostics found;
        const TriangleMesh good = mesh_of(kCorners + face + "\nf 1 3 4\n", "a.obj", found);
        ASSERT_EQ(good.triangles.size(), 2u) << face << text_of(found);
        const TriangleMesh plain = mesh_of(kCorners + "f 1 2 3\n", "a.obj", found);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(good.positions[good.triangles[0][k]], plain.positions[plain.triangles[0][k]])
                << face;
        }
        (void)mesh_of(kCorners + face + "\nf 1 3 4\n f 9 1 1\n", "a.obj", found);
        // The line of the last face counts continued ones.
        const int line = std::string_view(face).find('\n') == std::string_view::npos ? 7 : 9;
        EXPECT_TRUE(mentions(found, "a.obj:" + std::to_string(line) + ": ")) << text_of(found);
    }
    Diagnostics found;
    const TriangleMesh mesh =
        mesh_of(kCorners + "vt 0 1\nf 1 2 3\nf 1/1 3/1 4/1\nf 2 3 4", "a.obj", found);
    ASSERT_EQ(mesh.triangles.size(), 3u) << text_of(found);
    EXPECT_EQ(mesh.uvs[mesh.triangles[0][0]], (Vec2{}));
    EXPECT_EQ(mesh.uvs[mesh.triangles[1][0]], (Vec2{0, 1}));
    EXPECT_EQ(mesh.positions[mesh.triangles[2][1]], (Vec3{1, 1, 0}));
    ImportOptions options;
    options.max_elements = 5;
    EXPECT_THROW((void)mesh_of(kCorners + "f 1 2 3\nf 1 3 4\n", "a.obj", found, options), Error);
    options.max_elements = 6;
    EXPECT_EQ(mesh_of(kCorners + "f 1 2 3\nf 1 3 4\n", "a.obj", found, options).triangles.size(),
              2u);
}

TEST(Obj, VerticesAreDuplicatedOnlyWhereTheirNormalOrTextureDiffers) {
    Diagnostics found;
    const TriangleMesh mesh = mesh_of(kCorners +
                                          "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\n"
                                          "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\n"
                                          "f 1/2/1 3/1/1 4/1/2\n",
                                      "a.obj", found);
    EXPECT_EQ(mesh.triangles.size(), 3u) << text_of(found);
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.normals.size(), 6u);
    EXPECT_EQ(mesh.uvs.size(), 6u);
    EXPECT_EQ(mesh.triangles[0][0], mesh.triangles[1][0]);
    EXPECT_NE(mesh.triangles[0][0], mesh.triangles[2][0]);
}

TEST(Obj, ACornerWithoutNormalAmongOthersGetsThatOfItsTriangles) {
    Diagnostics found;
    const TriangleMesh mesh =
        mesh_of(kCorners + "vn 0 1 0\nf 1//1 2//1 3//1\nf 1 3 4\n", "a.obj", found);
    ASSERT_EQ(mesh.normals.size(), 6u) << text_of(found);
    EXPECT_EQ(mesh.normals[mesh.triangles[0][0]], (Vec3{0, 1, 0}));
    EXPECT_EQ(mesh.normals[mesh.triangles[1][0]], (Vec3{0, 0, 1}));
}

TEST(Obj, MissingNormalsAreSmoothedWithinAGroupAndFlatWithoutOne) {
    // A roof: two squares that share the edge from vertex 2 to 3.
    const std::string roof = "v 0 0 0\nv 1 0 1\nv 1 1 1\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";
    const auto normal_at_ridge = [&](const std::string& faces) {
        Diagnostics found;
        const TriangleMesh mesh = mesh_of(roof + faces, "a.obj", found);
        EXPECT_EQ(text_of(found), "") << faces;
        if (mesh.normals.empty()) return Vec3{};
        return mesh.normals[mesh.triangles[0][1]];
    };
    const std::string left = "f 1 2 3 4\n", right = "f 2 5 6 3\n";
    EXPECT_EQ(normal_at_ridge(left + right), (Vec3{}));
    EXPECT_EQ(normal_at_ridge("s off\n" + left + right), (Vec3{}));
    EXPECT_EQ(normal_at_ridge("s 1\n" + left + right), (Vec3{0, 0, 1}));
    EXPECT_EQ(normal_at_ridge("s 7\n" + left + "g other\nusemtl m\n" + right), (Vec3{0, 0, 1}));
    const double h = std::sqrt(0.5);
    for (const char* between : {"s 2\n", "s off\n", "s 0\n"}) {
        const Vec3 n = normal_at_ridge("s 1\n" + left + between + right);
        EXPECT_LT(length(n - Vec3{-h, 0, h}), 1e-15) << between;
    }
}

TEST(Obj, AFaceCountsByItsAreaWhereNormalsAreSmoothed) {
    Diagnostics found;
    // A horizontal quadrilateral of area 4 and a vertical one of area 1 share the edge from 1 to 2.
    const TriangleMesh mesh = mesh_of(
        "v 0 0 0\nv 0 1 0\nv -4 1 0\nv -4 0 0\nv 0 1 1\nv 0 0 1\ns 1\nf 1 2 3 4\nf 2 1 6 5\n",
        "a.obj", found);
    ASSERT_FALSE(mesh.normals.empty()) << text_of(found);
    const Vec3 n = mesh.normals[mesh.triangles[0][0]];
    EXPECT_NEAR(std::abs(n.z / n.x), 4.0, 1e-12);
}

TEST(Obj, FlatAndSmoothFacesOfOneMeshKeepTheirOwnNormals) {
    Diagnostics found;
    const TriangleMesh mesh = mesh_of(
        "v 0 0 0\nv 1 0 1\nv 1 1 1\nv 0 1 0\nv 2 0 0\nv 2 1 0\ns 1\nf 1 2 3 4\ns off\nf 2 5 6 3\n",
        "a.obj", found);
    EXPECT_EQ(mesh.positions.size(), 8u) << text_of(found);
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 flat = normalize(
            cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
        EXPECT_LT(length(mesh.normals[a] - flat), 1e-15);
    }
}

TEST(Obj, ColoursOfVerticesAreDecodedFromTheirDisplayValues) {
    Diagnostics found;
    const auto colors = [&](const std::string& v) {
        return mesh_of(v + "v 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj", found).colors;
    };
    EXPECT_TRUE(colors("v 0 0 0\n").empty());
    EXPECT_TRUE(colors("v 0 0 0 1\n").empty());
    const auto half = colors("v 0 0 0 0.5 1 0\n");
    ASSERT_EQ(half.size(), 3u) << text_of(found);
    EXPECT_NEAR(half[0].r, 0.21404114, 1e-7);
    EXPECT_EQ(half[0].g, 1.0f);
    EXPECT_EQ(half[1], (VertexColor{1, 1, 1, 1}));
    const auto bytes = colors("v 0 0 0 255 0 127.5\n");
    EXPECT_EQ(bytes[0].r, 1.0f);
    EXPECT_NEAR(bytes[0].b, 0.21404114, 1e-7);
    EXPECT_EQ(text_of(found), "");
    EXPECT_TRUE(colors("v 0 0 0 1 1\nv 0 0 0 1 1\n").empty());
    EXPECT_EQ(found.warning_count(), 1u);
    EXPECT_TRUE(mentions(found, "a.obj:1:12: warning: a 'v' of five numbers")) << text_of(found);
}

TEST(Obj, IndicesOfNormalsAndCoordinatesThatTheFileLeavesOutAreAWarning) {
    Diagnostics found;
    const TriangleMesh mesh = mesh_of(kCorners + "f 1/1/1 2/2/2 3/3/3\n", "a.obj", found);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_EQ(found.warning_count(), 2u);
    EXPECT_EQ(found.error_count(), 0u);
}

TEST(Obj, FindingsNameLineAndColumn) {
    const auto finding = [](const std::string& text) {
        Diagnostics found;
        EXPECT_TRUE(mesh_of(kCorners + text, "a.obj", found).triangles.empty());
        return text_of(found);
    };
    const auto expect = [&](const std::string& text, const char* part) {
        const std::string found = finding(text);
        EXPECT_NE(found.find(part), std::string::npos) << text << "\n" << found;
    };
    expect("v 1 2", "a.obj:5:6: error: expected 3 numbers, found 2");
    expect("v 1 2 x", "a.obj:5:7: error: expected a number, found 'x'");
    expect("v 1 2 3.1-e2", "a.obj:5:7: error");
    expect("f 1 2 0", "a.obj:5:7: error: the index 0; indices count from 1");
    expect("f 1 2 -5", "a.obj:5:7: error: the index -5 is out of range");
    expect("f 1 2 5", "a.obj:5: error: the index 5 is above the 4 statements 'v'");
    expect("vt 0 0\nf 1/2 2/1 3/1", "a.obj:6: error: the index 2 is above the 1 statements 'vt'");
    expect("f 1 2", "a.obj:5:6: error: a face needs at least three vertices, found 2");
    expect("f", "a.obj:5:2: error: a face needs");
    expect("f 1 2 3x", "a.obj:5:8: error: expected a vertex");
    expect("f 1 2 99999999999999999999", "a.obj:5:7: error");
    expect("f 1 2 3/1/1/1", "a.obj:5:12: error: expected a vertex");
    expect("v 1e999 0 0", "a.obj:5:3: error");
    expect("v nan 0 0", "a.obj:5:3: error");
    expect("g a\n\n\nf 1 2 1000", "a.obj:8: error");
}

TEST(Obj, ManyErrorsEndTheReading) {
    std::string text = kCorners;
    for (int i = 0; i < 100000; ++i) text += "f 1 2 0\n";
    Diagnostics found;
    mesh_of(text, "a.obj", found);
    EXPECT_LT(found.error_count(), 100u);
}

TEST(Obj, ManyCombinationsAtOneVertexStayFast) {
    std::string text = kCorners;
    for (int i = 0; i < 200000; ++i) text += "vt 0 0\nf 1/-1 2/-1 3/-1\n";
    Diagnostics found;
    const TriangleMesh mesh = mesh_of(text, "a.obj", found);
    EXPECT_EQ(mesh.positions.size(), 600000u) << text_of(found);
}

TEST(Obj, RandomDamageNeverDoesMoreThanFindings) {
    std::mt19937 random(5);
    const std::string good = kCorners + "vt 1 1\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -4 -3 -2\n";
    for (int round = 0; round < 2000; ++round) {
        std::string bytes = good;
        for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = char(random() % 256);
        Diagnostics found;
        const TriangleMesh mesh = mesh_of(bytes, "a.obj", found);
        for (const auto& t : mesh.triangles) {
            for (const std::uint32_t i : t)
                ASSERT_LT(i, mesh.positions.size()) << "round " << round;
        }
    }
}

TEST(Obj, TheBunnyHasItsTrianglesAreaAndUnusedVertices) {
    ALHAZEN_NEEDS_DATA("meshes/alecjacobson/data");
    Diagnostics found;
    const TriangleMesh bunny =
        read_mesh(testing::test_data() / "meshes/alecjacobson/data/stanford-bunny.obj", {}, found);
    EXPECT_EQ(bunny.triangles.size(), 69451u);
    EXPECT_NEAR(area(bunny), 0.0571287861, 5e-11);
    std::vector<bool> used(bunny.positions.size());
    for (const auto& t : bunny.triangles) {
        for (const std::uint32_t i : t) used[i] = true;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 1113);
}

TEST(Obj, HostileFilesGiveFindingsOrMeshes) {
    ALHAZEN_NEEDS_DATA("hostile/tinyobj/models");
    const auto folder = testing::test_data() / "hostile";
    const auto triangles = [&](const char* name, Diagnostics& found) {
        return read_mesh(folder / name, {}, found).triangles.size();
    };
    Diagnostics good;
    EXPECT_EQ(triangles("assimp/OBJ/WusonOBJ.obj", good), 3732u);
    EXPECT_EQ(triangles("assimp/OBJ/multiple_spaces.obj", good), 1u);
    EXPECT_EQ(triangles("assimp/OBJ/cube_with_vertexcolors.obj", good), 12u);
    EXPECT_EQ(triangles("assimp/OBJ/testmixed.obj", good), 12u);
    EXPECT_EQ(triangles("assimp/OBJ/testline.obj", good), 0u);
    EXPECT_EQ(triangles("tinyobj/models/cornell_box.obj", good), 36u);
    EXPECT_EQ(triangles("tinyobj/models/issue-319-003.obj", good), 8u);
    EXPECT_EQ(triangles("tinyobj/models/cube-vertex-w-component.obj", good), 12u);
    EXPECT_EQ(good.error_count(), 0u) << text_of(good);
    for (const char* name :
         {"assimp/OBJ/box_UTF16BE.obj", "assimp/OBJ/number_formats.obj",
          "assimp/invalid/malformed2.obj", "tinyobj/models/invalid-face-definition.obj"}) {
        Diagnostics bad;
        EXPECT_EQ(triangles(name, bad), 0u);
        EXPECT_GT(bad.error_count(), 0u) << name;
        EXPECT_TRUE(mentions(bad, ".obj:")) << text_of(bad);
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".obj") continue;
        Diagnostics found;
        const TriangleMesh mesh = read_mesh(entry.path(), {}, found);
        Diagnostics invalid;
        mesh.validate({}, invalid);
        EXPECT_EQ(invalid.error_count(), 0u) << entry.path();
    }
}

TEST(Obj, AConcavePolygonKeepsItsArea) {
    ALHAZEN_NEEDS_DATA("hostile/assimp/OBJ/concave_polygon.obj");
    Diagnostics found;
    const TriangleMesh mesh =
        read_mesh(testing::test_data() / "hostile/assimp/OBJ/concave_polygon.obj", {}, found);
    EXPECT_EQ(text_of(found), "");
    // One polygon in a plane x = constant: overlapping triangles would add up to more than its
    // area.
    Vec3 sum;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    }
    EXPECT_GT(area(mesh), 0.0);
    EXPECT_NEAR(area(mesh), 0.5 * length(sum), 1e-12);
}

TEST(ImporterList, EmptyFilesAreToldOfInEveryFormat) {
    const testing::TemporaryFolder folder;
    for (const char* suffix : {".alhazen", ".ray", ".yaml", ".nff", ".gltf", ".glb", ".obj", ".ply",
                               ".stl", ".asc", ".g", ".bpt", ".rib", ".txt"}) {
        for (const char* text : {"", "\xEF\xBB\xBF", " \r\n\t\n"}) {
            const auto file = folder.write(std::string("a") + suffix, text);
            Diagnostics found;
            try {
                (void)import_scene(file, {}, found);
                ADD_FAILURE() << suffix;
            } catch (const Error& error) {
                EXPECT_EQ(error.what(), file.string() + ": the file is empty");
            }
        }
    }
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.txt"}) {
        Diagnostics found;
        (void)read_mesh(folder.write(name, "\n"), {}, found);
        EXPECT_EQ(text_of(found), (folder.path() / name).string() + ": error: the file is empty\n");
    }
}

TEST(MeshIo, FilesAreRecognisedByContentAndOthersRefused) {
    const testing::TemporaryFolder folder;
    const std::string obj = kCorners + "f 1 2 3 4\n";
    const auto triangles = [&](const std::string& name, const std::string& bytes,
                               Diagnostics& found) {
        return read_mesh(folder.write(name, bytes), {}, found).triangles.size();
    };
    Diagnostics good;
    EXPECT_EQ(triangles("a.obj", obj, good), 2u);
    EXPECT_EQ(triangles("a.OBJ", "\xEF\xBB\xBF" + obj, good), 2u);
    EXPECT_EQ(triangles("a.mesh", "# comment\n" + obj, good), 2u);
    EXPECT_EQ(triangles("a.obj",
                        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
                        "property float y\nproperty float z\nend_header\n",
                        good),
              0u);
    EXPECT_EQ(good.error_count(), 0u) << text_of(good);
    Diagnostics bad;
    triangles("a.off", "OFF\n3 1 0\n", bad);
    EXPECT_TRUE(mentions(bad, "expected PLY, OBJ or STL")) << text_of(bad);
    triangles("a.stl", "solid stl\nfacet normal", bad);
    EXPECT_TRUE(mentions(bad, "a.stl:2:13: error: facet 0: expected")) << text_of(bad);
    for (const char* rubbish : {"", " \n\t", "MZ\x90\0\3", "hello world\nthis is a letter\n"}) {
        Diagnostics found;
        EXPECT_EQ(triangles("c.obj", rubbish, found), 0u);
        EXPECT_GT(found.error_count(), 0u) << rubbish;
    }
    triangles("b.obj", "\xFF\xFEv\0", bad);
    EXPECT_TRUE(mentions(bad, "UTF-16")) << text_of(bad);
    try {
        const TriangleMesh mesh = read_mesh(folder.path() / "none.obj", {}, bad);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::File);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
