#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>

#include "support/test_data.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mentions;
using testing::mesh_of;
using testing::text_of;

const std::string kPlySquare =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

/// Bytes of `value` in the given byte order.
template <class T>
void put(std::string& out, T value, bool big) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    const bool swap = big == (std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < sizeof(T); ++i) out += bytes[swap ? sizeof(T) - 1 - i : i];
}

/// A triangle whose properties are in an unusual order among unknown ones, after an unknown
/// element.
std::string binary_triangle(bool big, const std::string& newline) {
    std::string s;
    for (const char* line :
         {"ply",
          big ? "format binary_big_endian 1.0" : "format binary_little_endian 1.0",
          "element camera 2",
          "property list uchar short id",
          "property double w",
          "element face 1",
          "property uchar red",
          "property list uint ushort vertex_index",
          "property list uchar float weights",
          "element vertex 3",
          "property float ny",
          "property double z",
          "property uchar quality",
          "property short x",
          "property int8 y",
          "property float nx",
          "property float nz",
          "property float s",
          "property float t",
          "end_header"}) {
        s += line + newline;
    }
    for (int i = 0; i < 2; ++i) {
        put<std::uint8_t>(s, 2, big);
        put<std::int16_t>(s, 7, big);
        put<std::int16_t>(s, 8, big);
        put<double>(s, 0.5, big);
    }
    put<std::uint8_t>(s, 10, big);  // looks like a newline
    put<std::uint32_t>(s, 3, big);
    for (const int i : {2, 1, 0}) put<std::uint16_t>(s, std::uint16_t(i), big);
    put<std::uint8_t>(s, 1, big);
    put<float>(s, 1.0f, big);
    for (int i = 0; i < 3; ++i) {
        put<float>(s, 0.0f, big);
        put<double>(s, 1.25 * i, big);
        put<std::uint8_t>(s, 255, big);
        put<std::int16_t>(s, std::int16_t(-300 + i), big);
        put<std::int8_t>(s, std::int8_t(-2 * i), big);
        put<float>(s, 3.0f, big);
        put<float>(s, 4.0f, big);
        put<float>(s, 0.25f, big);
        put<float>(s, 0.75f, big);
    }
    return s;
}

TEST(Ply, AnAsciiSquareBecomesTwoTriangles) {
    Diagnostics found;
    const TriangleMesh mesh = mesh_of(kPlySquare, "a.ply", found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_DOUBLE_EQ(area(mesh), 1.0);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, BinaryFilesOfBothOrdersMayNameTheirPropertiesInAnyOrder) {
    for (const bool big : {false, true}) {
        for (const char* newline : {"\n", "\r\n", "\r"}) {
            SCOPED_TRACE(std::string(big ? "big" : "little") + std::to_string(newline[0]));
            Diagnostics found;
            const TriangleMesh mesh = mesh_of(binary_triangle(big, newline), "a.ply", found);
            EXPECT_EQ(found.error_count(), 0u) << text_of(found);
            EXPECT_TRUE(mentions(found, "'red' of a face is ignored")) << text_of(found);
            ASSERT_EQ(mesh.positions.size(), 3u);
            EXPECT_EQ(mesh.positions[2], (Vec3{-298, -4, 2.5}));
            EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{2, 1, 0}));
            EXPECT_NEAR(mesh.normals[1].x, 0.6, 1e-15);
            EXPECT_NEAR(mesh.normals[1].z, 0.8, 1e-15);
            EXPECT_EQ(mesh.uvs[0], (Vec2{0.25, 0.75}));
        }
    }
}

TEST(Ply, EveryPrefixOfAFileIsRefusedOrIsAWholeMesh) {
    for (const std::string& whole : {kPlySquare, binary_triangle(true, "\n")}) {
        // An ascii file is still complete without its last newline or digit.
        for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
            Diagnostics found;
            const TriangleMesh mesh = mesh_of(whole.substr(0, size), "a.ply", found);
            EXPECT_GT(found.error_count(), 0u) << "of the first " << size << " bytes";
            EXPECT_TRUE(mesh.triangles.empty());
        }
    }
}

