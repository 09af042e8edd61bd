/// STL: ascii and binary files, welding, rejected files.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "alhazen/formats/mesh/vertex_welder.h"
#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/formats/stl/stl_reader.h"
#include "support/random.h"
#include "support/sphere_mesh.h"
#include "support/test_data.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_text;
using testing::mentions;
using testing::text_of;

std::vector<StlSolid> solids_of(std::string_view bytes, Diagnostics& found) {
    return read_stl(bytes, "a.stl", {}, found);
}

/// A binary file of these facets (normal, three corners); its header is `start` padded by zeros.
std::string binary(const std::vector<std::array<float, 12>>& facets, std::string start = "") {
    start.resize(80);
    const auto put = [&](std::uint32_t bits) {
        for (int shift = 0; shift < 32; shift += 8) start += char(bits >> shift & 255u);
    };
    put(std::uint32_t(facets.size()));
    for (const auto& facet : facets) {
        for (const float c : facet) put(std::bit_cast<std::uint32_t>(c));
        start += "\x12\x34";
    }
    return start;
}

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n "
    "endloop\nendfacet\n";
constexpr std::array<float, 12> kTriangle{0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};

TEST(Stl, SolidsOfAnAsciiFileKeepTheirNames) {
    Diagnostics found;
    const auto solids = solids_of("solid my part \n" + kFacet + "endsolid my part\n\nSOLID\n" +
                                      kFacet + kFacet + "endsolid\nsolid empty\nendsolid empty\n",
                                  found);
    ASSERT_EQ(solids.size(), 2u) << text_of(found);
    EXPECT_EQ(solids[0].name, "my part");
    EXPECT_EQ(solids[1].name, "");
    EXPECT_EQ(solids[1].line, 11);
    EXPECT_EQ(solids[1].mesh.triangles.size(), 2u);
    EXPECT_EQ(solids[1].mesh.positions.size(), 3u);
    EXPECT_EQ(text_of(found), "");
}

TEST(Stl, AFileMayBeOneLine) {
    std::string text = "solid a b\n" + kFacet + kFacet + "endsolid a b\nsolid c\n" + kFacet +
                       "endsolid\nsolid\n" + kFacet;
    std::replace(text.begin(), text.end(), '\n', ' ');
    Diagnostics found;
    const auto solids = solids_of(text, found);
    EXPECT_EQ(text_of(found), "");
    ASSERT_EQ(solids.size(), 3u);
    EXPECT_EQ(solids[0].name, "a b");
    EXPECT_EQ(solids[0].mesh.triangles.size(), 2u);
    EXPECT_EQ(solids[1].name, "c");
    EXPECT_EQ(solids[2].name, "");
    EXPECT_EQ(solids[2].mesh.triangles.size(), 1u);
    EXPECT_TRUE(looks_like_stl(text));
    // A name may have the words of a facet.
    const auto named = solids_of("solid my facet normal\n" + kFacet + "endsolid\n", found);
    ASSERT_EQ(named.size(), 1u);
    EXPECT_EQ(named[0].name, "my facet normal");
}

TEST(Stl, CapitalsLineEndsAndAMissingEndDoNotMatter) {
    std::string text =
        "Solid x\r\nFACET NORMAL nan nan nan\rOUTER LOOP VERTEX 0 0 0\tvertex 1 0 0\n"
        "Vertex 0 1e0 -0 ENDLOOP EndFacet";
    Diagnostics found;
    const auto solids = solids_of(text, found);
    ASSERT_EQ(solids.size(), 1u) << text_of(found);
    EXPECT_DOUBLE_EQ(area(solids[0].mesh), 0.5);
}

TEST(Stl, ABinaryFileMayBeginWithSolid) {
    for (const char* start : {"", "solid", "solid box\nfacet normal", "STLEXP Object01"}) {
        const std::string bytes = binary({kTriangle, kTriangle}, start);
        Diagnostics found;
        const auto solids = solids_of(bytes, found);
        ASSERT_EQ(solids.size(), 1u) << start << text_of(found);
        EXPECT_EQ(solids[0].mesh.triangles.size(), 2u);
        EXPECT_EQ(solids[0].mesh.positions.size(), 3u);
        EXPECT_TRUE(looks_like_stl(bytes));
    }
}

TEST(Stl, CornersInTheSamePlaceAreOneVertexSoThatASolidIsClosed) {
    const testing::SphereMesh sphere(3);
    TriangleMesh mesh;
    mesh.positions = sphere.positions;
    mesh.triangles = sphere.triangles;
    const NamedMesh named{"ball", &mesh, {}, ""};
    Diagnostics found;
    const auto solids = solids_of(stl_bytes({&named, 1}), found);
    ASSERT_EQ(solids.size(), 1u) << text_of(found);
    EXPECT_EQ(solids[0].mesh.positions.size(), mesh.positions.size());
    EXPECT_TRUE(solids[0].mesh.closed());
}

