/// Meshes written and read back: bits, triangle sets, orientation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/formats/obj/mtl_reader.h"
#include "alhazen/formats/obj/obj_reader.h"
#include "alhazen/formats/ply/ply_reader.h"
#include "alhazen/formats/stl/stl_reader.h"
#include "support/random.h"
#include "support/sphere_mesh.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_text;
using testing::text_of;

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TriangleMesh ball(int levels) {
    const testing::SphereMesh sphere(levels);
    TriangleMesh mesh;
    mesh.positions = sphere.positions;
    mesh.triangles = sphere.triangles;
    return mesh;
}

/// A ball with every vertex array, of numbers that need all their bits.
TriangleMesh full_mesh(testing::Random& random) {
    TriangleMesh mesh = ball(2);
    for (Vec3& p : mesh.positions) p = 3.7 * p + random.in_cube(0.01);
    mesh.generate_normals();
    mesh.normals[5] = {};  // a vertex without area has no normal
    mesh.normals[6] = {0.1, -0.0, 0.3};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const float c = float(random.uniform(0, 3));
        mesh.uvs.push_back({random.uniform(), -random.uniform()});
        mesh.uvs2.push_back({0.5, double(float(random.uniform()))});
        mesh.colors.push_back({c, float(random.uniform()), 1e-30f, float(random.uniform())});
        mesh.tangents.push_back({float(random.uniform()), 0.25f, -0.0f, i % 2 ? 1.0f : -1.0f});
        mesh.vertex_materials.push_back(std::uint32_t(random.below(5)));
    }
    return mesh;
}

/// Triangles as sorted lists of corners, each starting at its least corner.
using Corners = std::array<std::array<double, 3>, 3>;
std::vector<Corners> triangle_set(const TriangleMesh& mesh, const Affine& placement = {}) {
    std::vector<Corners> set;
    for (const auto& t : mesh.triangles) {
        Corners c;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 p = placement.point(mesh.positions[t[k]]);
            c[k] = {p.x + 0.0, p.y + 0.0, p.z + 0.0};
        }
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        set.push_back(c);
    }
    std::sort(set.begin(), set.end());
    return set;
}

/// Rounds to float. Volatile, because g++ 12 at -O2 replaces double(float(x)) by x where two of
/// them are adjacent.
double rounded(double value) {
    volatile float narrow = float(value);
    return double(narrow);
}

TEST(MeshExport, APlyGivesEveryArrayBackBitForBit) {
    testing::Random random(21);
    for (int round = 0; round < 64; ++round) {
        TriangleMesh mesh = full_mesh(random);
        if (round & 1) mesh.normals.clear();
        if (round & 2) mesh.uvs.clear();
        if (round & 4) mesh.uvs2.clear();
        if (round & 8) mesh.colors.clear();
        if (round & 16) mesh.tangents.clear();
        if (round & 32) mesh.vertex_materials.clear();
        Diagnostics found;
        const TriangleMesh back = read_ply(ply_bytes(mesh), "a.ply", {}, found);
        EXPECT_EQ(text_of(found), "");
        EXPECT_TRUE(same_bits(back.positions, mesh.positions)) << round;
        EXPECT_TRUE(same_bits(back.triangles, mesh.triangles)) << round;
        EXPECT_TRUE(same_bits(back.normals, mesh.normals)) << round;
        EXPECT_TRUE(same_bits(back.uvs, mesh.uvs)) << round;
        EXPECT_TRUE(same_bits(back.uvs2, mesh.uvs2)) << round;
        EXPECT_TRUE(same_bits(back.colors, mesh.colors)) << round;
        EXPECT_TRUE(same_bits(back.tangents, mesh.tangents)) << round;
        EXPECT_TRUE(same_bits(back.vertex_materials, mesh.vertex_materials)) << round;
    }
}

