// Rays of a batch prepared sixteen at a time: the hits of single rays wherever some of the sixteen
// are prepared apart or miss the root, or hit the walls of a room together; the work of rays that
// miss the root.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "unit/aggregates/coherent_rays.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using namespace testing;

/// Rays through the scene and past it; every seventh is of an unusual kind.
std::vector<Ray> rays_of_all_kinds(std::size_t count) {
    const MakeRay make_ray = random_rays(1);
    RandomEngine random(81);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        Ray ray = make_ray(random);
        if (i % 3 == 0) ray.origin = ray.origin + Vec3{5, 0, 0};
        switch (i % 7 == 0 ? i / 7 % 9 : 9) {
            case 0:
                ray.t_min = -1;
                break;
            case 1:
                ray.t_min = -0.0;
                break;
            case 2:
                ray.t_min = std::numeric_limits<double>::quiet_NaN();
                break;
            case 3:  // out of order in double, equal in float
                ray.t_min = 2;
                ray.t_max = std::nextafter(2, 0);
                break;
            case 4:
                ray.origin = ray.origin - 1e3 * ray.direction;
                break;
            case 5:
                ray.direction = 1e-20 * ray.direction;
                break;
            case 6:
                ray.direction = {0, -0.0, 1};
                break;
            case 7:
                ray.t_max = std::numeric_limits<double>::infinity();
                break;
            case 8:
                ray.origin.y = std::numeric_limits<double>::infinity();
                break;
            default:
                break;
        }
        rays.push_back(ray);
    }
    return rays;
}

TEST(RayRecords, HaveTheHitsOfSingleRaysInBatchesOfAllSizes) {
    const PrimitiveTable table = random_mixture(700, 1, 0.1, 82);
    const std::vector<Ray> rays = rays_of_all_kinds(2000);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const auto tree = make_aggregate("wide_bvh", table);
        for (const std::size_t size : {1, 7, 16, 33, 500}) {
            int found = 0;
            for (std::size_t first = 0; first < rays.size(); first += size) {
                const std::span<const Ray> batch =
                    std::span(rays).subspan(first, std::min(size, rays.size() - first));
                std::vector<Hit> hits(batch.size());
                const auto occluded = std::make_unique<bool[]>(batch.size());
                tree->closest_batch(batch, hits, nullptr);
                tree->occluded_batch(batch, {occluded.get(), batch.size()}, nullptr);
                for (std::size_t i = 0; i < batch.size(); ++i) {
                    const Answer answer = ask(*tree, batch[i]);
                    found += answer.found;
                    ASSERT_TRUE(same(hits[i], answer.closest))
                        << target << ", " << size << ": " << show(batch[i]);
                    ASSERT_EQ(occluded[i], answer.occluded)
                        << target << ", " << size << ": " << show(batch[i]);
                }
            }
            EXPECT_GT(found, 100);
        }
    }
}

TEST(RayRecords, HaveTheHitsOfSingleRaysInColumns) {
    RandomEngine random(86);
    std::vector<Ray> alike;
    for (int i = 0; i < 40; ++i) {
        const Vec3 origin{0.1, 0.2, 3};
        alike.push_back({origin, uniform_point(random, 1) - origin, 0, 100});
    }
    // Columns are read in place only where no plane is beside the tree.
    const PrimitiveTable tables[] = {random_mixture(700, 1, 0.1, 84),
                                     random_triangles(700, 1, 0.3, 85)};
    for (const PrimitiveTable& table : tables) {
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride use(target);
            const auto tree = make_aggregate("wide_bvh", table);
            for (const std::size_t size : {5, 16, 100, 1203}) {
                compare_columns(*tree, rays_of_all_kinds(size), target, Coherence::Any);
            }
            compare_columns(*tree, alike, target + ", from one point", Coherence::Any);
        }
    }
}

