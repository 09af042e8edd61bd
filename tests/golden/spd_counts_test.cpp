/// Ray counts of the Standard Procedural Databases, as published and re-derived.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "scene_files.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Counts re-derived by an independent double-precision counter of the same protocol.
struct Expected {
    const char* file;
    std::uint64_t eye_hit, reflect, refract, total_internal, secondary_hit, shadow, shadow_hit;
    std::uint64_t first_shadow, first_shadow_hit, first_reflect;
};
constexpr Expected kExpected[] = {
    {"balls_s4", 263169, 175924, 0, 0, 126756, 954969, 287390, 712158, 176666, 85500},
    {"gears_s4", 245332, 305430, 200952, 7595, 384049, 2253528, 1224961, 1135866, 255026, 121306},
    {"teapot_s12", 161546, 226182, 0, 0, 67616, 409103, 40633, 314300, 21072, 161546},
    {"tetra_s6", 49950, 0, 0, 0, 0, 46261, 5557, 46261, 5557, 0},
};

RayCounters count(const LoadedScene& loaded, std::optional<int> depth) {
    RenderOptions options;
    options.protocol = Protocol::Spd;
    options.max_depth = depth;
    return render(loaded.scene, loaded.description.picture, options).counters;
}

void expect_within(std::uint64_t found, std::uint64_t expected, double relative,
                   const std::string& what) {
    EXPECT_LE(std::abs(static_cast<double>(found) - static_cast<double>(expected)),
              relative * static_cast<double>(expected))
        << what << ": found " << found << ", expected " << expected;
}

TEST(SpdCounts, AreThePublishedOnes) {
    ALHAZEN_NEEDS_DATA("nff/spd_default");
    for (const Expected& e : kExpected) {
        const std::string name = e.file;
        const LoadedScene loaded =
            load(testing::test_data() / "nff/spd_default" / (name + ".nff"), {});
        // First generation: eye rays, their shadow rays and the reflections they spawn.
        const RayCounters first = count(loaded, 0);
        EXPECT_EQ(first[RayKind::Eye].cast, 263169u);
        EXPECT_LE(
            std::abs(static_cast<double>(first[RayKind::Eye].hit) - static_cast<double>(e.eye_hit)),
            3.0)
            << name;
        expect_within(first[RayKind::Shadow].cast, e.first_shadow, 2e-4,
                      name + " shadow at depth 1");
        expect_within(first[RayKind::Shadow].hit, e.first_shadow_hit, 2e-4,
                      name + " shadow hits at depth 1");
        const RayCounters second = count(loaded, 1);
        expect_within(second[RayKind::Reflection].cast, e.first_reflect, 2e-4,
                      name + " reflect at depth 2");

        const RayCounters all = count(loaded, std::nullopt);
        expect_within(all[RayKind::Reflection].cast, e.reflect, 5e-3, name + " reflect");
        expect_within(all[RayKind::Refraction].cast, e.refract, 5e-3, name + " refract");
        expect_within(all.total_internal, e.total_internal, 5e-3, name + " total internal");
        expect_within(all[RayKind::Reflection].hit + all[RayKind::Refraction].hit, e.secondary_hit,
                      5e-3, name + " secondary hits");
        expect_within(all[RayKind::Shadow].cast, e.shadow, 5e-3, name + " shadow");
        expect_within(all[RayKind::Shadow].hit, e.shadow_hit, 5e-3, name + " shadow hits");
    }
}

TEST(SpdCounts, DoNotDependOnTheAccelerator) {
    ALHAZEN_NEEDS_DATA("nff/spd_small");
    const auto counters = [](const std::string& accelerator) {
        LoadOptions options;
        options.compile.accelerator = accelerator;
        return count(load(testing::test_data() / "nff/spd_small/balls_s2.nff", options),
                     std::nullopt);
    };
    const RayCounters fast = counters("wide_bvh");
    const RayCounters brute = counters("list");
    for (std::size_t i = 0; i < fast.rays.size(); ++i) {
        EXPECT_EQ(fast.rays[i].cast, brute.rays[i].cast) << kRayKindNames[i];
        EXPECT_EQ(fast.rays[i].hit, brute.rays[i].hit) << kRayKindNames[i];
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
