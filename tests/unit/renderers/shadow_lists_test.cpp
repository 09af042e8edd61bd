/// Rays to lights by lists: the answers of the aggregate, for rays that start anywhere, on surfaces
/// and in the planes of flat things.

#include "alhazen/renderers/core/shadows/shadow_lists.h"

#include <gtest/gtest.h>

#include <vector>

#include "alhazen/math/constants.h"
#include "alhazen/primitives/surface.h"
#include "support/random.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::SceneMaker;

Material glass() {
    Material m;
    m.transmissive.color = {0.9, 0.8, 0.7};
    return m;
}

Affine somewhere(Random& random, bool on_lattice) {
    if (on_lattice) {
        return Affine::translate(random.on_lattice(2, 1)) *
               Affine::rotate({0, 0, 1}, 0.5 * kPi * random.below(4));
    }
    return Affine::translate(random.in_cube(2)) *
           Affine::rotate(random.unit_vector(), random.uniform(0, 6));
}

/// Things of all kinds, opaque and of glass, some in one plane; lights of all kinds.
Scene random_scene(std::uint64_t seed, bool on_lattice) {
    Random random(seed);
    SceneMaker maker;
    const MaterialId looks[] = {maker.material({}), maker.material(glass())};
    const auto look = [&] { return looks[random.below(2)]; };
    const auto place = [&] { return somewhere(random, on_lattice); };
    const ObjectIndex thing = maker.object("thing");
    maker.add(Sphere{.center = {0, 0, 0.5}, .radius = 0.3}, look(), {}, thing);
    maker.add(Cone{.base = {0, 0, 0}, .top = {0, 0, 1}}, look(), {}, thing);
    const MeshIndex mesh = maker.mesh(testing::tetrahedron());
    for (int i = 0; i < 3; ++i) {
        maker.add(Sphere{.center = random.in_cube(2), .radius = random.uniform(0.1, 0.8)}, look());
        maker.add(Sphere{.center = {0, 0, 0}, .radius = 0.4}, look(), place());
        maker.add(Rectangle{.corner = {-1, -1, 0}, .edge_u = {2, 0, 0}, .edge_v = {0, 2, 0}},
                  look(), place());
        maker.add(Disc{.center = {0, 0, 0}, .normal = {0, 0, 1}, .radius = 0.7}, look(), place());
        maker.add(BoxShape{.lo = {-0.3, -0.3, 0}, .hi = {0.3, 0.3, 0.5}}, look(), place());
        maker.add(Cylinder{.base = {0, 0, 0}, .top = {0, 0, 1}, .radius = 0.2}, look(), place());
        maker.add(mesh, look(), place());
        maker.add(thing, MaterialId{0}, place());
    }
    maker.add(Rectangle{.corner = {-4, -4, 0}, .edge_u = {8, 0, 0}, .edge_v = {0, 8, 0}}, looks[0]);
    if (random.coin()) maker.add(Plane{.point = {0, 0, -0.5}, .normal = {0, 0, 1}}, look());
    maker.light(AmbientLight{{0.1, 0.1, 0.1}});
    maker.light(PointLight{.position = {3, 4, 5}});
    maker.light(PointLight{.position = on_lattice ? Vec3{0, 0, 0.5} : random.in_cube(2)});
    maker.light(DirectionalLight{.to_light = {-1, 2, 1}});
    maker.light(DirectionalLight{.to_light = {0, 0, 1}});
    maker.light(SpotLight{.position = {-3, 1, 2}});
    return maker.compile("wide_bvh");
}

struct Counts {
    int rays = 0, listed = 0, blocked = 0, tinted = 0;
};

void compare(const Scene& scene, ShadowLists& lists, const Ray& ray, std::size_t light,
             Counts& counts) {
    const RayMask mask = mask_of(RayKind::Shadow);
    ++counts.rays;
    std::vector<Hit> expected, found;
    const bool blocked = scene.aggregate->shadowed(ray, expected, {nullptr, mask});
    if (const auto answer = lists.shadowed(ray, light, mask, found)) {
        ++counts.listed;
        counts.blocked += blocked;
        counts.tinted += !blocked && !expected.empty();
        ASSERT_EQ(*answer, blocked);
        if (!blocked) {
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                ASSERT_EQ(found[i].t, expected[i].t);
                ASSERT_EQ(found[i].primitive, expected[i].primitive);
                ASSERT_EQ(found[i].path, expected[i].path);
            }
        }
    }
}

