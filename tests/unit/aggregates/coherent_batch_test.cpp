// The coherence hint changes no hit, whatever the rays are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/schedule.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "support/thorough.h"
#include "unit/aggregates/coherent_rays.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Triangles and spheres. Packets use frusta in a tree with placed primitives, lanes in one
/// without.
PrimitiveTable triangles_and_spheres(int count, double size, std::uint64_t seed, bool placed) {
    RandomEngine random(seed);
    TableBuilder builder;
    if (placed) builder.table.placements.emplace_back();
    for (int i = 0; i < count; ++i) {
        const Vec3 a = uniform_point(random, size);
        builder.add_triangle(a, a + uniform_point(random, 0.2 * size),
                             a + uniform_point(random, 0.2 * size), random() % 3 != 0);
        if (placed && i > 0) continue;
        builder.add_sphere(uniform_point(random, size), uniform(random, 0.01, 0.1) * size,
                           random() % 3 != 0, placed ? 0 : kNoPlacement);
    }
    return builder.finish();
}

template <class Shape>
void add_shape(TableBuilder& builder, Shape shape) {
    auto& column = std::get<ShapeColumn<Shape>>(builder.table.columns);
    shape.prepare();
    column.shapes.push_back(shape);
    column.placements.push_back(kNoPlacement);
    column.materials.push_back(MaterialId{0});
}

/// Triangles and spheres, and as many cylinders, cones and discs in turn: a tree of packets in
/// lanes.
PrimitiveTable triangles_and_round_bodies(int count, double size, double part, std::uint64_t seed) {
    RandomEngine random(seed);
    TableBuilder builder;
    for (int i = 0; i < count; ++i) {
        const Vec3 a = uniform_point(random, size);
        builder.add_triangle(a, a + uniform_point(random, part), a + uniform_point(random, part));
        builder.add_sphere(uniform_point(random, size), uniform(random, 0.1, 0.5) * part);
        const Vec3 base = uniform_point(random, size);
        const Vec3 top = base + uniform_point(random, part);
        const double radius = uniform(random, 0.1, 0.3) * part;
        if (i % 3 == 0) add_shape(builder, Cylinder{.base = base, .top = top, .radius = radius});
        if (i % 3 == 1) add_shape(builder, Cone{.base = base, .top = top, .base_radius = radius});
        if (i % 3 == 2) add_shape(builder, Disc{.center = base, .normal = top, .radius = radius});
    }
    return builder.finish();
}

std::vector<std::pair<std::string, PrimitiveTable>> tables(double size, std::uint64_t seed) {
    return {{"many triangles", random_triangles(800, size, 0.1 * size, seed)},
            {"large triangles", random_triangles(60, size, size, seed)},
            {"triangles and a placed sphere", triangles_and_spheres(400, size, seed, true)},
            {"triangles and spheres", triangles_and_spheres(200, size, seed, false)},
            {"triangles and round bodies", triangles_and_round_bodies(150, size, 0.2 * size, seed)},
            {"spheres", random_spheres(300, size, 0.1 * size, seed)},
            {"mixture", random_mixture(300, size, 0.2 * size, seed)}};
}

TEST(CoherentBatch, EyeRaysHitWhatTheListHits) {
    RandomEngine random(1);
    for (const auto& [name, table] : tables(1, 2)) {
        for (int i = 0; i < cases(4, 8); ++i) {
            const Vec3 eye = uniform_point(random, 3);
            const double width = i % 4 == 0 ? 0.01 : i % 4 == 1 ? 0.3 : i % 4 == 2 ? 1.5 : 8;
            const Vec3 aim = uniform_point(random, 0.3);
            compare("eye rays at " + name, table, eye_rays(eye, aim - eye, width, 20), false);
        }
        compare("eye rays at " + name, table, eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.7, 30));
    }
}

