#include "alhazen/scene_model/part_traversal.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/primitives/surface.h"
#include "alhazen/scene/scene.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

std::vector<WorldPart> visited(const SceneDescription& description, RayMask rays,
                               int* solids = nullptr) {
    std::vector<WorldPart> parts;
    visit_parts(
        description, rays, [&](const WorldPart& part) { parts.push_back(part); },
        [&](const ObjectDescription&) {
            if (solids != nullptr) ++*solids;
        });
    return parts;
}

/// A ball, an object used twice, one used once, and one used once inside the first.
SceneMaker nested() {
    SceneMaker maker;
    const ObjectIndex twice = maker.object("twice"), once = maker.object("once");
    const ObjectIndex inner = maker.object("inner");
    const Sphere ball{.center = {}, .radius = 0.4};
    maker.add(ball);
    maker.add(twice, MaterialId{0}, Affine::translate({2, 0, 0}));
    maker.add(twice, MaterialId{0}, Affine::translate({-2, 0, 0}));
    maker.add(once, MaterialId{0}, Affine::translate({0, 2, 0}));
    maker.add(ball, MaterialId{0}, Affine::translate({0, 0, 1}), twice);
    maker.add(inner, MaterialId{0}, Affine::translate({0, 0, -1}), twice);
    maker.add(ball, MaterialId{0}, {}, once);
    maker.add(ball, MaterialId{0}, {}, inner);
    return maker;
}

TEST(PartTraversal, PlacesNumbersAndInstancesAreThoseThatRaysMeet) {
    SceneMaker maker = nested();
    const std::vector<WorldPart> parts = visited(maker.description(), kAllRays);
    ASSERT_EQ(parts.size(), 6u);
    const Scene scene = maker.compile();
    for (const WorldPart& part : parts) {
        const Vec3 center = part.world_from_part.point({});
        Ray ray;
        ray.origin = center + Vec3{0.1, 0.1, 9};
        ray.direction = {0, 0, -1};
        ray.t_min = 8;  // behind the balls above
        Hit hit;
        ASSERT_TRUE(scene.aggregate->closest(ray, hit, RayQuery(nullptr)));
        const HitParts place = parts_of(*scene.aggregate, hit);
        EXPECT_EQ(place.part, part.number);
        EXPECT_EQ(place.instance, part.instance);
    }
}

TEST(PartTraversal, SeesOnlyWhatTheRaysSee) {
    SceneMaker maker = nested();
    maker.description().objects[0].parts[1].visible_to = mask_of(RayKind::Shadow);
    EXPECT_EQ(visited(maker.description(), kAllRays).size(), 6u);
    const auto seen = visited(maker.description(), mask_of(RayKind::Eye));
    EXPECT_EQ(seen.size(), 4u);
    EXPECT_TRUE(std::none_of(seen.begin(), seen.end(), [](const WorldPart& part) {
        return part.world_from_part.point({}).x > 1.0;
    }));
}

TEST(PartTraversal, AnObjectWithAnAcceleratorIsKeptAndASolidIsNotEntered) {
    SceneMaker maker = nested();
    maker.description().objects[2].accelerator = "list";
    const auto parts = visited(maker.description(), kAllRays);
    EXPECT_EQ(parts.back().instance, 3u);
    EXPECT_NE(parts.back().number, 3u);
    maker.description().objects[1].combine = Combine::Union;
    int solids = 0;
    EXPECT_EQ(visited(maker.description(), kAllRays, &solids).size(), 2u);
    EXPECT_EQ(solids, 2);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
