#include "alhazen/geometry/mirrors/alhazens_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/math/constants.h"
#include "support/quad.h"
#include "support/random.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Quad;
using testing::QuadVec;
using testing::Random;

MirrorPoints reflecting(MirrorFace face, const Vec3& a, const Vec3& b) {
    return reflecting_points({}, 1.0, face, {a}, {b});
}

/// Sine between the mirrored direction to A and that to B, in 113 bits.
double error_at(const Vec3& center, const MirrorEnd& a, const MirrorEnd& b, const Vec3& point) {
    const QuadVec p(point), n = normalize(p - QuadVec(center));
    const auto towards = [&](const MirrorEnd& end) {
        return normalize(end.infinite ? QuadVec(end.at) : QuadVec(end.at) - p);
    };
    const QuadVec to_a = towards(a), to_b = towards(b);
    const QuadVec mirrored = (2 * dot(to_a, n)) * n - to_a;
    if (dot(mirrored, to_b) < 0) return 1.0;
    return static_cast<double>(length(cross(mirrored, to_b)));
}

/// Angles at which a scan of the circle through A and B finds the sum of the signed angles of
/// incidence change its sign. Independent of the quartic.
std::vector<double> scanned(const Vec2& a, const Vec2& b, bool outer, int steps) {
    const auto sine = [&](const Vec2& end, double c, double s, bool& seen) {
        const Vec2 to{end.x - c, end.y - s};
        const double along = to.x * c + to.y * s;
        seen = outer ? along > 0.0 : along < 0.0;
        return (c * to.y - s * to.x) / std::sqrt(to.x * to.x + to.y * to.y);
    };
    std::vector<double> found;
    bool valid_before = false;
    double before = 0.0;
    for (int i = 0; i <= steps; ++i) {
        const double theta = 2.0 * kPi * i / steps + 0.0137;
        const double c = std::cos(theta), s = std::sin(theta);
        bool seen_a = false, seen_b = false;
        const double sum = sine(a, c, s, seen_a) + sine(b, c, s, seen_b);
        const bool valid = seen_a && seen_b;
        if (valid && valid_before && sum * before < 0.0) found.push_back(theta - kPi / steps);
        valid_before = valid;
        before = sum;
    }
    return found;
}

TEST(AlhazensProblem, OneMirrorPointInSymmetry) {
    const MirrorPoints p = reflecting(MirrorFace::Outer, {3, 0, 1}, {-3, 0, 1});
    ASSERT_EQ(p.count, 0) << "the sphere is between them";
    const MirrorPoints q = reflecting(MirrorFace::Outer, {3, 0, 3}, {-3, 0, 3});
    ASSERT_EQ(q.count, 1);
    EXPECT_LT(length(q.points[0] - Vec3{0, 0, 1}), 1e-15);
    EXPECT_FALSE(q.on_ring[0]);
}

TEST(AlhazensProblem, ALampAtTheEyeIsSeenInTheMiddle) {
    for (const Vec3& a : {Vec3{0, 0, 2}, Vec3{1e9, 0, 0}, Vec3{1.0000001, 0, 0}}) {
        const MirrorPoints p = reflecting(MirrorFace::Outer, a, a);
        ASSERT_EQ(p.count, 1);
        EXPECT_LT(length(p.points[0] - normalize(a)), 1e-14);
    }
}

TEST(AlhazensProblem, OnADiameterOfAConcaveMirrorThereAreTwoEndsAndRings) {
    // On opposite sides the ring is at z = (1 / a - 1 / b) / 2, a and b the distances from the
    // centre.
    const MirrorPoints p = reflecting(MirrorFace::Inner, {0, 0, 0.8}, {0, 0, -0.6});
    ASSERT_EQ(p.count, 3);
    int rings = 0;
    for (int i = 0; i < p.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        rings += p.on_ring[k];
        if (p.on_ring[k]) {
            EXPECT_NEAR(p.points[k].z, (1 / 0.8 - 1 / 0.6) / 2, 1e-14);
        } else {
            EXPECT_NEAR(std::abs(p.points[k].z), 1.0, 1e-14);
        }
        EXPECT_LT(error_at({}, {{0, 0, 0.8}}, {{0, 0, -0.6}}, p.points[k]), 1e-14);
    }
    EXPECT_EQ(rings, 1);
    // On one side only the ends of the diameter.
    EXPECT_EQ(reflecting(MirrorFace::Inner, {0, 0, 0.8}, {0, 0, 0.6}).count, 2);
}

TEST(AlhazensProblem, TheCentreIsReflectedIntoItself) {
    EXPECT_TRUE(reflecting(MirrorFace::Inner, {}, {}).everywhere);
    const MirrorPoints p = reflecting(MirrorFace::Inner, {}, {0.3, 0, 0});
    ASSERT_EQ(p.count, 2);
    for (const Vec3& z : {p.points[0], p.points[1]}) EXPECT_NEAR(std::abs(z.x), 1.0, 1e-15);
}

TEST(AlhazensProblem, TheSphereIsOpaqueToItsOuterFace) {
    EXPECT_EQ(reflecting(MirrorFace::Outer, {0.5, 0, 0}, {2, 1, 0}).count, 0);
    EXPECT_EQ(reflecting(MirrorFace::Outer, {1, 0, 0}, {2, 1, 0}).count, 0);
    EXPECT_EQ(reflecting_points({}, 0.0, MirrorFace::Outer, {{2, 0, 0}}, {{2, 1, 0}}).count, 0);
    EXPECT_EQ(reflecting_points({}, -1.0, MirrorFace::Inner, {{.2, 0, 0}}, {{.2, .1, 0}}).count, 0);
    const double nan = std::nan("");
    EXPECT_EQ(reflecting(MirrorFace::Outer, {nan, 0, 0}, {2, 1, 0}).count, 0);
}