/// Positions whose unseeded multiplicative hashes end in the same 24 bits.
std::vector<Vec3> colliding_positions(std::size_t count) {
    constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15u;
    std::uint64_t inverse = kFactor;  // modulo 2^64, by Newton's iteration
    for (int i = 0; i < 6; ++i) inverse *= 2 - kFactor * inverse;
    std::vector<Vec3> points;
    for (std::uint64_t i = 1; points.size() < count; ++i) {
        const Vec3 p{double(i), 0.5, 0};
        std::uint64_t hash = 0;
        for (const double c : {p.x, p.y}) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(c)) * kFactor;
            hash ^= hash >> 32;
        }
        std::uint64_t wanted = i << 24;
        wanted ^= wanted >> 32;
        const double z = std::bit_cast<double>(hash ^ wanted * inverse);
        if (std::isfinite(z)) points.push_back({p.x, p.y, z});
    }
    return points;
}

TEST(Stl, PositionsThatAreChosenToCollideAreFoundAsFast) {
    const std::vector<Vec3> points = colliding_positions(80'000);
    const auto started = std::chrono::steady_clock::now();
    TriangleMesh mesh;
    VertexWelder welder(mesh, points.size());
    for (int round = 0; round < 2; ++round) {
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            ASSERT_EQ(welder.find_or_add(points[i]), i);
        }
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - started;
    EXPECT_LT(seconds.count(), 1.0);  // a single hash chain takes 10 s and more
}

TEST(Stl, AWelderThatStartsSmallNumbersInOrder) {
    TriangleMesh mesh;
    VertexWelder welder(mesh, 0);
    for (int round = 0; round < 2; ++round) {
        for (std::uint32_t i = 0; i < 1000; ++i) {
            ASSERT_EQ(welder.find_or_add({double(i % 10), double(i / 10), -0.0}), i);
        }
    }
    EXPECT_EQ(mesh.positions.size(), 1000U);
}

TEST(Stl, SizesThatDoNotFitTheCountAreToldWithBoth) {
    const auto finding = [](const std::string& bytes) {
        Diagnostics found;
        EXPECT_TRUE(solids_of(bytes, found).empty());
        return text_of(found);
    };
    std::string bytes = binary({kTriangle, kTriangle});
    bytes.resize(bytes.size() - 1);
    EXPECT_NE(finding(bytes).find("of 2 facets has 184 bytes; the file has 183"),
              std::string::npos);
    bytes.resize(300);
    EXPECT_NE(finding(bytes).find("has 184 bytes; the file has 300"), std::string::npos);
    EXPECT_NE(finding("abc").find("3 bytes"), std::string::npos);
    EXPECT_NE(finding("").find("0 bytes"), std::string::npos);
    // A facet count that would need 200 GB.
    bytes = binary({});
    bytes.replace(80, 4, "\xFF\xFF\xFF\xFF");
    EXPECT_NE(finding(bytes).find("of 4294967295 facets"), std::string::npos);

    Diagnostics found;
    EXPECT_EQ(solids_of(binary({kTriangle}) + "\r\n", found).size(), 1u);
    EXPECT_TRUE(mentions(found, "2 bytes behind the last facet")) << text_of(found);
}

TEST(Stl, ABinaryFileThatBeginsWithSolidIsToldOfAsBinaryWhenItsSizeIsWrong) {
    for (const char* start : {"solid", "solid part of a program", "SOLID\n"}) {
        std::string bytes = binary({kTriangle, kTriangle}, start);
        Diagnostics found;
        bytes.resize(bytes.size() - 7);
        EXPECT_TRUE(solids_of(bytes, found).empty());
        EXPECT_TRUE(mentions(found, "a binary STL of 2 facets has 184 bytes; the file has 177"))
            << text_of(found);
    }
    // A header without a zero byte; the coordinates contain some.
    std::string bytes = binary({kTriangle, kTriangle}, "solid" + std::string(75, ' '));
    bytes.resize(bytes.size() - 50);
    Diagnostics found;
    EXPECT_TRUE(solids_of(bytes, found).empty());
    EXPECT_TRUE(mentions(found, "has 184 bytes; the file has 134")) << text_of(found);
    // Bytes after the last facet are accepted, as in other binary files.
    Diagnostics more;
    EXPECT_EQ(solids_of(binary({kTriangle}, "solid") + "\r\n", more).size(), 1u);
    EXPECT_TRUE(mentions(more, "2 bytes behind the last facet")) << text_of(more);
}

TEST(Stl, TheHeaderOfAConvertedFileIsNoName) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const NamedMesh named{"part", &mesh, {}, ""};
    Diagnostics found;
    const SceneDescription scene = import_text(stl_bytes({&named, 1}), "wheel.stl", found);
    EXPECT_EQ(scene.objects.at(0).parts.at(0).name, "wheel") << text_of(found);
}

