#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/sampling/random.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/materials/texture_inputs.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using testing::tetrahedron;

Ray random_ray(RandomStream& random) {
    const auto point = [&](double r) {
        return Vec3{random.uniform(-r, r), random.uniform(-r, r), random.uniform(-r, r)};
    };
    const Vec3 origin = point(12);
    return {origin, point(4) - origin};
}

/// A transform that shears, scales unevenly and, with `mirror`, reflects.
Affine wild_transform(RandomStream& random, bool mirror) {
    const Vec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
    Affine m =
        Affine::translate({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)}) *
        Affine::rotate(axis, random.uniform(0, 6)) *
        Affine::scale({random.uniform(0.3, 2), random.uniform(0.3, 2), random.uniform(0.3, 2)}) *
        Affine::rotate(axis, random.uniform(0, 6));
    if (mirror) m = m * Affine::scale({-1, 1, 1});
    return m;
}

TEST(Compile, InstancesOfInstancesGiveTheHitsOfTheFlattenedScene) {
    for (int seed = 0; seed < 20; ++seed) {
        RandomStream random(static_cast<std::uint64_t>(seed));
        const Affine outer1 = wild_transform(random, seed % 2 == 1);
        const Affine outer2 = wild_transform(random, false);
        const Affine inner1 = wild_transform(random, seed % 3 == 1);
        const Affine inner2 = wild_transform(random, false);

        SceneMaker nested;
        const MeshIndex mesh = nested.mesh(tetrahedron());
        const ObjectIndex leaf = nested.object("leaf");
        nested.add(Sphere{}, MaterialId{0}, Affine::translate({0.5, 0, 0}), leaf);
        nested.add(mesh, MaterialId{0}, {}, leaf);
        const ObjectIndex middle = nested.object("middle");
        nested.add(leaf, MaterialId{0}, inner1, middle);
        nested.add(leaf, MaterialId{0}, inner2, middle);
        nested.add(middle, MaterialId{0}, outer1);
        nested.add(middle, MaterialId{0}, outer2);
        const Scene with_instances = nested.compile();
        EXPECT_EQ(with_instances.census.instance_depth, 2);
        EXPECT_EQ(with_instances.census.effective_primitives, 4u * 5u);

        SceneMaker flat;
        for (const Affine& outer : {outer1, outer2}) {
            for (const Affine& inner : {inner1, inner2}) {
                flat.add(Sphere{}, MaterialId{0}, outer * inner * Affine::translate({0.5, 0, 0}));
                flat.add(flat.mesh(tetrahedron()), MaterialId{0}, outer * inner);
            }
        }
        const Scene flattened = flat.compile();
        EXPECT_EQ(flattened.census.instance_depth, 0);

        for (int i = 0; i < 200; ++i) {
            const Ray ray = random_ray(random);
            Hit a, b;
            ASSERT_EQ(with_instances.aggregate->closest(ray, a, nullptr),
                      flattened.aggregate->closest(ray, b, nullptr))
                << "seed " << seed << " ray " << i;
            if (!a.found()) continue;
            EXPECT_NEAR(a.t, b.t, 1e-12) << "seed " << seed << " ray " << i;
            const Surface sa = surface_at(*with_instances.aggregate, ray, a);
            const Surface sb = surface_at(*flattened.aggregate, ray, b);
            EXPECT_LT(length(sa.normal - sb.normal), 1e-11) << "seed " << seed << " ray " << i;
            EXPECT_LT(length(sa.point - sb.point), 1e-11);
        }
    }
}