TEST(CoherentBatch, ShadowRaysAreBlockedAsTheListSays) {
    RandomEngine random(3);
    for (const auto& [name, table] : tables(1, 4)) {
        for (int i = 0; i < 8; ++i) {
            const Vec3 from = uniform_point(random, 1);
            const Vec3 light = uniform_point(random, i < 4 ? 2 : 12);
            const double width = i % 2 == 0 ? 0.02 : 0.3;
            if (!thorough() && i % 4 > 1) continue;
            compare("shadow rays at " + name, table, shadow_rays(from, width, light, 20), false);
        }
        compare("shadow rays at " + name, table,
                shadow_rays({-1.2, -1.1, -1.3}, 0.3, {1.5, 1.3, 1.4}, 30));
    }
}

TEST(CoherentBatch, PacketsOfAnySizeAreTracedInFull) {
    const Rays rays = eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.7, 14);
    std::vector<std::size_t> sizes = {48, 63, 64, 65, 79, 80, 127, 129};
    for (std::size_t size = 1; size <= 33; ++size) sizes.push_back(size);
    for (const auto& [name, table] : tables(1, 5)) {
        for (const std::size_t size : sizes) {
            compare(std::to_string(size) + " rays at " + name, table,
                    {rays.begin(), rays.begin() + size}, false);
        }
        compare("no rays at " + name, table, {}, false);
    }
}

TEST(CoherentBatch, InvalidRaysAmongOthersHitNothingAndChangeNothing) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [name, table] : tables(1, 6)) {
        RandomEngine random(7);
        Rays rays = eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.7, 24);
        for (Ray& ray : rays) {
            switch (random() % 40) {
                case 0:
                    ray.origin.x = nan;
                    break;
                case 1:
                    ray.direction.y = nan;
                    break;
                case 2:
                    ray.direction = {};
                    break;
                case 3:
                    ray.t_min = 2, ray.t_max = 1;
                    break;
                case 4:
                    ray.t_max = nan;
                    break;
                case 5:
                    ray.origin.z = kInf;
                    break;
                case 6:
                    ray.direction.z = -kInf;
                    break;
                case 7:
                    ray.direction = 1e-300 * ray.direction;
                    break;
                case 8:
                    ray.direction = 1e200 * ray.direction;
                    break;
                case 9:
                    ray.origin = ray.origin - 1e9 * ray.direction;
                    break;
                case 10:
                    ray.direction = -ray.direction;
                    break;
                case 11:
                    ray.direction = {1, 0.1, 0.2};
                    break;
                case 12:
                    ray.t_min = -5;
                    break;
                default:
                    break;
            }
        }
        compare("invalid rays at " + name, table, rays);
        rays.assign(100, Ray{{nan, 0, 0}, {1, 0, 0}});
        compare("invalid rays only at " + name, table, rays, false);
    }
}

TEST(CoherentBatch, RangesOfRaysHold) {
    for (const auto& [name, table] : tables(1, 8)) {
        RandomEngine random(9);
        Rays rays = eye_rays({0.1, 0.2, 2}, {0, 0, -1}, 0.7, 24);
        for (Ray& ray : rays) {
            ray.t_min = uniform(random, 0, 3);
            ray.t_max = ray.t_min + (random() % 2 == 0 ? 0.2 : 1e-6);
        }
        compare("short rays at " + name, table, rays);
        // Ranges that end exactly at the hit, begin there, or just miss it.
        const auto list = make_aggregate("list", table);
        for (Ray& ray : rays) {
            ray.t_min = 0;
            ray.t_max = kInf;
            Hit hit;
            if (!list->closest(ray, hit, nullptr)) continue;
            const auto which = random() % 4;
            if (which == 0) ray.t_max = hit.t;
            if (which == 1) ray.t_max = std::nextafter(hit.t, 0.0);
            if (which == 2) ray.t_min = hit.t;
            if (which == 3) ray.t_min = std::nextafter(hit.t, 9.0);
        }
        compare("ranges that end at hits of " + name, table, rays);
    }
}