TEST(Stl, Utf16TextIsToldOf) {
    std::string text = "\xFF\xFE";
    for (const char c : "solid a\n" + kFacet) (text += c) += '\0';
    Diagnostics found;
    EXPECT_TRUE(solids_of(text, found).empty());
    EXPECT_EQ(text_of(found),
              "a.stl:1:1: error: the file is UTF-16 text; expected ASCII or UTF-8\n");
}

TEST(Stl, PositionsThatAreNoNumbersNameTheirFacet) {
    auto bad = kTriangle;
    bad[4] = std::numeric_limits<float>::quiet_NaN();
    Diagnostics found;
    EXPECT_TRUE(solids_of(binary({kTriangle, bad}), found).empty());
    EXPECT_TRUE(mentions(found, "facet 1: a position that is not finite")) << text_of(found);
    std::string text = kFacet;
    text.replace(text.find("1 0 0"), 5, "1 inf 0");
    EXPECT_TRUE(solids_of("solid\n" + kFacet + text + text, found).empty());
    EXPECT_TRUE(mentions(found, "a.stl:12:12: error: facet 1: expected a number, found 'inf'"))
        << text_of(found);
    EXPECT_TRUE(mentions(found, "a.stl:19:12"));
    EXPECT_TRUE(solids_of("solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2", found).empty());
    EXPECT_TRUE(mentions(found, "found the end of the file")) << text_of(found);
}

TEST(Stl, TheWindingCountsAndNormalsAgainstItAreToldOf) {
    auto turned = kTriangle;
    turned[2] = -1;
    Diagnostics found;
    const auto solids = solids_of(binary({turned, turned, kTriangle}), found);
    EXPECT_TRUE(mentions(found, "2 of 3 facets have a normal against their winding"));
    ASSERT_EQ(solids.size(), 1u);
    EXPECT_EQ(solids[0].mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
    Diagnostics none;
    (void)solids_of(binary({turned, kTriangle, kTriangle}), none);
    EXPECT_EQ(text_of(none), "");
}

TEST(Stl, ScenesHaveAPartForEachSolidAndZUp) {
    Diagnostics found;
    const SceneDescription scene =
        import_text("solid one\n" + kFacet + "endsolid\nsolid\n" + kFacet, "dir/b.txt", found);
    EXPECT_EQ(scene.format, "stl") << text_of(found);
    EXPECT_EQ(scene.up_axis, UpAxis::Z);
    ASSERT_EQ(scene.objects.at(0).parts.size(), 2u);
    EXPECT_EQ(scene.objects[0].parts[0].name, "one");
    EXPECT_EQ(scene.objects[0].parts[1].name, "b");
    (void)import_text("solid nothing\nendsolid\n", "c.stl", found);
    EXPECT_TRUE(mentions(found, "error: the file has no points and no faces")) << text_of(found);
}

TEST(Stl, RandomDamageNeverDoesMoreThanFindings) {
    testing::Random random(3);
    for (const std::string& good :
         {binary({kTriangle, kTriangle, kTriangle}), "solid a\n" + kFacet + kFacet + "endsolid"}) {
        for (int round = 0; round < 3000; ++round) {
            std::string bytes = good;
            for (int k = 0; k < 3; ++k) {
                bytes[std::size_t(random.below(int(bytes.size())))] = char(random.below(256));
            }
            bytes.resize(bytes.size() - std::size_t(random.below(3)));
            Diagnostics found;
            for (const StlSolid& solid : solids_of(bytes, found)) {
                Diagnostics invalid;
                solid.mesh.validate({}, invalid);
                for (const auto& t : solid.mesh.triangles) {
                    for (const std::uint32_t i : t) ASSERT_LT(i, solid.mesh.positions.size());
                }
            }
        }
    }
}

TEST(Stl, TheRealFilesAreRead) {
    ALHAZEN_NEEDS_DATA("hostile/assimp/STL");
    const auto folder = testing::test_data() / "hostile/assimp/STL";
    const auto triangles = [&](const char* name) {
        Diagnostics found;
        const auto mesh = read_mesh(folder / name, {}, found);
        EXPECT_EQ(found.error_count(), 0u) << text_of(found);
        return mesh.triangles.size();
    };
    EXPECT_EQ(triangles("triangle.stl"), 1u);
    EXPECT_EQ(triangles("3DSMaxExport.STL"), 2000u);
    EXPECT_GT(triangles("sphereWithHole.stl"), 100u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