TEST(MeshExport, APlyIsAsSmallAsItsNumbersAllow) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.25, 0}};
    mesh.triangles = {{0, 1, 2}};
    const std::string floats = ply_bytes(mesh);
    EXPECT_NE(floats.find("property float x"), std::string::npos);
    mesh.positions[1].x = 0.1;
    EXPECT_NE(ply_bytes(mesh).find("property double x"), std::string::npos);
    EXPECT_EQ(ply_bytes(mesh).size(), floats.size() + 3 * 12 + 3);  // "double" is longer too
    // All 256 display codes are exact.
    Diagnostics found;
    for (int code = 0; code < 256; ++code) {
        const std::string text =
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\n"
            "end_header\n";
        const std::string c = " " + std::to_string(code) + " 0 255 " + std::to_string(code) + "\n";
        const TriangleMesh coded = read_ply(
            text + "0 0 0" + c + "1 0 0" + c + "0 1 0" + c + "3 0 1 2\n", "a.ply", {}, found);
        ASSERT_EQ(coded.colors.size(), 3u) << text_of(found);
        const std::string bytes = ply_bytes(coded);
        EXPECT_NE(bytes.find("property uchar alpha"), std::string::npos) << code;
        EXPECT_TRUE(same_bits(read_ply(bytes, "a.ply", {}, found).colors, coded.colors)) << code;
    }
}

TEST(MeshExport, ObjAndStlGiveTheSameTrianglesBack) {
    testing::Random random(8);
    TriangleMesh mesh = full_mesh(random);
    const NamedMesh named{"a ball\n", &mesh, {}, "red\tpaint"};
    Diagnostics found;
    const SceneDescription scene = import_text(obj_text({&named, 1}), "a.obj", found);
    ASSERT_EQ(scene.meshes.size(), 1u) << text_of(found);
    EXPECT_EQ(scene.meshes[0].name, "a ball_");
    const TriangleMesh& back = *scene.meshes[0].mesh;
    EXPECT_EQ(triangle_set(back), triangle_set(mesh));
    EXPECT_EQ(back.uvs.size(), mesh.positions.size());
    EXPECT_EQ(back.normals.size(), mesh.positions.size());

    for (Vec3& p : mesh.positions) p = {rounded(p.x), rounded(p.y), rounded(p.z)};
    const auto solids = read_stl(stl_bytes({&named, 1}), "a.stl", {}, found);
    ASSERT_EQ(solids.size(), 1u) << text_of(found);
    EXPECT_EQ(triangle_set(solids[0].mesh), triangle_set(mesh));
}

TEST(MeshExport, ANameInAnObjBeginsNoComment) {
    const TriangleMesh mesh = ball(1);
    const auto back = [&](const std::string& name) {
        const NamedMesh named{name, &mesh, {}, name};
        const std::string text = obj_text({&named, 1});
        Diagnostics found;
        const SceneDescription scene = import_text(text, "a.obj", found);
        Material material;
        material.name = name;
        std::vector<std::string> lost;
        const std::string in_mtl = read_mtl(mtl_text({&material, 1}, {}, lost), "", found)[0].name;
        EXPECT_NE(text.find("usemtl " + in_mtl + '\n'), std::string::npos) << text;
        return scene.meshes.at(0).name;
    };
    EXPECT_EQ(back("wheel # left #"), "wheel_# left_#");
    EXPECT_EQ(back("# left"), "_ left");
    EXPECT_EQ(back("#"), "_");
    EXPECT_EQ(back("wheel #2 a#"), "wheel #2 a#");
}

TEST(MeshExport, PartsOfEqualNamesAndOfNoneStayApartInAnObj) {
    const TriangleMesh mesh = ball(1);
    std::vector<NamedMesh> meshes;
    for (const char* name : {"b", "", "b", "b_", "b\n", "", "b_2"}) {
        const Affine placement = Affine::translate({0.5 * double(meshes.size()), 0, 0});
        meshes.push_back({name, &mesh, placement, ""});
    }
    Diagnostics found;
    const SceneDescription scene = import_text(obj_text(meshes), "a.obj", found);
    ASSERT_EQ(scene.meshes.size(), meshes.size()) << text_of(found);
    EXPECT_EQ(scene.meshes[0].name, "b");
    EXPECT_EQ(scene.meshes[3].name, "b_");
    EXPECT_EQ(scene.meshes[6].name, "b_2");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        TriangleMesh placed = mesh;
        placed.transform(meshes[i].placement);
        EXPECT_EQ(triangle_set(*scene.meshes[i].mesh), triangle_set(placed)) << i;
        EXPECT_FALSE(scene.meshes[i].name.empty());
    }
}

