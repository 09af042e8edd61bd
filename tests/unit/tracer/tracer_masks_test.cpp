#include <gtest/gtest.h>

#include "alhazen/tracer/tracer.h"
#include "unit/tracer/tracer_cases.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

constexpr Ray kDown{{0.2, 0.1, 10}, {0, 0, -1}};

/// One geometry of each kind, stacked; each is visible only to the ray of its own bit.
TracerScene tower() {
    TracerScene inner;
    inner.add_sphere({0, 0, 0}, 0.5, {.visible_to = 1u << 3});
    inner.add_sphere({0, 0, -1}, 0.5, {.visible_to = 1u << 4});
    TracerScene scene;
    const std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    const std::vector<float> flat{-1, -1, 0, 1, -1, 0, 0, 1, 0};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    scene.add_mesh(corners, std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}},
                   {.visible_to = 1u << 0});
    scene.add_mesh(flat, indices,
                   {.world_from_geometry = Affine::translate({0, 0, 1}), .visible_to = 1u << 1});
    scene.add(Disc{.center = {0, 0, 2}}, {.visible_to = 1u << 2});
    scene.add_instance(
        Tracer(std::move(inner)),
        {.world_from_geometry = Affine::translate({0, 0, 4}), .visible_to = (1u << 3) | (1u << 5)});
    scene.add_sphere({0, 0, 7}, 0.5);
    return scene;
}

TEST(TracerMasks, ARaySeesTheGeometryThatHasABitOfItsMask) {
    for (const char* accelerator : {"wide_bvh", "list"}) {
        const Tracer tracer(tower(), {.accelerator = accelerator});
        std::vector<Hit> hits;
        tracer.all_hits(kDown, hits);
        // Two crossings of the sphere on top and of the one in the instance; the other sphere and
        // its instance have no common bit, although the ray has bits of both.
        EXPECT_EQ(hits.size(), 2u + 2u + 2u + 3u) << accelerator;
        const std::size_t crossings[] = {1, 1, 1, 2, 0, 0, 0};
        for (std::uint32_t bit = 0; bit < 7; ++bit) {
            tracer.all_hits(kDown, hits, 1u << bit);
            EXPECT_EQ(hits.size(), 2 + crossings[bit]) << accelerator << ", bit " << bit;
            Ray below = kDown;
            below.t_min = 4;
            Hit hit;
            EXPECT_EQ(tracer.intersect(below, hit, 1u << bit), crossings[bit] > 0) << bit;
            EXPECT_EQ(tracer.occluded(below, 1u << bit), crossings[bit] > 0) << bit;
            if (crossings[bit] > 0) {
                EXPECT_EQ(tracer.details(below, hit).instances.size(), bit == 3 ? 1u : 0u);
            }
        }
        Hit hit;
        EXPECT_FALSE(tracer.intersect(kDown, hit, 0));
        EXPECT_FALSE(tracer.occluded(kDown, 0));
    }
}

TEST(TracerMasks, BatchesSeeWhatSingleRaysSee) {
    const Tracer tracer(tower());
    std::vector<Ray> rays = random_rays(1, 300);
    rays.push_back(kDown);
    for (const RayMask mask : {RayMask{1}, RayMask{8}, RayMask{20}, RayMask{0}, kAllRays}) {
        std::vector<Hit> hits(rays.size());
        const auto occluded = std::make_unique<bool[]>(rays.size());
        HitLists lists;
        tracer.intersect(rays, hits, mask);
        tracer.occluded(rays, {occluded.get(), rays.size()}, mask);
        tracer.all_hits(rays, lists, mask);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Hit hit;
            EXPECT_EQ(tracer.intersect(rays[i], hit, mask), occluded[i]) << i;
            EXPECT_TRUE(same_hit(hit, hits[i])) << i;
            std::vector<Hit> all;
            tracer.all_hits(rays[i], all, mask);
            EXPECT_EQ(all.size(), lists.of(i).size()) << i;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