void compare_from(const Scene& scene, ShadowLists& lists, const Vec3& point, Counts& counts) {
    Ray there{point, {0, 0, 1}};
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (!illuminates(scene.lights[i])) continue;
        const LightSample light = sample(scene.lights[i], point, false);
        if (!(light.distance > 0.0)) continue;
        there.direction = light.to_light;
        there.t_max = light.distance;
        compare(scene, lists, there, i, counts);
    }
}

Counts compare_all(std::uint64_t seed, bool on_lattice) {
    Counts counts;
    const Scene scene = random_scene(seed, on_lattice);
    const auto lists = ShadowLists::make(scene);
    EXPECT_NE(lists, nullptr);
    if (!lists) return counts;
    Random random(seed + 1);
    for (int k = 0; k < 400 && !::testing::Test::HasFatalFailure(); ++k) {
        const Vec3 from = on_lattice ? random.on_lattice(3, 0.5) : random.in_cube(4);
        compare_from(scene, *lists, from, counts);
        const Ray ray{from + Vec3{0, 0, 1e-3}, random.unit_vector()};
        Hit hit;
        if (!scene.aggregate->closest(ray, hit, {nullptr, kAllRays})) continue;
        const Surface surface = surface_at(*scene.aggregate, ray, hit);
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            if (!illuminates(scene.lights[i])) continue;
            const LightSample light = sample(scene.lights[i], surface.point, false);
            compare(scene, *lists, leaving_ray(surface, light.to_light, light.distance), i, counts);
        }
    }
    return counts;
}

TEST(ShadowLists, AnswerLikeTheAggregate) {
    Counts sum;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        for (const bool on_lattice : {false, true}) {
            const Counts counts = compare_all(seed, on_lattice);
            if (HasFatalFailure()) return;
            sum.rays += counts.rays;
            sum.listed += counts.listed;
            sum.blocked += counts.blocked;
            sum.tinted += counts.tinted;
        }
    }
    // Else nothing was compared.
    EXPECT_GT(sum.listed, sum.rays / 2);
    EXPECT_GT(sum.blocked, sum.rays / 20);
    EXPECT_GT(sum.tinted, sum.rays / 20);
    EXPECT_LT(sum.blocked + sum.tinted, sum.listed);
}

TEST(ShadowLists, LeaveRaysThatDoNotEndAtTheLightToTheAggregate) {
    const Scene scene = random_scene(3, false);
    const auto lists = ShadowLists::make(scene);
    ASSERT_NE(lists, nullptr);
    std::vector<Hit> crossings;
    const Ray beside{{0, 0, 3}, normalize(Vec3{3, 4, 2.01}), 0.0, 5.4};
    EXPECT_FALSE(lists->shadowed(beside, 1, kAllRays, crossings));
}

TEST(ShadowLists, AreOnlyMadeForSmallScenesAndTheirAccelerator) {
    SceneMaker maker;
    maker.light(PointLight{.position = {0, 0, 5}});
    for (int i = 0; i < 10; ++i) maker.add(Sphere{.center = {double(i), 0, 0}, .radius = 0.4});
    EXPECT_NE(ShadowLists::make(maker.compile("wide_bvh")), nullptr);
    EXPECT_EQ(ShadowLists::make(maker.compile("list")), nullptr);
    maker.light(PointLight{.position = {0, 0, 5e4}});
    EXPECT_EQ(ShadowLists::make(maker.compile("wide_bvh")), nullptr);
}

TEST(ShadowLists, ASceneOfManyPrimitivesHasNone) {
    SceneMaker maker;
    maker.light(PointLight{.position = {0, 0, 5}});
    for (int i = 0; i < 1000; ++i) maker.add(Sphere{.center = {double(i), 0, 0}, .radius = 0.4});
    EXPECT_EQ(ShadowLists::make(maker.compile("wide_bvh")), nullptr);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