TEST(CoherentBatch, RangesThatFloatCannotTellHold) {
    for (const auto& [name, table] : tables(1, 20)) {
        Rays rays = eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.7, 24);
        const auto list = make_aggregate("list", table);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Ray& ray = rays[i];
            if (i % 4 == 0) ray.t_min = -0.0;
            if (i % 4 == 1) ray.t_min = -1e-60;
            Hit hit;
            if (i % 4 < 2 || !list->closest(ray, hit, nullptr)) continue;
            // Equal as floats; in the order of doubles, or against it.
            ray.t_min = i % 4 == 2 ? std::nextafter(hit.t, 0.0) : std::nextafter(hit.t, 9.0);
            ray.t_max = hit.t;
        }
        compare("ranges of no length at " + name, table, rays);
    }
}

TEST(CoherentBatch, RaysBesideThoseFromOnePointAreTheirOwn) {
    // All rays of a packet but one begin in the eye, that one beside it by a little or by much; the
    // least distances vanish in float, where the packet then seems to come from one point.
    const Vec3 eye{0.1, 0.2, 3};
    std::size_t turn = 0;
    for (const auto& [name, table] : tables(1, 31)) {
        for (const double aside : {1e-12, 1e-9, 1e-6, 1e-3, 0.3}) {
            ++turn;
            for (const std::size_t place : {0u, 5u, 13u}) {
                // Every day one place for each distance.
                if (!is_tried(place, 3, turn)) continue;
                Rays rays = eye_rays(eye, {0, 0, -1}, 0.7, 24);
                for (std::size_t i = place; i < rays.size(); i += 16) {
                    rays[i].origin += Vec3{aside, -0.5 * aside, 0.25 * aside};
                }
                compare("rays beside the eye at " + name, table, rays);
            }
        }
        Rays zeros = eye_rays({0, 0, 3}, {0, 0, -1}, 0.7, 24);
        for (std::size_t i = 0; i < zeros.size(); i += 3) zeros[i].origin.x = -0.0;
        compare("zeros of both signs at " + name, table, zeros);
    }
}

TEST(CoherentBatch, FarRaysAndOddScalesHitWhatTheListHits) {
    for (const double size : {1e-100, 1e-30, 1e-6, 1e6, 1e30, 1e100}) {
        std::ostringstream name;
        name << "size " << size;
        for (const auto& [kind, table] : tables(size, 11)) {
            // Every day about half of the tables.
            if (!is_tried(number_of(name.str() + kind), 2)) continue;
            Rays rays = eye_rays({0.1 * size, 0.2 * size, 3 * size}, {0, 0, -1}, 0.7, 12);
            compare(name.str() + ", " + kind, table, rays);
            for (Ray& ray : rays) ray.direction = size * ray.direction;
            // Products of 1e100 and 1e100, squared, overflow double: all spheres are missed.
            compare(name.str() + " with directions, " + kind, table, rays, size < 1e99);
        }
    }
    for (const double distance : {7.9, 8.5, 1e3, 1e6, 1e9, 1e12}) {
        const Vec3 eye{0.3 * distance, 0.2 * distance, distance};
        std::ostringstream name;
        name << "from " << distance;
        for (const auto& [kind, table] : tables(1, 12)) {
            if (!is_tried(number_of(name.str() + kind), 2)) continue;
            compare(name.str() + ", " + kind, table, eye_rays(eye, -eye, 1.5 / distance, 16));
            compare(name.str() + " to a light, " + kind, table,
                    shadow_rays({-1.2, -1.1, -1.3}, 0.3, eye, 16), false);
        }
    }
}

TEST(CoherentBatch, RaysThatAreNotCoherentHitWhatTheListHits) {
    for (const auto& [name, table] : tables(1, 13)) {
        RandomEngine random(14);
        const MakeRay make = random_rays(1);
        Rays rays;
        for (int i = 0; i < 1000; ++i) rays.push_back(make(random));
        compare("any rays at " + name, table, rays);
        for (Ray& ray : rays) ray.origin = {0.1, 0.2, 0.3};
        compare("rays from one point to everywhere at " + name, table, rays);
    }
}

