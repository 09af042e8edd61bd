#include "alhazen/scene/nearby_parts.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "alhazen/primitives/primitive_table.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

Material glass() {
    Material m;
    m.dielectric.emplace();
    m.index.value = 1.5;
    return m;
}
Material matt() {
    Material m;
    m.diffuse.color = {1, 1, 1};
    return m;
}

constexpr double kReach = 1e-12;

/// Of the surface that the ray hits first.
bool may_touch(const Scene& scene, const Ray& ray) {
    Hit hit;
    if (!scene.aggregate->closest(ray, hit, {nullptr})) {
        ADD_FAILURE() << "nothing is hit";
        return false;
    }
    return scene.nearby_parts->may_touch(surface_at(*scene.aggregate, ray, hit), kReach);
}
/// From x, y far above.
bool may_touch_below(const Scene& scene, double x, double y) {
    return may_touch(scene, Ray({x, y, 50}, {0, 0, -1}));
}
bool may_touch_above(const Scene& scene, double x, double y) {
    return may_touch(scene, Ray({x, y, -50}, {0, 0, 1}));
}

TEST(NearbyParts, BallsApartTouchNothing) {
    SceneMaker maker;
    const MaterialId m = maker.material(glass());
    maker.add(Sphere{{0, 0, 0}, 1}, m);
    maker.add(Sphere{{3, 0, 0}, 1}, m);
    const Scene scene = maker.compile();
    EXPECT_FALSE(may_touch_below(scene, 0.1, 0.2));
    EXPECT_FALSE(may_touch_below(scene, 3.1, 0.2));
    EXPECT_TRUE(scene.nearby_parts->unbounded().empty());
}

TEST(NearbyParts, ABallOnTheFloorMayTouchItBelow) {
    SceneMaker maker;
    const MaterialId m = maker.material(glass()), floor = maker.material(matt());
    maker.add(Sphere{{0, 0, 1}, 1}, m);
    maker.add(Rectangle{{-9, -9, 0}, {18, 0, 0}, {0, 18, 0}}, floor);
    const Scene scene = maker.compile();
    EXPECT_FALSE(may_touch_below(scene, 0.1, 0.2));
    EXPECT_TRUE(may_touch(scene, Ray({0, 0, 1}, {0, 0, -1})));
    // Nothing is known of what is opaque.
    EXPECT_TRUE(may_touch_below(scene, 5, 5));
}

TEST(NearbyParts, PlanesAreNamed) {
    SceneMaker maker;
    const MaterialId m = maker.material(glass()), floor = maker.material(matt());
    maker.add(Sphere{{0, 0, 1}, 1}, m);
    maker.add(Plane{{0, 0, 0}, {0, 0, 1}}, floor);
    const Scene scene = maker.compile();
    EXPECT_FALSE(may_touch_below(scene, 0.1, 0.2));
    ASSERT_EQ(scene.nearby_parts->unbounded().size(), 1u);
    const NearbyParts::Unbounded& plane = scene.nearby_parts->unbounded()[0];
    EXPECT_FALSE(scene.aggregate->primitives().box(static_cast<std::size_t>(plane.id)).bounded());
    EXPECT_TRUE(plane.may_touch({700, 5, 0}, kReach));
    EXPECT_FALSE(plane.may_touch({0, 0, 0.01}, kReach));
    EXPECT_TRUE(plane.may_touch({0, 0, 0.01}, 0.02));
}

TEST(NearbyParts, WallsOfARoomAreTrianglesOfTheirOwn) {
    SceneMaker maker;
    TriangleMesh room;
    for (int i = 0; i < 8; ++i) room.positions.push_back(Box3{{-5, -5, 0}, {5, 5, 9}}.corner(i));
    room.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    maker.add(maker.mesh(room), maker.material(matt()));
    maker.add(BoxShape{{-1, -1, 0}, {1, 1, 1}}, maker.material(glass()));
    const Scene scene = maker.compile();
    EXPECT_FALSE(may_touch_below(scene, 0.1, 0.2));
    EXPECT_TRUE(may_touch(scene, Ray({0.1, 0.2, 0.5}, {0, 0, -1})));
}