/// A closed room whose walls are leaves below the root, some of them twice, with small triangles in
/// it. Every other piece of five triangles is seen by shadow rays only.
PrimitiveTable room() {
    RandomEngine random(87);
    TableBuilder builder;
    const auto corner = [](int i, double a, double b, double side) {
        Vec3 p;
        (&p.x)[i] = side;
        (&p.x)[(i + 1) % 3] = a;
        (&p.x)[(i + 2) % 3] = b;
        return p;
    };
    for (int wall = 0; wall < 9; ++wall) {
        const double side = wall % 2 == 0 ? -1.1 : 1.1;
        const auto at = [&](double a, double b) { return corner(wall % 6 / 2, a, b, side); };
        builder.add_triangle(at(-1.1, -1.1), at(1.1, -1.1), at(1.1, 1.1), true);
        builder.add_triangle(at(-1.1, -1.1), at(1.1, 1.1), at(-1.1, 1.1), true);
    }
    for (int i = 0; i < 600; ++i) {
        const Vec3 a = uniform_point(random, 0.7);
        builder.add_triangle(a, a + uniform_point(random, 0.05), a + uniform_point(random, 0.05),
                             true);
    }
    PrimitiveTable table = builder.finish();
    std::vector<PlacedMesh> pieces;
    for (const PlacedMesh& placed : table.meshes) {
        const auto& triangles = placed.mesh->triangles;
        for (std::size_t begin = 0; begin < triangles.size(); begin += 5) {
            auto piece = std::make_shared<TriangleMesh>();
            piece->positions = placed.mesh->positions;
            for (std::size_t i = begin; i < std::min(triangles.size(), begin + 5); ++i) {
                piece->triangles.push_back(triangles[i]);
            }
            const RayMask mask = begin % 2 == 0 ? kAllRays : mask_of(RayKind::Shadow);
            pieces.push_back({piece, placed.material, 0, placed.mirrored, 0, mask});
        }
    }
    table.meshes = std::move(pieces);
    table.finish();
    return table;
}

/// From neighbouring points of a room, from outside, along its edges and up to its walls.
std::vector<Ray> rays_of_a_room(std::size_t count) {
    RandomEngine random(88);
    std::vector<Ray> rays;
    Vec3 from;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 32 == 0) from = uniform_point(random, i % 96 == 0 ? 2 : 0.9);
        Ray ray{from + uniform_point(random, 0.01), uniform_point(random, 1), 0, 100};
        switch (i % 16) {
            case 3:  // the diagonal of a wall, or its edge
                ray.origin = {0, 0, 0};
                ray.direction = {1, i % 32 == 3 ? 0.5 : 1, i % 32 == 3 ? 0.5 : 1};
                break;
            case 7:
                ray.origin = {0, 0, 0};
                ray.direction = {1, 0, 0};
                ray.t_max = i % 32 == 7 ? 1.1 : std::nextafter(1.1, 0);
                break;
            case 11:  // within a wall
                ray.origin = {1.1, 0, 0};
                ray.direction.x = 0;
                break;
            default:
                break;
        }
        rays.push_back(ray);
    }
    return rays;
}

TEST(RayRecords, HaveTheHitsOfSingleRaysInARoom) {
    const PrimitiveTable table = room();
    const std::vector<Ray> rays = rays_of_a_room(4000);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const auto tree = make_aggregate("wide_bvh", table);
        for (const RayKind kind : {RayKind::Shadow, RayKind::Reflection}) {
            const RayQuery query{nullptr, mask_of(kind)};
            std::vector<Hit> hits(rays.size());
            const auto occluded = std::make_unique<bool[]>(rays.size());
            tree->closest_batch(rays, hits, query);
            tree->occluded_batch(rays, {occluded.get(), rays.size()}, query);
            int found = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const Answer answer = ask(*tree, rays[i], mask_of(kind));
                found += answer.found;
                ASSERT_TRUE(same(hits[i], answer.closest)) << target << ": " << show(rays[i]);
                ASSERT_EQ(occluded[i], answer.occluded) << target << ": " << show(rays[i]);
            }
            EXPECT_GT(found, 1000) << target;
        }
        compare_columns(*tree, rays, target + ", room", Coherence::Any);
    }
}

TEST(RayRecords, VisitTheRootAlone) {
    const PrimitiveTable table = random_triangles(700, 1, 0.1, 83);
    std::vector<Ray> rays = rays_of_all_kinds(67);
    // Near enough to be prepared in lanes.
    for (Ray& ray : rays) ray = {{2, ray.direction.y, 2}, {0, 1, 0}};
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const WideBvhAggregate tested(table);
        TraversalStats stats;
        std::vector<Hit> hits(rays.size());
        tested.closest_batch(rays, hits, &stats);
        TraversalStats alone;
        for (const Ray& ray : rays) {
            Hit hit;
            EXPECT_FALSE(tested.closest(ray, hit, &alone));
        }
        EXPECT_EQ(stats.node_visits, rays.size()) << target;
        EXPECT_EQ(stats.node_visits, alone.node_visits) << target;
        EXPECT_EQ(stats.box_tests, alone.box_tests) << target;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
