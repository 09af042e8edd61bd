/// Ray counts of the Standard Procedural Databases, as published and re-derived.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "alhazen/base/file.h"
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

/// The numbers of a row of the table of counts in docs/results.md, without those in brackets.
std::vector<std::uint64_t> documented(const std::string& scene) {
    std::istringstream page(read_file(testing::source_folder() / "docs/results.md"));
    std::string line;
    while (std::getline(page, line) && !line.starts_with("| scene | eye hits |")) {
    }
    while (std::getline(page, line) && !line.starts_with("| " + scene + " |")) {
    }
    std::istringstream cells(line.substr(std::min(line.size(), scene.size() + 4)));
    std::vector<std::uint64_t> numbers;
    for (std::string cell; std::getline(cells, cell, '|');) numbers.push_back(std::stoull(cell));
    return numbers;
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
        const std::vector<std::uint64_t> found{
            all[RayKind::Eye].hit,
            all[RayKind::Reflection].cast,
            all[RayKind::Refraction].cast,
            all.total_internal,
            all[RayKind::Reflection].hit + all[RayKind::Refraction].hit,
            all[RayKind::Shadow].cast,
            all[RayKind::Shadow].hit};
        EXPECT_EQ(found, documented(name.substr(0, name.find('_')))) << name;
        const std::uint64_t expected[] = {e.eye_hit,       e.reflect, e.refract,   e.total_internal,
                                          e.secondary_hit, e.shadow,  e.shadow_hit};
        // Rays through the edges of the transparent gears differ by rounding.
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double most = e.refract > 0 ? 2.0 : 0.0;
            EXPECT_NEAR(static_cast<double>(found[i]), static_cast<double>(expected[i]), most)
                << name << ", column " << i;
        }
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