TEST(Ply, DataAfterTheLastElementAreAWarning) {
    const auto findings = [](const std::string& bytes) {
        Diagnostics found;
        EXPECT_FALSE(mesh_of(bytes, "a.ply", found).triangles.empty());
        EXPECT_EQ(found.error_count(), 0u);
        return text_of(found);
    };
    EXPECT_EQ(findings(kPlySquare + " \n\r\n\t"), "");
    EXPECT_EQ(findings(kPlySquare + "\n3 0 1 2\n"),
              "a.ply:17:1: warning: 8 bytes follow the last element of the header, and are "
              "ignored\n");
    const std::string binary = binary_triangle(false, "\n"), plain = findings(binary);
    EXPECT_EQ(plain.find("last element"), std::string::npos) << plain;
    EXPECT_NE(findings(binary + ' ').find("1 byte follows"), std::string::npos);
    EXPECT_NE(findings(binary + "1234").find("4 bytes follow"), std::string::npos);
}

TEST(Ply, LinesOfMoreValuesThanDeclaredThatLeaveNoFaceAreToldOf) {
    Diagnostics found;
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 9 9\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_TRUE(mesh_of(text, "a.ply", found).triangles.empty());
    EXPECT_EQ(text_of(found),
              "a.ply:10:7: error: vertex 0: the line has more values than the header names\n");
    // Two vertices in each line.
    std::string all = text;
    all.replace(all.find("0 0 0 9 9"), std::string::npos, "0 0 0 9 9 9\n1 0 0 0 0 0\n3 0 1 2\n");
    Diagnostics other;
    EXPECT_TRUE(mesh_of(all, "a.ply", other).triangles.empty());
    EXPECT_TRUE(mentions(other, "a.ply:11:9: error: no face has three vertices or more; "))
        << text_of(other);
    EXPECT_TRUE(mentions(other, "does each line have the values that the header names?"));
}

TEST(Ply, AnItemOfAnAsciiFileEndsWithItsLine) {
    const auto findings = [](const std::string& vertices, const std::string& faces) {
        std::string text = kPlySquare;
        text.erase(text.find("0 0 0"));
        Diagnostics found;
        const TriangleMesh mesh = mesh_of(text + vertices + faces, "a.ply", found);
        EXPECT_EQ(mesh.triangles.empty(), found.error_count() != 0);
        return text_of(found);
    };
    const std::string face = "4 0 1 2 3\n", more = "the line has more values than the header names",
                      fewer = "the line has fewer values than the header names";
    EXPECT_EQ(
        findings("0 0 0\n1 0\n1 1 0 0\n0 1 0\n", face),
        "a.ply:12:1: error: vertex 1: " + fewer + "\na.ply:13:7: error: vertex 2: " + more + "\n");
    EXPECT_EQ(findings("0 0 0\n1 0 0 5\n1 1 0\n0 1 0\n", face),
              "a.ply:12:7: error: vertex 1: " + more + "\n");
    EXPECT_EQ(findings("0 0 0\n1 0 0\n1 1 0\n0 1 0 7\n", face),
              "a.ply:14:7: error: vertex 3: " + more + "\n");
    EXPECT_EQ(findings("0 0 0\n1 0 0\n1 1 0\n0 1 0 7\n", "4 0 1 2 5\n"),
              "a.ply:14:7: error: vertex 3: " + more +
                  "\na.ply:15:1: error: face 0: a vertex index outside the range of 4 vertices\n");
    const std::string all = findings("0 0 0 7\n1 0 0 7\n1 1 0 7\n0 1 0 7\n", face);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NE(all.find(":" + std::to_string(11 + i) + ":7: error: vertex " + std::to_string(i) +
                           ": " + more),
                  std::string::npos)
            << all;
    }
    EXPECT_EQ(all.find("face"), std::string::npos) << all;
    EXPECT_EQ(findings("0 0 0\n1 0 0 1 1 0\n0 1 0\n", face).substr(0, 12), "a.ply:12:7: ");
    EXPECT_EQ(findings("0 0 0\n1 0 0\n1 1 0\n0 1\n", face).substr(0, 12), "a.ply:14:1: ");
    // One number in a line, all in one, two items in each, wrapped lists.
    EXPECT_EQ(findings("0\n0\n0\n1\n0\n0\n1\n1\n0\n0\n1\n0\n", "4\n0\n1\n2\n3\n"), "");
    EXPECT_EQ(findings("0 0 0 1 0 0 1 1 0 0 1 0 ", face), "");
    EXPECT_EQ(findings("0 0 0 1 0 0\r\n1 1 0 0 1 0\r\n", "4 0 1\r\n 2 3 \r\n"), "");
    EXPECT_EQ(findings("  0 0 0\n\n 1 0 0 \n1 1 0\t\n0 1 0\n", face), "");
}

