// Inputs known to make builders slow or trees deep, at every quality.

#include <gtest/gtest.h>

#include <ctime>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "support/thorough.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

const int kCount = cases(30000, 100000);

struct Built {
    double seconds;
    int depth;
    std::size_t bytes;
    std::shared_ptr<const WideBvhAggregate> tree;
};

Built build(const PrimitiveTable& table, BuildQuality quality) {
    // Processor time of this process; excludes other load of the machine.
    const std::clock_t begin = std::clock();
    auto tree = std::make_shared<const WideBvhAggregate>(table, BuildOptions{quality});
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    return {seconds, tree->layout().tree.depth, tree->memory_bytes(), tree};
}

/// `place(builder, random, i)` adds the i-th triangle.
template <class Place>
PrimitiveTable table_of(const Place& place) {
    RandomEngine random(61);
    TableBuilder builder;
    for (int i = 0; i < kCount; ++i) place(builder, random, i);
    return builder.finish();
}

/// The same for as many randomly placed triangles.
const Built& usual_build(BuildQuality quality) {
    static const std::vector<Built> builds = [] {
        const PrimitiveTable table = random_triangles(kCount, 1, 0.01, 62);
        std::vector<Built> all;
        for (const BuildQualityEntry& entry : build_quality_table()) {
            all.push_back(build(table, entry.quality));
        }
        return all;
    }();
    return builds[static_cast<std::size_t>(quality)];
}

/// Checks that the build is not many times slower, larger or deeper than for randomly placed
/// triangles, and traces some rays.
template <class Place>
void check(const std::string& name, const Place& place, int most_depth, double reach = 1) {
    const PrimitiveTable table = table_of(place);
    const auto list = make_aggregate("list", table);
    for (const BuildQualityEntry& entry : build_quality_table()) {
        const Built& usual = usual_build(entry.quality);
        const Built built = build(table, entry.quality);
        const std::string what = name + ", " + entry.name;
        EXPECT_LT(built.seconds, 10 * usual.seconds + 0.5) << what;
        EXPECT_LE(built.depth, most_depth) << what;
        EXPECT_LT(static_cast<double>(built.bytes), 2.5 * static_cast<double>(usual.bytes)) << what;
        RandomEngine random(63);
        const MakeRay rays = random_rays(reach);
        for (int i = 0; i < 20; ++i) {
            const Ray ray = rays(random);
            Hit expected, found;
            (void)list->closest(ray, expected, nullptr);
            (void)built.tree->closest(ray, found, nullptr);
            ASSERT_TRUE(same(expected, found)) << what << ", ray " << i << ": " << show(ray);
        }
    }
}

TEST(DegenerateBuild, IdenticalTriangles) {
    check(
        "identical",
        [](TableBuilder& builder, RandomEngine&, int) {
            builder.add_triangle({-1, -1, 0}, {1, -1, 0.1}, {0, 1, 0.2});
        },
        12);
}

TEST(DegenerateBuild, ALineOfEqualOnes) {
    check(
        "line",
        [](TableBuilder& builder, RandomEngine&, int i) {
            const Vec3 p{2.0 * i / kCount - 1, 0, 0};
            builder.add_triangle(p, p + Vec3{1e-5, 0, 0}, p + Vec3{0, 1e-5, 1e-5});
        },
        14);
}

TEST(DegenerateBuild, NestedScales) {
    check(
        "nested",
        [](TableBuilder& builder, RandomEngine& random, int i) {
            const double s = std::pow(10.0, 12.0 * i / kCount - 6);
            const Vec3 a = uniform_point(random, s);
            builder.add_triangle(a, a + uniform_point(random, s), a + uniform_point(random, s));
        },
        40, 1e6);
}

TEST(DegenerateBuild, AllCentersEqual) {
    check(
        "one center",
        [](TableBuilder& builder, RandomEngine& random, int) {
            const Vec3 a = uniform_point(random, 1), b = uniform_point(random, 1);
            builder.add_triangle(a, b, -a);
        },
        // Everything overlaps everything: splits gain little.
        40);
}

TEST(DegenerateBuild, LongThinDiagonals) {
    check(
        "diagonals",
        [](TableBuilder& builder, RandomEngine& random, int) {
            const Vec3 shift = uniform_point(random, 0.1);
            builder.add_triangle(shift + Vec3{-1, -1, -1}, shift + Vec3{1, 1, 1},
                                 shift + Vec3{1, 1, 1.001});
        },
        40);
}

TEST(DegenerateBuild, HugeAndTinyTogether) {
    check(
        "huge and tiny",
        [](TableBuilder& builder, RandomEngine& random, int i) {
            const double s = i % 10 == 0 ? 1 : 1e-4;
            const Vec3 a = uniform_point(random, 1);
            builder.add_triangle(a, a + uniform_point(random, s), a + uniform_point(random, s));
        },
        40);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
