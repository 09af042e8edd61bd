#include "alhazen/tracer/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "unit/tracer/tracer_cases.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mixed_scene;
using testing::random_rays;
using testing::same_hit;

TEST(Tracer, AHitTellsItsGeometryTriangleAndPlace) {
    TracerScene scene;
    const std::vector<Vec3> corners{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
    const GeometryId ball = scene.add_sphere({10, 0, 0}, 1);
    const GeometryId square = scene.add_mesh(corners, triangles);
    EXPECT_EQ(ball, GeometryId{0});
    EXPECT_EQ(square, GeometryId{1});
    const Tracer tracer(std::move(scene));
    EXPECT_EQ(tracer.geometry_count(), 2u);

    Hit hit;
    const Ray down{{0.5, 1.5, 4}, {0, 0, -2}};
    ASSERT_TRUE(tracer.intersect(down, hit));
    EXPECT_EQ(hit.t, 2.0) << "in units of the direction";
    EXPECT_EQ(hit.u, 0.25) << "weight of the second vertex, (2, 2)";
    EXPECT_EQ(hit.v, 0.5) << "weight of the third vertex, (0, 2)";
    const HitDetails at = tracer.details(down, hit);
    EXPECT_EQ(at.geometry, square);
    EXPECT_EQ(at.primitive, 1u);
    EXPECT_TRUE(at.instances.empty());
    EXPECT_EQ(at.point, (Vec3{0.5, 1.5, 0}));
    EXPECT_EQ(at.normal, (Vec3{0, 0, 1}));

    const Ray along{{5, 0, 0}, {1, 0, 0}};
    ASSERT_TRUE(tracer.intersect(along, hit));
    EXPECT_EQ(hit.t, 4.0);
    EXPECT_EQ(tracer.details(along, hit).geometry, ball);
    EXPECT_EQ(tracer.details(along, hit).normal, (Vec3{-1, 0, 0}));
    EXPECT_FALSE(tracer.intersect({{5, 0, 0}, {-1, 0, 1}}, hit));
    EXPECT_FALSE(hit.found());
}

TEST(Tracer, TrianglesAreCountedInEachMeshFromZero) {
    TracerScene scene;
    for (int mesh = 0; mesh < 3; ++mesh) {
        std::vector<float> coordinates;
        std::vector<std::uint32_t> indices;
        for (int i = 0; i < 4; ++i) {
            const float x = float(10 * mesh + i);
            for (const float c : {x, 0.f, 0.f, x + 0.5f, 0.f, 0.f, x, 1.f, 0.f}) {
                coordinates.push_back(c);
            }
            for (int k = 0; k < 3; ++k) indices.push_back(std::uint32_t(3 * i + k));
        }
        scene.add_mesh(coordinates, indices);
        scene.add_mesh(std::vector<Vec3>{}, std::vector<std::array<std::uint32_t, 3>>{});
    }
    const Tracer tracer(std::move(scene));
    for (int mesh = 0; mesh < 3; ++mesh) {
        for (int i = 0; i < 4; ++i) {
            const Ray ray{{10 * mesh + i + 0.1, 0.1, 1}, {0, 0, -1}};
            Hit hit;
            ASSERT_TRUE(tracer.intersect(ray, hit));
            const HitDetails at = tracer.details(ray, hit);
            EXPECT_EQ(at.geometry, GeometryId(2 * mesh));
            EXPECT_EQ(at.primitive, std::uint32_t(i));
        }
    }
}

TEST(Tracer, TransformsPlaceGeometryAndNormalsStayOutward) {
    const Affine mirrored{Affine::scale({-2, 1, 1}).linear, {5, 0, 0}};
    const std::vector<Vec3> corners{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const std::vector<std::array<std::uint32_t, 3>> triangles{
        {0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    TracerScene inner;
    inner.add_mesh(corners, triangles);
    TracerScene scene;
    scene.add_mesh(corners, triangles, {.world_from_geometry = mirrored});
    scene.add_sphere({}, 1, {.world_from_geometry = Affine::translate({-20, 0, 0}) * mirrored});
    scene.add_instance(Tracer(inner),
                       {.world_from_geometry = Affine::translate({20, 0, 0}) * mirrored});
    const Tracer tracer(std::move(scene));
    for (const double x : {5.0, -15.0, 25.0}) {
        Hit hit;
        const Ray ray{{x - 0.2, 0.3, 5}, {0, 0, -1}};
        ASSERT_TRUE(tracer.intersect(ray, hit)) << x;
        const HitDetails at = tracer.details(ray, hit);
        EXPECT_GT(at.normal.z, 0.1) << x;
        EXPECT_LT(at.error.x + at.error.y + at.error.z, 1e-12);
        EXPECT_NEAR(at.point.x, x - 0.2, 1e-12);
    }
}

TEST(Tracer, InstancesAreNamedFromTheOutermostInward) {
    TracerScene leaf;
    leaf.add_sphere({100, 0, 0}, 1);
    leaf.add_sphere({}, 1);
    TracerScene pair;
    const Tracer leaf_tracer(std::move(leaf));
    pair.add_instance(leaf_tracer, {.world_from_geometry = Affine::translate({-2, 0, 0})});
    pair.add_instance(leaf_tracer, {.world_from_geometry = Affine::translate({2, 0, 0})});
    TracerScene scene;
    scene.add(Plane{.point = {0, 0, -10}});
    scene.add_instance(Tracer(std::move(pair)),
                       {.world_from_geometry = Affine::translate({0, 5, 0})});
    const Tracer tracer(std::move(scene));
    const Ray ray{{2, 5, 9}, {0, 0, -1}};
    std::vector<Hit> hits;
    tracer.all_hits(ray, hits);
    ASSERT_EQ(hits.size(), 3u);
    const HitDetails at = tracer.details(ray, hits[1]);
    EXPECT_EQ(at.geometry, GeometryId{1});
    ASSERT_EQ(at.instances.size(), 2u);
    EXPECT_EQ(at.instances[0], GeometryId{1});
    EXPECT_EQ(at.instances[1], GeometryId{1});
    EXPECT_EQ(at.point, (Vec3{2, 5, -1}));
    EXPECT_EQ(tracer.details(ray, hits[2]).geometry, GeometryId{0});
    EXPECT_TRUE(tracer.details(ray, hits[2]).instances.empty());
}

TEST(Tracer, EveryAcceleratorAndBatchGivesTheHitsOfTheList) {
    const TracerScene scene = mixed_scene(7);
    const Tracer list(scene, {.accelerator = "list"});
    const std::vector<Ray> rays = random_rays(8, 2000);
    std::size_t found = 0;
    for (const AcceleratorEntry& entry : accelerator_table()) {
        const Tracer tracer(scene, {.accelerator = entry.name});
        std::vector<Hit> hits(rays.size());
        tracer.intersect(rays, hits);
        const auto occluded = std::make_unique<bool[]>(rays.size());
        tracer.occluded(rays, {occluded.get(), rays.size()});
        HitLists lists;
        tracer.all_hits(rays, lists);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Hit hit, single;
            std::vector<Hit> all, all_single;
            ASSERT_EQ(list.intersect(rays[i], hit), tracer.intersect(rays[i], single)) << i;
            list.all_hits(rays[i], all);
            tracer.all_hits(rays[i], all_single);
            ASSERT_TRUE(same_hit(hit, single) && same_hit(hit, hits[i])) << entry.name << i;
            ASSERT_EQ(occluded[i], hit.found()) << entry.name << i;
            ASSERT_EQ(tracer.occluded(rays[i]), hit.found()) << entry.name << i;
            ASSERT_TRUE(std::ranges::equal(all, all_single, same_hit)) << entry.name << i;
            ASSERT_TRUE(std::ranges::equal(all, lists.of(i), same_hit)) << entry.name << i;
            found += hit.found();
        }
    }
    EXPECT_GT(found, rays.size() / 4);
}

/// Tiles of rays from a point, then incoherent rays: the hint is right for the first ones only.
std::vector<Ray> tiles_and_others() {
    std::vector<Ray> rays;
    for (int tile = 0; tile < 12; ++tile) {
        for (int i = 0; i < 64; ++i) {
            const double x = 0.02 * (8 * (tile % 4) + i % 8 - 16),
                         y = 0.02 * (8 * tile / 4.0 + i / 8.0 - 16);
            rays.push_back({{0, 0, 11}, {x, y, -1}});
            // As towards a light: all end at a common point.
            if (tile >= 8) rays.back() = {rays.back().at(9), -9 * rays.back().direction, 0, 1};
        }
    }
    for (const Ray& ray : random_rays(11, 300)) rays.push_back(ray);
    return rays;
}

TEST(Tracer, TheHintOfCoherenceChangesNoHit) {
    // Triangles only and spheres only use packets; few shapes use treeless packets.
    TracerScene spheres, few;
    std::mt19937_64 random(12);
    for (int i = 0; i < 60; ++i) spheres.add_sphere(testing::uniform_point(random, 6), 0.5);
    for (int i = 0; i < 3; ++i) few.add_sphere(testing::uniform_point(random, 3), 2);
    std::vector<Vec3> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const Vec3 center = testing::uniform_point(random, 6);
        for (int k = 0; k < 3; ++k) corners.push_back(center + testing::uniform_point(random, 1));
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    TracerScene mesh;
    mesh.add_mesh(corners, triangles, {.visible_to = 6});
    const std::vector<Ray> rays = tiles_and_others();
    for (const TracerScene& scene : {mesh, spheres, few, mixed_scene(9)}) {
        const Tracer tracer(scene);
        for (const RayMask mask : {kAllRays, RayMask{2}, RayMask{1}}) {
            std::vector<Hit> any(rays.size()), coherent(rays.size());
            const auto answers = std::make_unique<bool[]>(2 * rays.size());
            const std::span<bool> any_occluded(answers.get(), rays.size());
            const std::span<bool> occluded(answers.get() + rays.size(), rays.size());
            tracer.intersect(rays, any, mask);
            tracer.intersect(rays, coherent, mask, Coherence::Coherent);
            tracer.occluded(rays, any_occluded, mask);
            tracer.occluded(rays, occluded, mask, Coherence::Coherent);
            std::size_t found = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(any[i].found(), coherent[i].found()) << i;
                ASSERT_TRUE(!any[i].found() || same_hit(any[i], coherent[i])) << i;
                ASSERT_EQ(occluded[i], any[i].found()) << i;
                ASSERT_EQ(any_occluded[i], any[i].found()) << i;
                found += any[i].found();
            }
            const bool seen = tracer.geometry_count() > 1 || mask != 1;
            EXPECT_EQ(found > 50, seen);
        }
    }
}

TEST(Tracer, InvalidRaysHitNothingAloneAndInBatches) {
    const Tracer tracer(mixed_scene(1));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    std::vector<Ray> rays(20, Ray{{0, 0, 30}, {0, 0, -1}});
    rays[1].origin.x = nan;
    rays[3].origin.y = inf;
    rays[5].direction = {};
    rays[7].direction.z = nan;
    rays[9].t_min = nan;
    rays[11].t_max = -1;
    std::vector<Hit> hits(rays.size());
    tracer.intersect(rays, hits);
    const auto occluded = std::make_unique<bool[]>(rays.size());
    tracer.occluded(rays, {occluded.get(), rays.size()});
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool valid = i % 2 == 0 || i > 11;
        Hit hit;
        EXPECT_EQ(tracer.intersect(rays[i], hit), valid) << i;
        EXPECT_EQ(hits[i].found(), valid) << i;
        EXPECT_EQ(occluded[i], valid) << i;
        EXPECT_EQ(tracer.occluded(rays[i]), valid) << i;
    }
}

TEST(Tracer, AnEmptySceneHitsNothing) {
    const Tracer tracer{TracerScene{}};
    Hit hit;
    EXPECT_FALSE(tracer.intersect({{}, {0, 0, 1}}, hit));
    EXPECT_FALSE(tracer.occluded({{}, {0, 0, 1}}));
    EXPECT_TRUE(tracer.box().empty());
    TracerScene around;
    around.add_instance(tracer);
    EXPECT_FALSE(Tracer(std::move(around)).occluded({{}, {0, 0, 1}}));
}

TEST(Tracer, WrongUseIsRefused) {
    const Tracer tracer(mixed_scene(2));
    const std::vector<Ray> rays(3, Ray{{}, {0, 0, 1}});
    std::vector<Hit> hits(2);
    bool occluded[4];
    EXPECT_THROW(tracer.intersect(rays, hits), Error);
    EXPECT_THROW(tracer.occluded(rays, occluded), Error);
    EXPECT_THROW((void)tracer.details(rays[0], Hit{}), Error);
    Hit foreign;
    foreign.primitive = PrimitiveId{1u << 30};
    EXPECT_THROW((void)tracer.details(rays[0], foreign), Error);
    foreign.primitive = PrimitiveId{0};
    foreign.path.push_back(PrimitiveId{0});
    EXPECT_THROW((void)tracer.details(rays[0], foreign), Error) << "a sphere is no instance";
    EXPECT_THROW((void)Tracer(TracerScene{}, {.accelerator = "magic"}), Error);
}

TEST(Tracer, SpansAndPointsInsideNameTheGeometry) {
    TracerScene inner;
    inner.add_sphere({0, 0, 0}, 1);
    TracerScene scene;
    scene.add(Plane{});
    scene.add(BoxShape{{-1, -1, -1}, {1, 1, 1}});
    scene.add_instance(Tracer(std::move(inner)),
                       {.world_from_geometry = Affine::translate({5, 0, 0})});
    const Tracer tracer(std::move(scene));
    const SolidQueries solids = tracer.solids();
    ASSERT_EQ(solids.solids().count(), 2u);
    SpanList list;
    const Ray ray{{0, 0, 0.5}, {1, 0, 0}};
    solids.spans(ray, list);
    ASSERT_EQ(list.spans.size(), 2u);
    EXPECT_FALSE(list.spans[0].entry.is_crossing);
    EXPECT_EQ(list.spans[0].exit.t, 1);
    EXPECT_EQ(solids.solids().place(list.spans[1].solid).parts, (std::vector<std::uint32_t>{2, 0}));
    EXPECT_NEAR(solids.entry_surface(ray, list.spans[1]).point.x, 5 - std::sqrt(0.75), 1e-14);
    const std::vector<Vec3> points{{5, 0, 0}, {0, 0, 1}, {3, 0, 0}};
    const auto found = solids.inside(points);
    EXPECT_EQ(found[0], (std::vector<Containment>{{list.spans[1].solid, false}}));
    EXPECT_EQ(found[1], (std::vector<Containment>{{list.spans[0].solid, true}}));
    EXPECT_TRUE(found[2].empty());
    EXPECT_NEAR(solids.thickness(ray, list).inside_any, 1 + 2 * std::sqrt(0.75), 1e-14);
}

TEST(Tracer, RaysLeaveTheSurfaceTheyStartOn) {
    TracerScene scene;
    scene.add_sphere({1e5, 0, 0}, 1);
    const Tracer tracer(std::move(scene));
    const Ray ray{{1e5, 0.3, 9}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(tracer.intersect(ray, hit));
    const HitDetails at = tracer.details(ray, hit);
    EXPECT_FALSE(tracer.occluded(leaving_ray(at, {0, 0, 1})));
    EXPECT_TRUE(tracer.occluded(leaving_ray(at, {0, 0, -1})));
}

TEST(Tracer, DirectionsOfAnyLengthMeetTheSame) {
    TracerScene scene;
    scene.add_sphere({0, 0, 0}, 1);
    const std::vector<Vec3> corners{{4, -1, -1}, {4, 3, -1}, {4, -1, 3}};
    const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
    scene.add_mesh(corners, triangles);
    const Tracer tracer(std::move(scene));
    for (const Vec3& origin : {Vec3{-3, 0.25, 0.5}, Vec3{2, 0.25, 0.5}, Vec3{5, 0, 0}}) {
        const Ray ray{origin, {1, 0.125, 0}};
        Hit usual;
        const bool found = tracer.intersect(ray, usual);
        for (const int exponent : {-700, -531, 531, 1000}) {
            const Ray scaled{origin, {std::ldexp(1.0, exponent), std::ldexp(0.125, exponent), 0}};
            Hit hit;
            ASSERT_EQ(tracer.intersect(scaled, hit), found) << exponent;
            EXPECT_EQ(tracer.occluded(scaled), found) << exponent;
            std::vector<Hit> hits, usual_hits;
            tracer.all_hits(scaled, hits);
            tracer.all_hits(ray, usual_hits);
            EXPECT_EQ(hits.size(), usual_hits.size());
            // In a batch with a ray of usual length.
            const std::array<Ray, 2> rays{scaled, ray};
            std::array<Hit, 2> batch;
            std::array<bool, 2> blocked{};
            tracer.intersect(rays, batch);
            tracer.occluded(rays, blocked);
            EXPECT_EQ(blocked[0], found);
            EXPECT_EQ(batch[1].t, usual.t);
            EXPECT_EQ(batch[0].t, hit.t);
            if (!found) continue;
            EXPECT_EQ(hit.t, std::ldexp(usual.t, -exponent)) << exponent;
            EXPECT_EQ(hit.primitive, usual.primitive);
            EXPECT_EQ(tracer.details(scaled, hit).point, tracer.details(ray, usual).point);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
