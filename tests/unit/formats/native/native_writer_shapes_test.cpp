/// The writer of native scenes: shapes, objects and meshes come back as they were.

#include "alhazen/formats/native/write/native_writer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <random>

#include "alhazen/base/error.h"
#include "alhazen/formats/native/fields/native_text.h"
#include "alhazen/formats/text/unique_labels.h"
#include "alhazen/imaging/image/image.h"
#include "native_round_trip.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::empty_scene;
using testing::expect_round_trip;
using testing::Numbers;
using testing::RoundTrip;

Part part_of(decltype(Part::what) what, const Affine& placement, MaterialId material,
             std::string name) {
    return {std::move(what), placement, material, std::move(name), {}};
}

TEST(NativeWriter, ShapesComeBackInOrderWithNamesAndPlacements) {
    Numbers n(13);
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 3; ++i) scene.materials.push_back({Material{}, {}});
    auto& parts = scene.objects[0].parts;
    Polygon ring;
    for (int i = 0; i < 9; ++i) ring.vertices.push_back(n.point());
    ring.loop_ends = {4, 9};
    Polygon plain;
    plain.vertices = ring.vertices;
    const auto flat = [&] { return Vec2{n.any(), n.any()}; };
    Prism prism{.h0 = n.any(), .h1 = n.any(), .top_scale = 0.5};
    Lathe lathe;
    for (int loop = 0; loop < 2; ++loop) {
        const Vec2 a = flat(), b = flat(), c = flat();
        for (Profile* profile : {&prism.profile, &lathe.profile}) {
            profile->curves.push_back(line_curve(a, b));
            profile->curves.push_back(cubic_curve(b, flat(), flat(), c));
            profile->curves.push_back(line_curve(c, a));
            profile->loop_ends.push_back(static_cast<std::uint32_t>(profile->curves.size()));
        }
    }
    lathe.profile.curves.pop_back();  // open
    lathe.profile.loop_ends = {3, 5};
    Blob blob{.threshold = n.positive()};
    blob.components = {{.base = n.point(), .radius = n.positive(), .strength = n.any()},
                       {.base = n.point(), .top = n.point(), .strength = n.any(), .rod = true}};
    HeightField field{.columns = 3, .rows = 2};
    field.heights = std::make_shared<std::vector<float>>(
        std::vector<float>{0.1f, 1e-3f, 3.f, 7.25f, 1.f / 3, 2.f});
    field.hi = flat();
    field.base = n.any();
    Polyhedron planes;
    for (int i = 0; i < 5; ++i) planes.planes.push_back({n.point(), n.point()});
    Quadric quadric{n.point(), n.point(), n.point(), n.positive()};
    const Quadric unclipped = quadric;
    quadric.clip_box = {n.point(), n.point()};
    quadric.clip_planes = {{n.point(), n.positive()}, {n.point(), n.positive()}};
    quadric.capped = false;
    for (const AnyShape& shape : std::initializer_list<AnyShape>{
             Sphere{n.point(), n.positive()},
             plain,
             ring,
             Plane{n.point(), n.point()},
             Disc{n.point(), n.point(), n.positive(), 0.01},
             Rectangle{n.point(), n.point(), n.point()},
             BoxShape{n.point(), n.point()},
             Cylinder{n.point(), n.point(), n.positive(), false},
             Cone{n.point(), n.point(), n.positive(), n.positive(), false},
             Sphere{},
             Plane{},
             Disc{},
             Rectangle{},
             BoxShape{},
             Cylinder{},
             Cone{},
             HalfSpace{n.point(), n.point()},
             planes,
             hexahedron({n.point(), n.point(), n.point(), n.point(), n.point(), n.point(),
                         n.point(), n.point()}),
             Ellipsoid{n.point(), n.point(), n.point(), n.point()},
             EllipticCylinder{n.point(), n.point(), n.point(), n.point(), false},
             EllipticCone{n.point(), n.point(), n.point(), n.point(), n.positive(), false},
             Tgc{n.point(), n.point(), n.point(), n.point(), n.point(), n.point(), false},
             Torus{n.point(), n.point(), n.positive(), n.positive()},
             Paraboloid{n.point(), n.point(), n.point(), n.point(), false},
             Hyperboloid{n.point(), n.point(), n.point(), n.point(), n.positive(), false},
             TwoSheetHyperboloid{n.point(), n.point(), n.point(), n.point(), n.positive(), false},
             quadric,
             unclipped,
             Algebraic{"x^2*y - 1", {n.point(), n.point()}, false},
             Ellipsoid{},
             EllipticCylinder{},
             EllipticCone{},
             Tgc{},
             Torus{},
             Paraboloid{},
             Hyperboloid{},
             TwoSheetHyperboloid{},
             Quadric{},
             Algebraic{},
             Superellipsoid{},
             Superellipsoid{n.point(), n.point(), n.point(), n.point(), n.positive(),
                            n.positive()}}) {
        parts.push_back(part_of(shape, n.affine(), MaterialId(n.below(3)), "a part"));
        parts.push_back(part_of(shape, {}, MaterialId(n.below(3)), ""));
    }
    Affine signed_zeros = Affine::scale({-1, 1, 1});
    signed_zeros.translation = {-0.0, 0.0, -0.0};
    parts.push_back(part_of(AnyShape{Sphere{}}, signed_zeros, MaterialId{0}, "\""));
    expect_round_trip(scene);
}