TEST(MeshExport, PicturesOnAMeshWithoutCoordinatesStayInPlaceInAnObj) {
    const TriangleMesh mesh = ball(2);
    for (const Affine& placement : {Affine{}, Affine::scale({-1, 2, 1})}) {
        std::vector<NamedMesh> both(2, {"a", &mesh, placement, ""});
        both[1].needs_coordinates = true;
        Diagnostics found;
        const SceneDescription scene = import_text(obj_text(both), "a.obj", found);
        ASSERT_EQ(scene.meshes.size(), 2u) << text_of(found);
        EXPECT_TRUE(scene.meshes[0].mesh->uvs.empty());
        const TriangleMesh& back = *scene.meshes[1].mesh;
        ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
        TriangleMesh placed = mesh;
        placed.transform(placement);
        const bool mirrored = placement != Affine{};
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            // The weights of the second and third vertex change with these.
            const double u = 0.25, v = 0.125;
            ShapeHit before, after;
            before.u = u;
            before.v = v;
            after.u = mirrored ? v : u;
            after.v = mirrored ? u : v;
            const ShapeSurface a = placed.surface(i, before), b = back.surface(i, after);
            EXPECT_EQ(a.uv, b.uv);
            EXPECT_NEAR(length(a.point - b.point), 0.0, 1e-14);
            EXPECT_EQ(a.dpdu, b.dpdu);
            EXPECT_EQ(a.dpdv, b.dpdv);
        }
    }
}

TEST(MeshExport, MirroredPlacementsKeepTheOutsideOutside) {
    const TriangleMesh mesh = ball(2);
    const double volume = signed_volume(mesh);
    ASSERT_GT(volume, 0);
    const Affine mirror = Affine::translate({5, 0, 0}) * Affine::scale({-2, 1, 1});
    const std::vector<NamedMesh> both{{"as it is", &mesh, {}, ""}, {"mirrored", &mesh, mirror, ""}};
    Diagnostics found;
    const TriangleMesh from_ply = read_ply(ply_bytes(both), "a.ply", {}, found);
    EXPECT_NEAR(signed_volume(from_ply), 3 * volume, 1e-9);
    const TriangleMesh from_obj = read_obj(obj_text(both), "a.obj", {}, found);
    EXPECT_NEAR(signed_volume(from_obj), 3 * volume, 1e-9);
    const auto from_stl = read_stl(stl_bytes(both), "a.stl", {}, found);
    EXPECT_NEAR(signed_volume(from_stl.at(0).mesh), 3 * volume, 1e-5);
    EXPECT_EQ(text_of(found), "");
}

TEST(MeshExport, TangentsArePlacedIfAllMeshesHaveThem) {
    TriangleMesh mesh = ball(1);
    mesh.generate_normals();
    mesh.tangents.assign(mesh.positions.size(), {0.6f, 0.8f, 0, 1});
    const std::size_t n = mesh.positions.size();
    const Affine mirror = Affine::translate({5, 0, 0}) * Affine::scale({-2, 1, 1});
    std::vector<NamedMesh> meshes{{"moved", &mesh, Affine::translate({1, 2, 3}), ""},
                                  {"mirrored", &mesh, mirror, ""}};
    EXPECT_EQ(meshes_without_tangents(meshes), 0u);
    Diagnostics found;
    const TriangleMesh back = read_ply(ply_bytes(meshes), "a.ply", {}, found);
    ASSERT_EQ(back.tangents.size(), 2 * n) << text_of(found);
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(back.tangents[i], mesh.tangents[i]);
        const VertexTangent& t = back.tangents[n + i];
        EXPECT_NEAR(t.x, -1.2 / std::sqrt(1.44 + 0.64), 1e-6);
        EXPECT_NEAR(t.y, 0.8 / std::sqrt(1.44 + 0.64), 1e-6);
        EXPECT_EQ(t.sign, -1);
    }
    const TriangleMesh plain = ball(1);
    meshes.push_back({"without", &plain, {}, ""});
    EXPECT_EQ(meshes_without_tangents(meshes), 1u);
    EXPECT_TRUE(read_ply(ply_bytes(meshes), "a.ply", {}, found).tangents.empty());
}

