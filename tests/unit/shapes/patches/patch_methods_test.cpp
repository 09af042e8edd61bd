/// The methods of the literature for patches: each finds the crossings of patches whose crossings
/// are known.

#include "alhazen/shapes/patches/methods/patch_method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "alhazen/base/error.h"
#include "alhazen/math/constants.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// z = (2 u - 1)^3 - (2 u - 1) / 4 over the unit square.
BezierNet wave() {
    std::array<Vec3, 16> points;
    // Bernstein coefficients by values and derivatives at the ends.
    constexpr double kHeight[4] = {-0.75, 1.08333333333333333, -1.08333333333333333, 0.75};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            points[4 * i + j] = {double(i) / 3, double(j) / 3, kHeight[i]};
        }
    }
    return bezier_net(3, 3, points);
}

/// A quarter of a unit cylinder around z, from z = 0 to 1.
BezierNet quarter_cylinder() {
    const std::array<Vec3, 6> points{
        {{1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}, {0, 1, 0}, {0, 1, 1}}};
    const double w = std::sqrt(0.5);
    const std::array<double, 6> weights{1, 1, w, w, 1, 1};
    return bezier_net(2, 1, points, weights);
}

std::vector<double> crossings_of(const PatchMethodEntry& entry, const BezierNet& net,
                                 const Ray& ray, PatchMethodCounts& counts) {
    const auto method = entry.make({&net, 1});
    std::vector<PatchCrossing> found;
    method->crossings(ray, found, counts);
    std::vector<double> t;
    for (const PatchCrossing& one : found) t.push_back(one.t);
    std::sort(t.begin(), t.end());
    return t;
}

/// The tolerance of a method's crossings: a pixel, or rounding.
double error_of(const PatchMethodEntry& entry) {
    return std::string(entry.name) == "subdivision" ? 5e-3 : 1e-8;
}

TEST(PatchMethods, NamesAreUniqueAndAnUnknownOneIsRefused) {
    std::set<std::string> names;
    for (const PatchMethodEntry& entry : patch_methods()) {
        EXPECT_TRUE(names.insert(entry.name).second);
        EXPECT_STREQ(patch_method(entry.name).name, entry.name);
    }
    EXPECT_EQ(names, (std::set<std::string>{"kajiya", "toth", "joy_bhetanabhotla",
                                            "bezier_clipping", "subdivision", "certified_newton"}));
    EXPECT_THROW((void)patch_method("newton"), Error);
}

TEST(PatchMethods, EachFindsTheThreeCrossingsOfAWave) {
    // z = 0 at 2 u - 1 = -1/2, 0, 1/2; not along an isoparametric line.
    const Ray ray{{-1.0, 0.41, 0.0}, {1.0, 0.03, 0.0}, -kInfinity, kInfinity};
    for (const PatchMethodEntry& entry : patch_methods()) {
        PatchMethodCounts counts;
        const auto t = crossings_of(entry, wave(), ray, counts);
        ASSERT_EQ(t.size(), 3u) << entry.name;
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(t[k], 1.25 + 0.25 * double(k), error_of(entry)) << entry.name;
        }
        EXPECT_EQ(counts.rays, 1u);
        EXPECT_EQ(counts.steps > 0, entry.step != nullptr) << entry.name;
    }
}

TEST(PatchMethods, EachMeetsARationalPatchWhereTheCylinderIs) {
    for (const PatchMethodEntry& entry : patch_methods()) {
        for (const double angle : {0.1, 0.5, 1.0, 1.4}) {
            const Ray ray{{0.2, 0.1, 0.3}, {std::cos(angle), std::sin(angle), 0.1}, 0.0, kInfinity};
            PatchMethodCounts counts;
            const auto t = crossings_of(entry, quarter_cylinder(), ray, counts);
            ASSERT_EQ(t.size(), 1u) << entry.name << " at " << angle;
            const double along = 0.2 * std::cos(angle) + 0.1 * std::sin(angle);
            const double exact = -along + std::sqrt(along * along + 0.95);
            EXPECT_NEAR(t[0], exact, error_of(entry)) << entry.name << " at " << angle;
        }
    }
}

TEST(PatchMethods, NoneFindsACrossingBesideThePatchOrOutsideOfTheRange) {
    const Ray beside{{-1.0, 1.2, 0.0}, {1.0, 0.03, 0.0}, -kInfinity, kInfinity};
    const Ray above{{0.3, 0.4, 1.2}, {0.1, 0.2, 0.0}, -kInfinity, kInfinity};
    const Ray behind{{-1.0, 0.41, 0.0}, {1.0, 0.03, 0.0}, 2.0, kInfinity};
    for (const PatchMethodEntry& entry : patch_methods()) {
        for (const Ray& ray : {beside, above, behind}) {
            PatchMethodCounts counts;
            EXPECT_TRUE(crossings_of(entry, wave(), ray, counts).empty()) << entry.name;
        }
    }
}

TEST(PatchMethods, CoherenceKeepsTheCrossingsOfRaysSideBySide) {
    const BezierNet net = wave();
    const auto method = patch_method("joy_bhetanabhotla").make({&net, 1});
    std::uint64_t first_steps = 0;
    PatchMethodCounts counts;
    for (int k = 0; k < 50; ++k) {
        const Ray ray{{-1.0, 0.4 + 0.001 * k, 0.0}, {1.0, 0.03, 0.0}, -kInfinity, kInfinity};
        std::vector<PatchCrossing> found;
        method->crossings(ray, found, counts);
        EXPECT_EQ(found.size(), 3u) << k;
        if (k == 0) first_steps = counts.steps;
    }
    EXPECT_LT(counts.steps, 25 * first_steps);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
