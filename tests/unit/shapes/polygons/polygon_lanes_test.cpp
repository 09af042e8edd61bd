// Crossings of rays in lanes with polygons equal those of single rays, bit for bit.

#include "alhazen/shapes/polygons/polygon_lanes.h"

#include <gtest/gtest.h>

#include <bit>

#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/simd/targets.h"
#include "support/any_ray.h"
#include "support/random_shapes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::any_ray;
using testing::Random;
using testing::same_bits;
using testing::to_text;

/// Returns how many of `wanted` hit.
int check_block(const Polygon& polygon, const RayLanes& rays, std::uint32_t wanted) {
    std::array<ShapeHit, kRayLanes> hits;
    const std::uint32_t found = first_hits(polygon, rays, wanted, hits.data());
    EXPECT_EQ(found & ~wanted, 0u);
    for_each_lane(wanted, [&](std::size_t i) {
        ShapeHit alone;
        const bool hit = find_first_hit(polygon, rays.ray(i), alone);
        EXPECT_EQ(hit, (found >> i & 1) != 0) << to_text(rays.ray(i));
        if (!hit || (found >> i & 1) == 0) return;
        EXPECT_TRUE(same_bits(alone, hits[i]))
            << to_text(rays.ray(i)) << " t " << hits[i].t << " expected " << alone.t;
    });
    return std::popcount(found);
}

/// Rays of all kinds, rays that are alike, and rays from the polygon.
RayLanes random_rays(const Polygon& polygon, Random& random) {
    RayLanes rays;
    const Box3 box = polygon.box();
    const Ray first = any_ray(box, random);
    const int kind = random.below(3);
    const double spread = random.log_uniform(1e-9, 0.3) * length(first.direction);
    for (std::size_t i = 0; i < kRayLanes; ++i) {
        Ray ray = kind == 0 ? first : any_ray(box, random);
        if (kind == 0) ray.direction += spread * random.unit_vector();
        if (kind == 1) {
            const double t = dot(polygon.normal, polygon.point - ray.origin) /
                             dot(polygon.normal, ray.direction);
            const Vec3 there = ray.at(t);
            if (is_finite(there)) ray.origin = there;
            ray.t_min = random.coin() ? 0.0 : 1e-12;
        }
        rays.set(i, ray);
    }
    return rays;
}

TEST(PolygonLanes, HitsAreThoseOfEachRayAlone) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(21);
        int hit_count = 0;
        for (int i = 0; i < 200 && !::testing::Test::HasFailure(); ++i) {
            SCOPED_TRACE(target + ", shape " + std::to_string(i));
            const auto polygon = testing::random_shape<Polygon>({random, i % 2 == 1});
            for (int block = 0; block < 40 && !::testing::Test::HasFailure(); ++block) {
                hit_count += check_block(polygon, random_rays(polygon, random),
                                         1 + std::uint32_t(random.below(255)));
            }
        }
        EXPECT_GT(hit_count, 3000);
    }
}

TEST(PolygonLanes, RaysThroughEdgesAndVerticesMeetTheSidesThatSingleRaysMeet) {
    // A square and a triangle with a hole, on a lattice.
    Polygon square{.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}};
    Polygon holed{
        .vertices = {{-4, 0, -4}, {4, 0, -4}, {0, 0, 4}, {-1, 0, -2}, {0, 0, 0}, {1, 0, -2}},
        .loop_ends = {3, 6}};
    for (Polygon* polygon : {&square, &holed}) {
        polygon->prepare();
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride forced(target);
            SCOPED_TRACE(target);
            Random random(22);
            int hit_count = 0;
            for (int block = 0; block < 3000 && !::testing::Test::HasFailure(); ++block) {
                RayLanes rays;
                for (std::size_t i = 0; i < kRayLanes; ++i) {
                    // Towards a vertex, the middle of an edge, or a point of the lattice.
                    const std::size_t n = polygon->vertices.size();
                    const std::size_t v = std::size_t(random.below(int(n)));
                    Vec3 to = polygon->vertices[v];
                    if (random.coin()) to = 0.5 * (to + polygon->vertices[(v + 1) % n]);
                    const auto whole = [&] { return double(random.below(9) - 4); };
                    if (random.below(3) == 0) to = {whole(), whole(), whole()};
                    const Vec3 from{whole(), whole(), whole()};
                    Vec3 direction = to - from;
                    if (!(length(direction) > 0.0)) direction = {0, 1, -1};
                    rays.set(i, {from, direction});
                }
                hit_count += check_block(*polygon, rays, kAllRayLanes);
            }
            EXPECT_GT(hit_count, 2000);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