TEST(CoherentBatch, NestedAggregatesGiveTheHitsOfNestedLists) {
    const auto nest = [](const char* name) {
        const std::shared_ptr<const Aggregate> inner =
            make_aggregate(name, random_mixture(60, 1, 0.3, 15));
        RandomEngine random(16);
        TableBuilder builder;
        for (int i = 0; i < 30; ++i) {
            Placement placement;
            placement.outer_from_inner.linear = {{0.2, 0, 0}, {0, 0.1, 0.1}, {0, -0.1, 0.1}};
            placement.outer_from_inner.translation = uniform_point(random, 1);
            placement.inner_from_outer = inverse(placement.outer_from_inner);
            builder.table.instances.push_back({.aggregate = inner, .placement = placement});
        }
        for (int i = 0; i < 100; ++i) {
            const Vec3 a = uniform_point(random, 1);
            builder.add_triangle(a, a + uniform_point(random, 0.2), a + uniform_point(random, 0.2));
        }
        return make_aggregate(name, builder.finish());
    };
    const auto list = nest("list");
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        compare_with(*list, *nest("wide_bvh"), eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.7, 24),
                     "instances on " + target);
        compare_with(*list, *nest("wide_bvh"),
                     shadow_rays({-1.2, -1.1, -1.3}, 0.3, {1.5, 1.3, 1.4}, 24),
                     "instances in shadow on " + target);
    }
}

TEST(CoherentBatch, PacketsShareTheWorkOfTheirRays) {
    const auto tree = make_aggregate("wide_bvh", random_triangles(3000, 1, 0.1, 17));
    const Rays rays = eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.2, 32);
    std::vector<Hit> hits(rays.size());
    TraversalStats any, coherent;
    tree->closest_batch(rays, hits, &any);
    tree->closest_batch(rays, hits, &coherent, Coherence::Coherent);
    EXPECT_GT(coherent.node_visits, 0u);
    EXPECT_LT(5 * coherent.node_visits, any.node_visits);
    const Rays shadows = shadow_rays({-1.2, -1.1, -1.3}, 0.2, {1.5, 1.3, 1.4}, 32);
    const auto occluded = std::make_unique<bool[]>(shadows.size());
    TraversalStats any_hit, coherent_any_hit;
    tree->occluded_batch(shadows, {occluded.get(), shadows.size()}, &any_hit);
    tree->occluded_batch(shadows, {occluded.get(), shadows.size()}, &coherent_any_hit,
                         Coherence::Coherent);
    EXPECT_GT(coherent_any_hit.node_visits, 0u);
    EXPECT_LT(3 * coherent_any_hit.node_visits, any_hit.node_visits);
}

TEST(CoherentBatch, PacketsShareTheWorkOfTheirRaysAtManyShapesWithoutATestInLanes) {
    const auto tree = make_aggregate("wide_bvh", triangles_and_round_bodies(1000, 1, 0.1, 18));
    const Rays shadows = shadow_rays({-1.2, -1.1, -1.3}, 0.2, {1.5, 1.3, 1.4}, 32);
    const auto occluded = std::make_unique<bool[]>(shadows.size());
    TraversalStats any, coherent;
    tree->occluded_batch(shadows, {occluded.get(), shadows.size()}, &any);
    tree->occluded_batch(shadows, {occluded.get(), shadows.size()}, &coherent, Coherence::Coherent);
    EXPECT_GT(coherent.node_visits, 0u);
    EXPECT_LT(2 * coherent.node_visits, any.node_visits);
}