TEST(Ply, PropertiesThatMeanNothingAreToldOf) {
    const auto warnings = [](const std::string& from, const std::string& to,
                             const std::string& values) {
        std::string text = kPlySquare;
        text.replace(text.find(from), from.size(), to + "\n" + from);
        for (const char* vertex : {"0 0 0\n", "1 0 0\n", "1 1 0\n", "0 1 0\n"}) {
            if (from[0] == 'e') text.insert(text.find(vertex, text.find("end_header")) + 5, values);
        }
        Diagnostics found;
        EXPECT_FALSE(mesh_of(text, "a.ply", found).triangles.empty()) << text_of(found) << text;
        return text_of(found);
    };
    const std::string at = "a.ply:4:1: warning: ", face = "element face";
    EXPECT_EQ(warnings(face, "property float nx\nproperty float ny", " 0 0"),
              at + "'nx' of a vertex is ignored: only all of nx, ny and nz have a meaning\n");
    EXPECT_EQ(warnings(face, "property uchar green", " 9"),
              at + "'green' of a vertex is ignored: only all of red, green and blue have a "
                   "meaning\n");
    EXPECT_EQ(warnings(face, "property float z", " 0"),
              at + "'z' of a vertex is ignored, because 'z' follows\n");
    EXPECT_EQ(warnings(face, "property float confidence", " 0"), "");
}

TEST(Ply, CountsAreCheckedAgainstTheBytesPresent) {
    for (const char* count : {"4000000000", "123456789", "9223372036854775807"}) {
        std::string huge = kPlySquare;
        huge.replace(huge.find("vertex 4") + 7, 1, count);
        Diagnostics found;
        mesh_of(huge, "a.ply", found);
        EXPECT_TRUE(mentions(found, "a.ply:4:1: error: element vertex")) << text_of(found);
    }
    std::string long_list = kPlySquare;
    long_list.replace(long_list.find("4 0 1"), 1, "4000000000");
    Diagnostics found;
    mesh_of(long_list, "a.ply", found);
    EXPECT_TRUE(mentions(found, "a.ply:15:1: error: face 0: a list longer")) << text_of(found);
}

TEST(Ply, ElementsWithoutPropertiesTakeNoTimeHoweverMany) {
    std::string many = kPlySquare;
    many.insert(many.find("element face"), "element nothing 9000000000000000000\n");
    Diagnostics found;
    EXPECT_EQ(mesh_of(many, "a.ply", found).triangles.size(), 2u);
    EXPECT_EQ(text_of(found), "");
}

TEST(Ply, FindingsNameTheLine) {
    const auto finding = [](const std::string& from, const std::string& to) {
        std::string text = kPlySquare;
        text.replace(text.find(from), from.size(), to);
        Diagnostics found;
        EXPECT_TRUE(mesh_of(text, "a.ply", found).triangles.empty());
        EXPECT_GT(found.error_count(), 0u);
        return text_of(found);
    };
    EXPECT_NE(
        finding("1 1 0", "1 x 0").find("a.ply:13:3: error: vertex 2: expected a number, found 'x'"),
        std::string::npos);
    EXPECT_NE(finding("1 2 3", "1 2 4").find("a.ply:15:1: error: face 0"), std::string::npos);
    EXPECT_NE(finding("1 2 3", "1 2 -1").find("a.ply:15:1"), std::string::npos);
    EXPECT_NE(finding("1 2 3", "1 1.5 3")
                  .find("a.ply:15:1: error: face 0: a vertex index that is "
                        "not a whole number"),
              std::string::npos);
    EXPECT_NE(finding("float y", "half y").find("a.ply:6"), std::string::npos);
    EXPECT_NE(finding("ascii", "morse").find("a.ply:2"), std::string::npos);
    EXPECT_NE(finding("float z", "float w").find("a.ply:4:1"), std::string::npos);
    EXPECT_NE(finding("uchar int", "float int").find("a.ply:9"), std::string::npos);
    EXPECT_NE(finding("1 1 0", "1 nan 0").find("a.ply:13:3"), std::string::npos);
}