TEST(AlhazensProblem, AConvexMirrorShowsOnePointWhereBothSeeIt) {
    Random random(1030);
    int seen = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 center = 3.0 * random.unit_vector();
        const double radius = random.log_uniform(1e-3, 1e3);
        const auto outside = [&] {
            return center + radius * (1.0 + random.log_uniform(1e-6, 1e6)) * random.unit_vector();
        };
        MirrorEnd a{outside()}, b{outside()};
        if (i % 4 == 0) b = {random.unit_vector(), true};
        const MirrorPoints p = reflecting_points(center, radius, MirrorFace::Outer, a, b);
        ASSERT_LE(p.count, 1);
        if (p.count == 0) continue;
        ++seen;
        // The precision with which the data define a point close to the mirror.
        const auto height = [&](const MirrorEnd& e) {
            return e.infinite ? 1.0 : std::min(1.0, length(e.at - p.points[0]) / radius);
        };
        const double scale = 1.0 + length(center) / radius;
        const double bound = 64 * 0x1p-53 * scale / std::min(height(a), height(b));
        ASSERT_LT(error_at(center, a, b, p.points[0]), bound) << "seed 1030, case " << i;
        ASSERT_NEAR(length(p.points[0] - center), radius, 8e-16 * (radius + 3.0));
    }
    EXPECT_GT(seen, 30000);
}

TEST(AlhazensProblem, AllPointsOfAConcaveMirrorAreFound) {
    Random random(1672);
    int by_count[5] = {};
    const int cases = testing::cases(20000, 100000);
    for (int i = 0; i < cases; ++i) {
        // Inside; also outside, where only a part of the mirror is visible.
        const auto end = [&] {
            const double angle = random.uniform(0.0, 2.0 * kPi);
            const double away =
                i % 2 == 0 ? std::sqrt(random.uniform(0.0, 0.999)) : 3 * random.uniform(0.0, 1.0);
            return Vec2{away * std::cos(angle), away * std::sin(angle)};
        };
        const Vec2 a = end(), b = end();
        const MirrorEnd end_a{{a.x, a.y, 0}}, end_b{{b.x, b.y, 0}};
        const MirrorPoints p = reflecting_points({}, 1.0, MirrorFace::Inner, end_a, end_b);
        ASSERT_LE(p.count, 4);
        ++by_count[p.count];
        for (int k = 0; k < p.count; ++k) {
            const Vec3& z = p.points[static_cast<std::size_t>(k)];
            const double nearest = std::min(length(z - end_a.at), length(z - end_b.at));
            const double bound = 64 * 0x1p-53 / std::min(1.0, nearest);
            ASSERT_LT(error_at({}, end_a, end_b, z), bound) << "seed 1672, case " << i;
            for (int j = 0; j < k; ++j) {
                ASSERT_GT(length(z - p.points[static_cast<std::size_t>(j)]), 1e-9);
            }
        }
        const int steps = i % 50 == 0 ? 20000 : 360;
        const std::vector<double> oracle = scanned(a, b, false, steps);
        ASSERT_GE(p.count, static_cast<int>(oracle.size())) << "seed 1672, case " << i;
        for (const double theta : oracle) {
            const Vec3 about{std::cos(theta), std::sin(theta), 0};
            const bool found =
                std::any_of(p.points.begin(), p.points.begin() + p.count,
                            [&](const Vec3& z) { return length(z - about) < 4.0 / steps; });
            ASSERT_TRUE(found) << "seed 1672, case " << i << ", angle " << theta;
        }
    }
    EXPECT_GT(by_count[2], 3 * cases / 10);
    EXPECT_GT(by_count[4], 3 * cases / 100);
}

TEST(AlhazensProblem, AConcaveMirrorHasTwoPointsOutsideTheCausticAndFourInside) {
    const MirrorPoints p = reflecting(MirrorFace::Inner, {0.9, 0.1, 0}, {-0.9, 0.1, 0});
    EXPECT_EQ(p.count, 4);
    const MirrorPoints q = reflecting(MirrorFace::Inner, {0.1, 0.1, 0}, {-0.1, 0.1, 0});
    EXPECT_EQ(q.count, 2);
}

TEST(AlhazensProblem, FarLampsAreParallelLight) {
    // Parallel light along -x + z to an eye far up: the normal halves the angle.
    const MirrorPoints p =
        reflecting_points({1, 2, 3}, 2.0, MirrorFace::Outer, {{1, 0, 1}, true}, {{-1, 0, 1}, true});
    ASSERT_EQ(p.count, 1);
    EXPECT_LT(length(p.points[0] - Vec3{1, 2, 5}), 1e-15);
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 d = random.unit_vector(), a = 5.0 * random.unit_vector();
        const MirrorPoints far = reflecting_points({}, 1.0, MirrorFace::Outer, {1e7 * d}, {a});
        const MirrorPoints infinite = reflecting_points({}, 1.0, MirrorFace::Outer, {d, true}, {a});
        if (far.count != infinite.count) continue;  // at the very edge
        if (far.count == 0) continue;
        ASSERT_LT(length(far.points[0] - infinite.points[0]), 1e-6);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
