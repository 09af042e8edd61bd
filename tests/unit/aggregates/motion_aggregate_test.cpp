#include "alhazen/aggregates/motion/motion_aggregate.h"

#include <gtest/gtest.h>

#include <random>

#include "alhazen/primitives/surface.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

std::vector<TransformKey> keys_of(std::mt19937_64& random) {
    std::uniform_real_distribution<double> number(-1, 1);
    const auto vector = [&] { return Vec3{number(random), number(random), number(random)}; };
    std::vector<TransformKey> keys;
    const Vec3 place = 3 * vector();
    for (const double time : {0.1, 0.6, 1.2}) {
        keys.push_back({time, Affine::translate(place + 0.6 * vector()) *
                                  Affine::rotate(vector(), number(random)) *
                                  Affine::scale({1, 1 + 0.3 * number(random), 1})});
    }
    return keys;
}

/// Objects that rest, move, deform, and move inside of moving objects.
SceneDescription scene_in_motion() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> number(-1, 1);
    SceneMaker maker;
    Material glass, single;
    glass.transmissive.color = {0.5, 0.5, 0.5};
    single.double_sided = false;
    const MaterialId matt = maker.material({}), clear = maker.material(glass),
                     front = maker.material(single);
    SceneDescription& d = maker.description();
    const auto move = [&](std::size_t object, const Affine& inner) {
        Part& part = d.objects[object].parts.back();
        part.motion = std::make_shared<const PartMotion>(PartMotion{
            object == 0 ? Affine{} : Affine::translate({0.2, 0, 0}), keys_of(random), inner});
    };
    maker.add(Plane{.point = {0, 0, -6}, .normal = {0, 0, 1}}, matt);
    for (int i = 0; i < 12; ++i) {
        maker.add(Sphere{.center = {number(random) * 3, number(random) * 3, number(random)},
                         .radius = 0.3},
                  i % 2 == 0 ? matt : clear);
        if (i < 8) move(0, i % 3 == 0 ? Affine::scale({1, 2, 1}) : Affine{});
    }
    const MeshIndex shared = maker.mesh(testing::tetrahedron());
    maker.add(shared, front);
    move(0, Affine::scale({0.5, 0.5, 0.5}));
    maker.add(shared, matt, Affine::translate({-2, 2, 0}));
    // A mesh that deforms; three keys, one inside of the shutter.
    TriangleMesh bent = testing::tetrahedron();
    const MeshIndex deforming = maker.mesh(bent);
    for (const double time : {0.0, 0.4, 1.0}) {
        MeshKey key{time, bent.positions, {}};
        for (Vec3& p : key.positions) p += 0.4 * Vec3{number(random), number(random), 0};
        d.meshes[static_cast<std::size_t>(deforming)].keys.push_back(key);
    }
    maker.add(deforming, front, Affine::translate({2, -2, 0}));
    maker.add(deforming, clear, Affine::translate({2, 2, 1}));
    move(0, Affine{});
    // An object of moving parts, placed twice: at rest, and moving.
    const ObjectIndex swarm = maker.object("swarm");
    for (int i = 0; i < 3; ++i) {
        maker.add(BoxShape{}, i == 1 ? clear : matt, {}, swarm);
        if (i > 0) move(static_cast<std::size_t>(swarm), Affine::scale({0.3, 0.3, 0.3}));
    }
    maker.add(swarm, matt, Affine::translate({0, 0, 2}));
    maker.add(swarm, matt);
    move(0, Affine::scale({0.5, 0.5, 0.5}));
    d.shutter = {0, 1};
    open_shutter(d, d.shutter);
    return d;
}

/// The same with everything at rest, as it is at that moment.
Scene frozen(SceneDescription d, double time) {
    // Meshes are shared with the original.
    for (MeshDescription& mesh : d.meshes) mesh.mesh = std::make_shared<TriangleMesh>(*mesh.mesh);
    open_shutter(d, {time, time});
    for (MeshDescription& mesh : d.meshes) mesh.keys.clear();
    for (ObjectDescription& object : d.objects) {
        for (Part& part : object.parts) part.motion = nullptr;
    }
    Scene scene = compile(d, {.accelerator = "list"});
    EXPECT_FALSE(scene.has_motion);
    return scene;
}

std::vector<Ray> random_rays(int count) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        Ray ray{{6 * number(random), 6 * number(random), 5}, {}};
        const Vec3 aim{4 * number(random), 4 * number(random), 2 * number(random)};
        ray.direction = aim - ray.origin;
        if (i % 3 == 0) ray.t_max = 1.2;
        rays.push_back(ray);
    }
    return rays;
}

