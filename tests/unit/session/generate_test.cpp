#include "alhazen/session/generators/generate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/scene/scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Generate, TheGeneratorsOfSolidsMakeValidScenesOfAtLeastTheSize) {
    for (const char* name : {"perforated_plate", "menger_sponge", "drilled_spheres"}) {
        const GeneratorEntry& entry = find_generator(name);
        for (const std::uint64_t size : {1u, 2u, 30u, 100u}) {
            const SceneDescription description = generate(entry.name, size);
            Diagnostics diagnostics;
            validate(description, diagnostics);
            EXPECT_TRUE(diagnostics.all().empty()) << entry.name << " " << size;
            const Scene heap = compile(description, {.csg = "event_heap"});
            const Scene roth = compile(description, {.accelerator = "list", .csg = "roth"});
            EXPECT_GE(heap.census.solid_leaves, size) << entry.name;
            int seen = 0;
            for (int i = 0; i < 400; ++i) {
                const Ray ray =
                    eye_ray(heap.cameras.at(0).camera, (i % 20 + 0.5) / 20, (i / 20 + 0.5) / 20);
                Hit a, b;
                ASSERT_EQ(heap.aggregate->closest(ray, a, nullptr),
                          roth.aggregate->closest(ray, b, nullptr))
                    << entry.name << " " << size << " ray " << i;
                EXPECT_EQ(a.t, b.t) << entry.name << " " << size << " ray " << i;
                seen += a.found();
            }
            EXPECT_GT(seen, 20) << entry.name << " " << size;
        }
    }
}

/// A cell of the sponge is empty where two of its three base-3 digits are 1 at any level.
bool is_there(std::array<int, 3> cell) {
    for (int level = 0; level < 2; ++level) {
        int ones = 0;
        for (int& c : cell) {
            ones += c % 3 == 1;
            c /= 3;
        }
        if (ones >= 2) return false;
    }
    return true;
}

TEST(Generate, TheSpongeIsTheOneOfMenger) {
    const Scene scene = compile(generate("menger_sponge", 28));
    EXPECT_EQ(scene.census.solid_leaves, 28u);
    for (int i = 0; i < 81; ++i) {
        Ray ray{{-1, (i % 9 + 0.5) / 9, (i / 9 + 0.5) / 9}, {1, 0, 0}};
        std::vector<Hit> hits;
        scene.aggregate->all_hits(ray, hits, nullptr);
        std::vector<double> expected;
        bool before = false;
        for (int x = 0; x <= 9; ++x) {
            const bool now = x < 9 && is_there({x, i % 9, i / 9});
            if (now != before) expected.push_back(1.0 + x / 9.0);
            before = now;
        }
        ASSERT_EQ(hits.size(), expected.size()) << i;
        for (std::size_t k = 0; k < hits.size(); ++k) EXPECT_NEAR(hits[k].t, expected[k], 1e-14);
    }
}

TEST(Generate, UnknownNamesAndSizesAreUsageErrors) {
    const auto message = [](const std::string& name, std::uint64_t size) -> std::string {
        try {
            (void)generate(name, size);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(message("sponge", 5).find("perforated_plate, menger_sponge, drilled_spheres"),
              std::string::npos);
    EXPECT_NE(message("balls", 8).find("expected 1 to 7"), std::string::npos);
    EXPECT_NE(message("menger_sponge", 0).find("expected 1 to"), std::string::npos);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
