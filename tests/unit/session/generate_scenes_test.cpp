/// Numbers of primitives of the standard databases, and scenes that are hard for accelerators;
/// `golden/spd_files_test.cpp` compares the databases with the published files.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "alhazen/base/error.h"
#include "alhazen/scene/scene.h"
#include "alhazen/session/generators/generate.h"
#include "alhazen/session/unique_bytes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::map<std::string, int> statements(const std::string& nff) {
    std::map<std::string, int> counts;
    for (std::size_t at = 0; at < nff.size(); at = nff.find('\n', at) + 1) {
        ++counts[nff.substr(at, nff.find_first_of(" \n", at) - at)];
    }
    return counts;
}

TEST(Databases, HaveThePublishedNumbersOfPrimitives) {
    struct Published {
        const char* name;
        int spheres, cones, polygons, patches, lights;
    };
    constexpr Published kPublished[] = {
        {"balls", 7381, 0, 1, 0, 3},    {"gears", 0, 0, 9345, 0, 5},
        {"jacks", 438, 219, 0, 0, 1},   {"lattice", 2197, 6084, 0, 0, 6},
        {"mount", 4, 0, 8192, 0, 1},    {"rings", 4200, 4200, 1, 0, 3},
        {"shells", 361, 0, 0, 0, 1},    {"sombrero", 0, 0, 7938, 0, 1},
        {"teapot", 0, 0, 144, 9120, 2}, {"tetra", 0, 0, 4096, 0, 1},
        {"tree", 4095, 4095, 1, 0, 7},
    };
    for (const Published& p : kPublished) {
        std::map<std::string, int> counts = statements(generate_nff(p.name));
        EXPECT_EQ(counts["s"], p.spheres) << p.name;
        EXPECT_EQ(counts["c"], p.cones) << p.name;
        EXPECT_EQ(counts["p"], p.polygons) << p.name;
        EXPECT_EQ(counts["pp"], p.patches) << p.name;
        EXPECT_EQ(counts["l"], p.lights) << p.name;
    }
}

TEST(Databases, HaveTheNumbersOfTheirFormulasAtOtherSizes) {
    const auto count = [](const char* name, std::uint64_t size, const char* statement) {
        return statements(generate_nff(name, size))[statement];
    };
    EXPECT_EQ(count("balls", 1, "s"), 10);
    EXPECT_EQ(count("gears", 2, "p"), 8 * 146 + 1);
    EXPECT_EQ(count("jacks", 2, "c"), 27);
    EXPECT_EQ(count("lattice", 1, "s"), 8);
    EXPECT_EQ(count("lattice", 1, "c"), 12);
    EXPECT_EQ(count("mount", 1, "p"), 8);
    EXPECT_EQ(count("rings", 3, "s"), 14 * 30);
    EXPECT_EQ(count("shells", 1, "s"), 91);
    EXPECT_EQ(count("sombrero", 1, "p"), 2 * 31 * 31);
    EXPECT_EQ(count("teapot", 3, "pp"), 64 * 9 - 8 * 3);
    EXPECT_EQ(count("tetra", 1, "p"), 4);
    EXPECT_EQ(count("tree", 1, "c"), 3);
}

TEST(Databases, WriteAsManyDigitsAsAsked) {
    EXPECT_NE(generate_nff("balls", 1).find("\ns 0.272166 0.272166 0.544331 0.166667\n"),
              std::string::npos);
    EXPECT_NE(generate_nff("balls", 1, 3).find("\ns 0.272 0.272 0.544 0.167\n"), std::string::npos);
    EXPECT_NE(generate_nff("balls", 1, 17).find("\ns 0.2721655269759"), std::string::npos);
    EXPECT_THROW((void)generate_nff("balls", 1, 18), Error);
    EXPECT_THROW((void)generate_nff("stadium", 10), Error);
}

/// Traces rays through a lattice of pixels, compares the hits of `wide_bvh` with those of `list`,
/// and returns their number.
int expect_same_hits(const SceneDescription& description, const std::string& what) {
    const Scene fast = compile(description);
    const Scene plain = compile(description, {.accelerator = "list"});
    int hits = 0;
    constexpr int kSide = 24;
    for (int i = 0; i < kSide * kSide; ++i) {
        const Ray ray = eye_ray(fast.cameras.at(0).camera, (i % kSide + 0.5) / kSide,
                                (i / kSide + 0.5) / kSide);
        Hit a, b;
        EXPECT_EQ(fast.aggregate->closest(ray, a, nullptr),
                  plain.aggregate->closest(ray, b, nullptr))
            << what << " ray " << i;
        EXPECT_EQ(a.t, b.t) << what << " ray " << i;
        EXPECT_EQ(a.u, b.u) << what << " ray " << i;
        EXPECT_EQ(a.primitive, b.primitive) << what << " ray " << i;
        EXPECT_TRUE(std::equal(a.path.begin(), a.path.end(), b.path.begin(), b.path.end()))
            << what << " ray " << i;
        hits += a.found();
    }
    return hits;
}