TEST(NearbyParts, PlacedObjectsAreSearchedPartByPart) {
    SceneMaker maker;
    const MaterialId m = maker.material(glass());
    const ObjectIndex pair = maker.object("pair");
    maker.add(BoxShape{{-1, -1, 0}, {1, 1, 1}}, m, {}, pair);
    maker.add(BoxShape{{-1, -1, 1}, {0, 1, 2}}, m, {}, pair);
    maker.add(pair, m);
    maker.add(pair, m, Affine::translate({8, 0, 0}));
    const Scene scene = maker.compile();
    for (const double x : {0.0, 8.0}) {
        EXPECT_FALSE(may_touch_below(scene, x + 0.5, 0.3));
        EXPECT_FALSE(may_touch_below(scene, x - 0.5, 0.3));
        EXPECT_FALSE(may_touch_above(scene, x - 0.5, 0.3));
        EXPECT_TRUE(may_touch(scene, Ray({x - 0.5, 0.3, 0.5}, {0, 0, 1})));
    }
}

TEST(NearbyParts, AMovingPartIsNearAllThatItPasses) {
    SceneMaker maker;
    const MaterialId m = maker.material(glass());
    maker.add(BoxShape{{5, -1, 0}, {7, 1, 1}}, m);
    maker.add(BoxShape{{-5, -1, 0}, {-3, 1, 1}}, m);
    maker.add(BoxShape{{0, -1, 1}, {2, 1, 2}}, m);
    PartMotion motion;
    motion.keys = {{0.0, Affine{}}, {1.0, Affine::translate({8, 0, 0})}};
    maker.description().objects[0].parts.back().motion = std::make_shared<const PartMotion>(motion);
    const Scene scene = maker.compile("wide_bvh");
    ASSERT_TRUE(scene.has_motion);
    EXPECT_TRUE(may_touch_below(scene, 6, 0.3));
    EXPECT_FALSE(may_touch_below(scene, -4, 0.3));
}

TEST(NearbyParts, OfBoxesOnALatticeNoneIsHitWhereNoneIsNear) {
    std::size_t skipped = 0, searched = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const auto number = [&](int n) { return static_cast<int>(random() % unsigned(n)); };
        SceneMaker maker;
        const MaterialId materials[] = {maker.material(glass()), maker.material(matt())};
        const int count = 1 + number(12);
        for (int i = 0; i < count; ++i) {
            const Vec3 lo{double(number(6)), double(number(6)), double(number(6))};
            const Vec3 size{1.0 + number(3), 1.0 + number(3), 1.0 + number(3)};
            const MaterialId m = materials[number(4) == 0];
            if (number(4) == 0) {
                maker.add(Sphere{lo, size.x}, m);
            } else {
                maker.add(BoxShape{lo, lo + size}, m);
            }
        }
        const Scene scene = maker.compile("wide_bvh");
        for (int k = 0; k < 50; ++k) {
            const Vec3 from{number(17) * 0.5, number(17) * 0.5, number(17) * 0.5};
            const int axis = number(3);
            const Ray ray(
                from, Vec3{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0});
            Hit hit;
            if (!scene.aggregate->closest(ray, hit, {nullptr})) continue;
            const Surface surface = surface_at(*scene.aggregate, ray, hit);
            const double reach = LeavingRays::margin(surface);
            if (scene.nearby_parts->may_touch(surface, reach)) {
                ++searched;
                continue;
            }
            ++skipped;
            std::vector<Hit> hits;
            scene.aggregate->all_hits(
                Ray(surface.point - reach * ray.direction, ray.direction, 0.0, 2 * reach), hits,
                {nullptr});
            for (const Hit& other : hits) {
                EXPECT_EQ(parts_of(*scene.aggregate, other), parts_of(*scene.aggregate, hit))
                    << "seed " << seed << ", ray " << k;
            }
        }
    }
    EXPECT_GT(skipped, 100u);
    EXPECT_GT(searched, 100u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