TEST(MeshExport, PlacedNormalsKeepTheRatiosOfTheirLengthsInAPly) {
    TriangleMesh mesh = ball(1);
    mesh.generate_normals();
    testing::Random random(22);
    for (Vec3& normal : mesh.normals) normal = random.log_uniform(0.5, 2) * normal;
    TriangleMesh unit = ball(1);
    unit.generate_normals();
    const Affine turned = Affine::rotate({0, 0, 1}, 0.5), squeezed = Affine::scale({4, 1, 0.5});
    const Affine tiny = Affine::scale({1e-60, 2e-60, 1e-60});
    std::vector<NamedMesh> meshes{{"", &mesh, turned, ""},
                                  {"", &unit, squeezed, ""},
                                  {"", &unit, turned, ""},
                                  {"", &unit, tiny, ""}};
    EXPECT_EQ(meshes_with_normals_of_several_lengths(meshes), 3u);
    Diagnostics found;
    const TriangleMesh back = read_ply(ply_bytes(meshes), "a.ply", {}, found);
    const std::size_t n = unit.positions.size();
    ASSERT_EQ(back.normals.size(), 4 * n) << text_of(found);
    for (std::size_t m = 0; m < 4; ++m) {
        const Affine& placement = meshes[m].placement;
        const auto placed = [&](std::size_t i) {
            const Vec3 scaled =
                transpose_times(inverse(placement.linear), meshes[m].mesh->normals[i]);
            return m == 3 ? 1e-60 * scaled : scaled;
        };
        double greatest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            greatest = std::max(greatest, length(back.normals[m * n + i]));
        }
        EXPECT_NEAR(greatest, 1, 1e-15) << m;
        for (std::size_t i = 1; i < n; ++i) {
            const double ratio = length(placed(i)) / length(placed(0));
            EXPECT_NEAR(length(back.normals[m * n + i]) / length(back.normals[m * n]), ratio, 1e-14)
                << m << ' ' << i;
            const double along = dot(back.normals[m * n + i], placed(i));
            EXPECT_NEAR(along, length(back.normals[m * n + i]) * length(placed(i)), 1e-14) << m;
        }
    }
}

TEST(MeshExport, AFlatMeshAmongSmoothOnesStaysFlat) {
    TriangleMesh smooth = ball(1);
    smooth.generate_normals();
    const TriangleMesh flat = ball(1);
    const std::vector<NamedMesh> both{{"", &smooth, {}, ""},
                                      {"", &flat, Affine::translate({3, 0, 0}), ""}};
    Diagnostics found;
    const TriangleMesh back = read_ply(ply_bytes(both), "a.ply", {}, found);
    ASSERT_EQ(back.normals.size(), back.positions.size()) << text_of(found);
    EXPECT_EQ(back.positions.size(), smooth.positions.size() + 3 * flat.triangles.size());
    for (std::size_t i = smooth.triangles.size(); i < back.triangles.size(); ++i) {
        const auto& t = back.triangles[i];
        EXPECT_EQ(back.normals[t[0]], back.normals[t[1]]);
        EXPECT_EQ(back.normals[t[0]], back.normals[t[2]]);
    }
}

TEST(MeshExport, AFaceHasTheMaterialOfItsFirstVertex) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {2, 1, 3}, {3, 1, 2}};
    mesh.vertex_materials = {1, 1, 1, 0};
    const std::vector<std::string> names{"red", "blue"};
    const NamedMesh named{"m", &mesh, {}, "part", names};
    EXPECT_EQ(faces_of_several_materials({&named, 1}), 2u);
    const std::string text = obj_text({&named, 1});
    EXPECT_NE(text.find("usemtl blue\nf 1 2 3\nf 3 2 4\nusemtl red\nf 4 2 3\n"), std::string::npos)
        << text;
    mesh.vertex_materials.clear();
    EXPECT_EQ(faces_of_several_materials({&named, 1}), 0u);
    EXPECT_NE(obj_text({&named, 1}).find("usemtl part\nf 1 2 3\nf 3 2 4\n"), std::string::npos);
}

TEST(MeshExport, AnStlBeyondFloatIsRefused) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {3e38, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const NamedMesh fits{"part", &mesh, Affine{}, "", {}};
    EXPECT_EQ(stl_bytes({&fits, 1}).size(), 134u);
    const NamedMesh beyond{"part", &mesh, Affine::scale({2, 1, 1}), "", {}};
    EXPECT_THROW((void)stl_bytes({&beyond, 1}), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