TEST(Ply, ZeroNormalsAreReplacedByThoseOfTheTriangles) {
    std::string text = kPlySquare;
    text.insert(text.find("element face"),
                "property float nx\nproperty float ny\nproperty float nz\n");
    const std::string from = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    text.replace(text.find("end_header\n") + 11, from.size(),
                 "0 0 0 0 0 0\n1 0 0 0 3 4\n1 1 0 1e-200 0 0\n0 1 0 0 0 -2\n");
    Diagnostics found;
    const TriangleMesh mesh = mesh_of(text, "a.ply", found);
    ASSERT_EQ(mesh.normals.size(), 4u) << text_of(found);
    EXPECT_EQ(mesh.normals[0], (Vec3{0, 0, 1}));
    EXPECT_NEAR(mesh.normals[1].y, 0.6, 1e-15);
    EXPECT_EQ(mesh.normals[2], (Vec3{1, 0, 0}));
    EXPECT_EQ(mesh.normals[3], (Vec3{0, 0, -1}));
}

TEST(Ply, MoreElementsThanAllowedAreAnErrorOfResources) {
    ImportOptions options;
    options.max_elements = 3;
    Diagnostics found;
    try {
        mesh_of(kPlySquare, "a.ply", found, options);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Resource);
    }
}

TEST(Ply, RandomDamageNeverDoesMoreThanFindings) {
    std::mt19937 random(3);
    for (int round = 0; round < 2000; ++round) {
        std::string bytes = round % 2 ? kPlySquare : binary_triangle(round % 4 == 0, "\n");
        for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = char(random() % 256);
        Diagnostics found;
        const TriangleMesh mesh = mesh_of(bytes, "a.ply", found);
        for (const auto& t : mesh.triangles) {
            for (const std::uint32_t i : t)
                ASSERT_LT(i, mesh.positions.size()) << "round " << round;
        }
    }
}

TEST(Ply, TheCoursesMeshesCarryTheirNormals) {
    ALHAZEN_NEEDS_DATA("ray/uw2020_yaml/assets/trace");
    const auto folder = testing::test_data() / "ray/uw2020_yaml/assets";
    Diagnostics found;
    const TriangleMesh sphere = read_mesh(folder / "trace/simple/poly-sphere.ply", {}, found);
    EXPECT_EQ(sphere.positions.size(), 121u);
    EXPECT_EQ(sphere.triangles.size(), 180u);
    EXPECT_EQ(sphere.uvs.size(), 121u);
    ASSERT_EQ(sphere.normals.size(), 121u);
    for (std::size_t i = 0; i < 121; ++i) {
        EXPECT_NEAR(length(sphere.normals[i] - normalize(sphere.positions[i])), 0.0, 1e-5);
    }
    const TriangleMesh ant = read_mesh(folder / "ant.ply", {}, found);
    EXPECT_EQ(ant.triangles.size(), 912u);
    EXPECT_TRUE(ant.normals.empty());
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(read_mesh(folder / "trace/trimeshes/knight.ply", {}, found).triangles.size(), 206u);
    EXPECT_TRUE(mentions(found, "knight.ply:3:1: warning")) << text_of(found);
}

TEST(Ply, HostileFilesGiveFindingsOrMeshes) {
    ALHAZEN_NEEDS_DATA("hostile/assimp/PLY");
    const auto folder = testing::test_data() / "hostile/assimp";
    const auto triangles = [&](const char* name, Diagnostics& found) {
        return read_mesh(folder / name, {}, found).triangles.size();
    };
    Diagnostics good;
    EXPECT_EQ(triangles("PLY/cube.ply", good), 12u);
    EXPECT_EQ(triangles("PLY/cube_binary.ply", good), 12u);
    EXPECT_EQ(triangles("PLY/cube_binary_header_with_RN_newline.ply", good), 12u);
    EXPECT_EQ(triangles("PLY/cube_binary_starts_with_nl.ply", good), 12u);
    EXPECT_EQ(triangles("PLY/cube_uv.ply", good), 12u);
    EXPECT_EQ(triangles("PLY/Wuson.ply", good), 3732u);
    EXPECT_EQ(triangles("PLY/points.ply", good), 0u);
    EXPECT_EQ(triangles("PLY/pond.0.ply", good), 0u);
    EXPECT_EQ(good.error_count(), 0u) << text_of(good);
    Diagnostics bad;
    triangles("invalid/empty.ply", bad);
    EXPECT_EQ(bad.error_count(), 1u);
    triangles("PLY/issue623.ply", bad);
    EXPECT_GT(bad.error_count(), 1u) << text_of(bad);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