TEST(CoherentBatch, TheTraversalFollowsWhatTheTreeHolds) {
    const auto traversal = [](std::size_t triangles, std::size_t spheres, std::size_t frustums,
                              std::size_t others, bool any_hit, std::size_t registers,
                              bool others_alone = false) {
        WideBvhLayout layout;
        layout.triangles.resize(triangles);
        layout.spheres.resize(spheres);
        layout.frustums.resize(frustums);
        layout.others.resize(others);
        return coherent_traversal(layout, any_hit, registers, others_alone);
    };
    constexpr std::size_t kAvx512 = 1, kAvx2 = 2, kSse4 = 4;
    for (const std::size_t registers : {kAvx512, kAvx2, kSse4}) {
        const CoherentTraversal closest =
            registers == kSse4 ? CoherentTraversal::Frusta : CoherentTraversal::Lanes;
        EXPECT_EQ(traversal(64, 0, 0, 0, false, registers), closest);
        EXPECT_EQ(traversal(0, 64, 0, 0, false, registers), closest);
        EXPECT_EQ(traversal(32, 32, 1, 0, false, registers), closest);
        EXPECT_EQ(traversal(32, 31, 1, 0, false, registers),
                  registers == kSse4 ? CoherentTraversal::Alone : CoherentTraversal::Lanes);
        EXPECT_EQ(traversal(64, 64, 0, 1, false, registers), CoherentTraversal::Frusta);
        EXPECT_EQ(traversal(64, 64, 0, 1, true, registers), CoherentTraversal::Frusta);
        EXPECT_EQ(traversal(3, 0, 2, 0, true, registers), CoherentTraversal::Lanes);
        const CoherentTraversal scalar =
            registers == kSse4 ? CoherentTraversal::Alone : CoherentTraversal::Lanes;
        EXPECT_EQ(traversal(2, 1, 3, 0, true, registers), scalar);
        EXPECT_EQ(traversal(0, 0, 3, 0, true, registers), scalar);
        EXPECT_EQ(traversal(64, 64, 0, 1, false, registers, true), closest);
        EXPECT_EQ(traversal(0, 0, 0, 3, false, registers, true), scalar);
        EXPECT_EQ(traversal(0, 0, 0, 3, true, registers, true), scalar);
    }
}

TEST(CoherentBatch, IncoherentRaysOfSmallTreesAreStreamedAmongTriangles) {
    const auto most = [](std::size_t triangles, std::size_t round, std::size_t others) {
        WideBvhLayout layout;
        layout.triangles.resize(triangles);
        layout.spheres.resize(round / 2);
        layout.frustums.resize(round - round / 2);
        layout.others.resize(others);
        return most_single_bytes(layout);
    };
    EXPECT_EQ(most(1, 0, 0), 0u);
    EXPECT_EQ(most(9, 4, 1), 0u);
    EXPECT_EQ(most(9, 5, 1), kMaxIncoherentSingleBytes);
    EXPECT_EQ(most(9, 0, 3), kMaxIncoherentSingleBytes);
    EXPECT_EQ(most(0, 0, 1), kMaxIncoherentSingleBytes);
    EXPECT_EQ(most(9, 9, 0), kMaxRoundSingleBytes);
    EXPECT_EQ(most(0, 1, 0), kMaxRoundSingleBytes);
}

TEST(CoherentBatch, PacketsThatFailAreNotTriedAgainAtOnceAndHitTheSame) {
    // Much finer than the distance of the rays: for packets in lanes, whose rays diverge, and
    // frusta.
    for (const PrimitiveTable& table :
         {random_triangles(20000, 1, 0.01, 19), random_spheres(20000, 1, 0.003, 19)}) {
        const auto tree = make_aggregate("wide_bvh", table);
        const Rays rays = eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.5, 40);
        std::vector<Hit> first(rays.size()), later(rays.size());
        tree->closest_batch(rays, first, nullptr, Coherence::Coherent);
        tree->closest_batch(rays, later, nullptr, Coherence::Coherent);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Hit single;
            (void)tree->closest(rays[i], single, nullptr);
            ASSERT_TRUE(same(first[i], single)) << i;
            ASSERT_TRUE(same(later[i], single)) << i;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