TEST(MotionAggregate, AtEveryMomentItIsTheSceneFrozenThen) {
    const SceneDescription d = scene_in_motion();
    Diagnostics diagnostics;
    validate(d, diagnostics);
    ASSERT_EQ(diagnostics.error_count(), 0u) << to_string(diagnostics.all().front());
    const Scene moving = compile(d);
    ASSERT_TRUE(moving.has_motion);
    EXPECT_GT(moving.census.moving_things, 15u);
    const std::vector<Ray> rays = random_rays(3000);
    for (const float time : {0.0f, 0.25f, 0.5f, 0.8f, 0.999f}) {
        SCOPED_TRACE(time);
        const Scene still = frozen(d, time);
        int found = 0, apart = 0;
        for (const Ray& ray : rays) {
            const RayQuery query{nullptr, kAllRays, time};
            Hit a, b;
            const bool hit = moving.aggregate->closest(ray, a, query);
            EXPECT_EQ(moving.aggregate->occluded(ray, query), hit);
            if (still.aggregate->closest(ray, b, {nullptr}) != hit ||
                (hit && std::abs(a.t - b.t) > 1e-9)) {
                ++apart;  // a ray along an edge
                continue;
            }
            found += hit;
            if (hit) {
                const Surface s = surface_at(*moving.aggregate, ray, a, time);
                const Surface t = surface_at(*still.aggregate, ray, b);
                EXPECT_LT(length(s.point - t.point), 1e-9);
                EXPECT_LT(length(s.normal - t.normal), 1e-7);
                EXPECT_EQ(s.materials[0], t.materials[0]);
                EXPECT_EQ(s.part, t.part);
                EXPECT_EQ(s.instance, t.instance);
            }
            std::vector<Hit> all, all_still;
            moving.aggregate->all_hits(ray, all, query);
            still.aggregate->all_hits(ray, all_still, {nullptr});
            ASSERT_EQ(all.size(), all_still.size());
            if (hit) {
                EXPECT_EQ(all.front().t, a.t);
            }
            for (std::size_t i = 0; i < all.size(); ++i) {
                EXPECT_NEAR(all[i].t, all_still[i].t, 1e-9);
            }
            std::vector<Hit> tints, tints_still;
            const bool dark = moving.aggregate->shadowed(ray, tints, query);
            EXPECT_EQ(still.aggregate->shadowed(ray, tints_still, {nullptr}), dark);
            if (!dark) {
                EXPECT_EQ(tints.size(), tints_still.size());
            }
        }
        EXPECT_GT(found, 1500);
        EXPECT_LE(apart, 2);
    }
}

TEST(MotionAggregate, BatchesAreSingleRaysAtTheirTimes) {
    const Scene scene = compile(scene_in_motion());
    const std::vector<Ray> rays = random_rays(500);
    std::vector<float> times;
    for (std::size_t i = 0; i < rays.size(); ++i) times.push_back(float(i % 97) / 97);
    std::vector<Hit> hits(rays.size());
    const auto met = std::make_unique<bool[]>(rays.size());
    scene.aggregate->closest_batch_at(rays, times, hits, {nullptr}, Coherence::Any);
    scene.aggregate->occluded_batch_at(rays, times, {met.get(), rays.size()}, {nullptr},
                                       Coherence::Any);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit one;
        const bool hit = scene.aggregate->closest(rays[i], one, {nullptr, kAllRays, times[i]});
        EXPECT_EQ(hits[i].found(), hit);
        EXPECT_EQ(met[i], hit);
        if (!hit) continue;
        EXPECT_EQ(hits[i].t, one.t);
        EXPECT_EQ(hits[i].primitive, one.primitive);
        EXPECT_TRUE(hits[i].path == one.path);
    }
}

/// One resting `shape`, visible to reflected rays only if `masked`; balls slide in front of it.
SceneDescription sliding_balls_before(const AnyShape& shape, bool masked) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    SceneMaker maker;
    const MaterialId matt = maker.material({});
    SceneDescription& d = maker.description();
    maker.add(shape, matt);
    if (masked) d.objects[0].parts.back().visible_to = mask_of(RayKind::Reflection);
    for (int i = 0; i < 20; ++i) {
        maker.add(Sphere{.center = {number(random) * 3, number(random) * 3, number(random)},
                         .radius = 0.5},
                  matt);
        const Vec3 way{number(random), number(random), number(random)};
        d.objects[0].parts.back().motion = std::make_shared<const PartMotion>(
            PartMotion{{}, {{0, Affine{}}, {1, Affine::translate(way)}}, {}});
    }
    d.shutter = {0, 1};
    open_shutter(d, d.shutter);
    return d;
}