TEST(Compile, NormalsOfClosedSurfacesPointOutwardThroughMirrorings) {
    SceneMaker maker;
    const Affine mirrored = Affine::scale({-1, 2, 0.5});
    maker.add(Sphere{}, MaterialId{0}, Affine::translate({-4, 0, 0}) * mirrored);
    maker.add(maker.mesh(tetrahedron()), MaterialId{0}, Affine::translate({4, 0, 0}) * mirrored);
    const Scene scene = maker.compile();
    for (const double x : {-4.0, 4.0}) {
        for (const Vec3 side :
             {Vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
            const Vec3 center{x, 0.01, 0.02};
            const Ray outward{center, side};
            Hit hit;
            ASSERT_TRUE(scene.aggregate->closest(outward, hit, nullptr));
            EXPECT_GT(dot(surface_at(*scene.aggregate, outward, hit).normal, side), 0.0);
        }
    }
}

TEST(Compile, ALargeMeshUsedTwiceIsStoredOnce) {
    TriangleMesh strip;
    for (int i = 0; i < 200; ++i) strip.positions.push_back({i * 0.1, i % 2 * 1.0, 0});
    for (std::uint32_t i = 0; i + 2 < 200; ++i) strip.triangles.push_back({i, i + 1, i + 2});
    SceneMaker maker;
    const MeshIndex mesh = maker.mesh(strip);
    maker.add(mesh);
    maker.add(mesh, MaterialId{0}, Affine::translate({0, 5, 0}));
    const Scene scene = maker.compile();
    EXPECT_EQ(scene.census.triangles, 198u);
    EXPECT_EQ(scene.census.effective_primitives, 396u);
    Hit hit;
    EXPECT_TRUE(scene.aggregate->closest({{5, 5.5, 3}, {0, 0, -1}}, hit, nullptr));
    EXPECT_EQ(hit.path.size(), 1u);
}

TEST(Compile, AtEqualDistanceTheLowerPrimitiveWinsThroughInstancesToo) {
    SceneMaker maker;
    const MaterialId first = maker.material({.name = "first"});
    const MaterialId second = maker.material({.name = "second"});
    const ObjectIndex a = maker.object("a");
    const ObjectIndex b = maker.object("b");
    maker.add(Sphere{}, first, {}, a);
    maker.add(Sphere{}, second, {}, b);
    // Each object is used twice, so that both stay instances.
    for (const ObjectIndex object : {b, a, a, b}) maker.add(object);
    const Scene scene = maker.compile();
    const Ray ray{{0, 0, 5}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(scene.aggregate->closest(ray, hit, nullptr));
    EXPECT_EQ(surface_at(*scene.aggregate, ray, hit).materials[0], second);
    std::vector<Hit> hits;
    scene.aggregate->all_hits(ray, hits, nullptr);
    EXPECT_EQ(hits.size(), 8u);
    EXPECT_TRUE(std::is_sorted(hits.begin(), hits.end(), hit_less));
}

TEST(Compile, TruncatedColoursAreThoseOfEightBits) {
    SceneMaker maker;
    Material m;
    m.diffuse.color = {0.12, 1.0, 0.5};
    maker.material(m);
    maker.add(Sphere{});
    maker.description().conventions.importing.truncate_material_colors = true;
    const Scene scene = maker.compile();
    EXPECT_EQ(scene.materials[0].diffuse.color, (Rgb{30 / 255.0, 1.0, 127 / 255.0}));
}

TEST(Compile, TruncatedColoursAreNotThoseOfTextures) {
    SceneMaker maker;
    const Rgba dim{0.3, 0.3, 0.3, 1};
    maker.description().textures.push_back({"", SolidTexture{.color = dim, .other = dim}, {}});
    Material m;
    m.diffuse.color = {0.12, 1.0, 0.5};
    m.diffuse.texture = TextureId{0};
    maker.material(m);
    maker.add(Sphere{});
    maker.description().conventions.importing.truncate_material_colors = true;
    const Scene scene = maker.compile();
    EXPECT_EQ(color_at(scene.materials[0].diffuse, scene.textures, {}),
              (Rgb{30 / 255.0 * 0.3, 1.0 * 0.3, 127 / 255.0 * 0.3}));
}

TEST(Compile, AnUnknownAcceleratorIsAUsageErrorThatListsTheKnownOnes) {
    SceneMaker maker;
    maker.add(Sphere{});
    try {
        (void)maker.compile("octopus");
        FAIL() << "compiled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        EXPECT_NE(std::string(error.what()).find("wide_bvh"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