TEST(GeneratedScenes, AreValidAndSeen) {
    for (const GeneratorEntry& entry : generators()) {
        const std::uint64_t size = entry.max_size >= 1'000'000 ? 500 : 2;
        const SceneDescription description = generate(entry.name, size);
        Diagnostics diagnostics;
        validate(description, diagnostics);
        EXPECT_TRUE(diagnostics.all().empty())
            << entry.name << ": " << to_string(diagnostics.all().front());
        EXPECT_GT(expect_same_hits(description, entry.name), 20) << entry.name;
    }
}

TEST(GeneratedScenes, AStadiumHasTheTrianglesOfItsSizeTwice) {
    for (const std::uint64_t size : {100u, 5000u, 100'000u}) {
        const Scene scene = compile(generate("stadium", size));
        EXPECT_GE(scene.census.triangles, 2 * size);
        EXPECT_LE(scene.census.triangles, 3 * size + 1000);
    }
}

TEST(GeneratedScenes, ClustersHoldEqualSpheres) {
    const SceneDescription scene = generate("coincident_clusters", 640);
    std::set<std::array<double, 3>> centers;
    for (const Part& part : scene.objects.front().parts) {
        const Sphere& sphere = std::get<Sphere>(std::get<AnyShape>(part.what));
        centers.insert({sphere.center.x, sphere.center.y, sphere.center.z});
    }
    EXPECT_EQ(scene.objects.front().parts.size(), 640u);
    EXPECT_EQ(centers.size(), 10u);
}

TEST(Field, HasAtLeastItsPrimitivesInFewBytes) {
    for (const std::uint64_t size : {1u, 1000u, 2'000'000u, 2'000'000'000u}) {
        const SceneCensus census = compile(generate("field", size)).census;
        EXPECT_GT(census.effective_primitives, size);
        EXPECT_LT(census.effective_primitives, size + size / 10 + 1001);
        EXPECT_LT(unique_bytes(census), 5'000'000u);
    }
    const SceneCensus large = compile(generate("field", 1'000'000'000'000u)).census;
    EXPECT_GT(large.effective_primitives, 1'000'000'000'000u);
    EXPECT_LT(*bytes_per_effective_primitive(large), 1e-5);
}

/// Tests of boxes and triangles by the eye rays of a small image.
double tests_of_field(std::uint64_t size) {
    const Scene scene = compile(generate("field", size));
    TraversalStats stats;
    for (int i = 0; i < 900; ++i) {
        Hit hit;
        (void)scene.aggregate->closest(
            eye_ray(scene.cameras.at(0).camera, (i % 30 + 0.5) / 30, (i / 30 + 0.5) / 30), hit,
            &stats);
    }
    return static_cast<double>(stats.box_tests + stats.primitive_tests);
}

TEST(Field, CostsAThousandTimesThePrimitivesFewTestsMore) {
    const double million = tests_of_field(2'000'000), milliard = tests_of_field(2'000'000'000);
    EXPECT_LT(milliard, 3 * million);
    EXPECT_GT(milliard, million);
    EXPECT_LT(tests_of_field(1'000'000'000'000), 3 * tests_of_field(1'000'000'000));
}

TEST(Field, GivesTheSameHitsInGridsPutTogetherByHand) {
    // Large enough for instances of patches.
    const SceneDescription description = generate("field", 5'000'000);
    const Scene fast = compile(description);
    EXPECT_EQ(fast.census.instance_depth, 2);
    const Scene other = compile(description, {.accelerator = "kd_tree"});
    const Scene grids = compile(generate("field_of_grids", 5'000'000));
    EXPECT_EQ(grids.census.instance_depth, 3);  // the rows are an instance there
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
        const Ray ray =
            eye_ray(fast.cameras.at(0).camera, (i % 20 + 0.5) / 20, (i / 20 + 0.5) / 20);
        Hit a, b, c;
        EXPECT_EQ(fast.aggregate->closest(ray, a, nullptr),
                  other.aggregate->closest(ray, b, nullptr))
            << i;
        EXPECT_EQ(a.t, b.t) << i;
        EXPECT_EQ(a.primitive, b.primitive) << i;
        EXPECT_TRUE(std::equal(a.path.begin(), a.path.end(), b.path.begin(), b.path.end())) << i;
        EXPECT_EQ(grids.aggregate->closest(ray, c, nullptr), a.found()) << i;
        EXPECT_EQ(a.t, c.t) << i;
        EXPECT_EQ(a.primitive, c.primitive) << i;
        if (a.path.empty()) continue;  // sky or ground
        ++hits;
        ASSERT_EQ(c.path.size(), a.path.size() + 1) << i;
        EXPECT_TRUE(std::equal(a.path.begin(), a.path.end() - 1, c.path.begin())) << i;
    }
    EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