TEST(MotionAggregate, OneShapeThatRestsIsMetAsInTheFrozenScene) {
    // The sphere has a test in lanes, the polygon has none.
    const Polygon floor{.vertices = {{-4, -4, -2}, {4, -4, -2}, {4, 4, -2}, {-4, 4, -2}}};
    const std::vector<Ray> rays = random_rays(500);
    const std::vector<float> times(rays.size(), 0.5f);
    for (const AnyShape& shape : {AnyShape{floor}, AnyShape{Sphere{{0, 0, -9}, 7}}}) {
        for (const bool masked : {false, true}) {
            const SceneDescription d = sliding_balls_before(shape, masked);
            const Scene moving = compile(d), still = frozen(d, 0.5);
            EXPECT_EQ(moving.census.moving_things, 20u);
            for (const RayMask mask : {mask_of(RayKind::Eye), mask_of(RayKind::Reflection)}) {
                std::vector<Hit> hits(rays.size());
                const auto met = std::make_unique<bool[]>(rays.size());
                const RayQuery query{nullptr, mask, 0.5f};
                moving.aggregate->closest_batch_at(rays, times, hits, query, Coherence::Any);
                moving.aggregate->occluded_batch_at(rays, times, {met.get(), rays.size()}, query,
                                                    Coherence::Any);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    Hit one, other;
                    const bool hit = still.aggregate->closest(rays[i], other, {nullptr, mask});
                    ASSERT_EQ(moving.aggregate->closest(rays[i], one, query), hit);
                    EXPECT_EQ(moving.aggregate->occluded(rays[i], query), hit);
                    EXPECT_EQ(met[i], hit);
                    ASSERT_EQ(hits[i].found(), hit);
                    if (!hit) continue;
                    EXPECT_NEAR(one.t, other.t, 1e-12);
                    EXPECT_EQ(hits[i].t, one.t);
                    EXPECT_TRUE(hits[i].path == one.path);
                }
            }
        }
    }
}

TEST(MotionAggregate, AShutterThatIsOpenForNoTimeShowsOneMoment) {
    SceneDescription d = scene_in_motion();
    open_shutter(d, {0.5, 0.5});
    const Scene scene = compile(d);
    for (const Ray& ray : random_rays(200)) {
        Hit first, last;
        (void)scene.aggregate->closest(ray, first, {nullptr, kAllRays, 0.0f});
        (void)scene.aggregate->closest(ray, last, {nullptr, kAllRays, 0.99f});
        ASSERT_EQ(first.found(), last.found());
        if (first.found()) {
            EXPECT_NEAR(first.t, last.t, 1e-12);
        }
    }
}

TEST(MotionAggregate, AnOperandOfASolidCannotMove) {
    SceneMaker maker;
    maker.add(Sphere{}, maker.material({}));
    SceneDescription& d = maker.description();
    d.objects[0].combine = Combine::Union;
    d.objects[0].parts[0].motion = std::make_shared<const PartMotion>(
        PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({1, 0, 0})}}, {}});
    Diagnostics diagnostics;
    validate(d, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 1u);
}

/// An object that moves in one that moves, and so on, with a part at rest beside each.
void add_chain(SceneMaker& maker, int levels) {
    SceneDescription& d = maker.description();
    const MaterialId matt = maker.material({});
    ObjectIndex last = maker.object("0");
    maker.add(Sphere{}, matt, {}, last);
    for (int i = 1; i <= levels; ++i) {
        const ObjectIndex next = i == levels ? d.root : maker.object(std::to_string(i));
        const Affine inner = Affine::translate({0.1, 0, 0});
        maker.add(last, MaterialId{0}, inner, next);
        d.objects[static_cast<std::size_t>(next)].parts.back().motion =
            std::make_shared<const PartMotion>(
                PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({0, 0, 0.1})}}, inner});
        maker.add(Sphere{{0, 5, 0}, 1}, matt, {}, next);
        last = next;
    }
}

TEST(MotionAggregate, ALongChainOfMovingObjectsIsAFaultOfTheScene) {
    SceneMaker supported;
    add_chain(supported, 10);
    EXPECT_TRUE(supported.compile().has_motion);
    SceneMaker deep;
    add_chain(deep, 20);
    try {
        (void)deep.compile();
        FAIL() << "expected an error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Scene);
        EXPECT_NE(std::string(error.what()).find("nested too deep"), std::string::npos);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