TEST(NativeWriter, ObjectsKeepTheirNumbersWhateverTheirOrder) {
    Numbers n(14);
    SceneDescription scene = empty_scene("root");
    scene.materials.push_back({Material{}, {}});
    scene.objects = {
        {"leaf", {}, {}}, {"tree", {}, {}}, {"leaf", {}, {}}, {"", {}, {}}, {"tree", {}, {}}};
    scene.root = ObjectIndex{1};
    const auto place = [&](std::size_t owner, decltype(Part::what) what, const char* name) {
        scene.objects[owner].parts.push_back(part_of(std::move(what), n.affine(), {}, name));
    };
    place(0, AnyShape{Sphere{}}, "");
    place(1, ObjectIndex{3}, "branch");
    place(1, ObjectIndex{0}, "");
    place(1, AnyShape{Plane{}}, "ground");
    place(2, AnyShape{Sphere{}}, "bud");
    place(3, ObjectIndex{4}, "twig");
    place(3, ObjectIndex{4}, "twig");
    place(4, ObjectIndex{2}, "");
    expect_round_trip(scene);
    // Without forward references and renamed roots no list is needed.
    scene = empty_scene();
    scene.materials.push_back({Material{}, {}});
    scene.objects.push_back({"leaf", {}, {}});
    scene.objects.back().accelerator = "octree:leaf_size=3,mailbox=off";
    place(1, AnyShape{Sphere{}}, "");
    place(0, ObjectIndex{1}, "");
    EXPECT_EQ(RoundTrip(scene).text.find("objects"), std::string::npos);
    expect_round_trip(scene);
}

TriangleMesh random_mesh(Numbers& n, int triangles) {
    TriangleMesh mesh;
    for (int i = 0; i < triangles + 2; ++i) mesh.positions.push_back(n.point());
    for (int i = 0; i < triangles; ++i) {
        const auto v = static_cast<std::uint32_t>(i);
        mesh.triangles.push_back({v, v + 2, v + 1});
    }
    return mesh;
}

TEST(NativeWriter, MeshesComeBackWithEveryArrayAndStayShared) {
    Numbers n(15);
    SceneDescription scene = empty_scene();
    for (const char* name : {"a", "b", "a"}) {
        scene.materials.push_back({Material{.name = name}, {}});
    }
    for (int i = 0; i < 64; ++i) {
        TriangleMesh mesh = random_mesh(n, i % 2 == 0 ? 4 : 40);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const auto f = [&] { return static_cast<float>(n.positive()); };
            if (i & 2) mesh.uvs.push_back(n.uv());
            if (i & 4) mesh.vertex_materials.push_back(std::uint32_t(2 - n.below(2)));
            if (i & 8) mesh.normals.push_back(normalize(n.point()));
            if (i & 8) mesh.uvs2.push_back(n.uv());
            if (i & 16) mesh.colors.push_back({f(), f(), f(), f()});
            if (i & 32) mesh.tangents.push_back({f(), f(), f(), n.below(2) ? 1.0F : -1.0F});
        }
        scene.meshes.push_back(
            {i % 3 == 0 ? "mesh" : "", std::make_shared<TriangleMesh>(mesh), {}});
        for (int uses = 0; uses < i % 3; ++uses) {
            scene.objects[0].parts.push_back(
                part_of(MeshIndex(i), n.affine(), MaterialId{1}, uses == 0 ? "" : "part"));
        }
    }
    scene.meshes.push_back({"nothing", std::make_shared<TriangleMesh>(), {}});
    expect_round_trip(scene);
}

TEST(NativeWriter, OnlySmallMeshesStandInTheText) {
    Numbers n(16);
    SceneDescription scene = empty_scene();
    scene.meshes.push_back({"", std::make_shared<TriangleMesh>(random_mesh(n, 16)), {}});
    scene.meshes.push_back({"", std::make_shared<TriangleMesh>(random_mesh(n, 17)), {}});
    const RoundTrip trip(scene);
    ASSERT_EQ(trip.files.size(), 1U);
    EXPECT_TRUE(trip.files.contains("scene_files/mesh_1.ply"));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
