// A ray's first crossing is the first of its whole line's that is in the ray's range, bit for bit:
// rays that begin or end close to a crossing, one by one, side by side, and many apart.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "alhazen/shapes/core/first_hits.h"
#include "alhazen/simd/targets.h"
#include "closed_patches.h"
#include "patch_models.h"
#include "support/any_ray.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;

constexpr std::size_t kBundle = 8;

/// A line, its crossings, and its rays.
struct Line {
    std::vector<ShapeHit> crossings;
    std::vector<Ray> rays;

    Line(const PatchTree& tree, Ray ray) {
        ray.t_min = -kInfinity;
        ray.t_max = kInfinity;
        ShapeHits hits;
        tree.intersect(ray, hits);
        crossings.assign(hits.begin(), hits.end());
        rays.push_back(ray);
        const double size = length(tree.box().size()) / length(ray.direction);
        for (const ShapeHit& hit : crossings) {
            for (const double part : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
                const double before = hit.t - part * size, after = hit.t + part * size;
                for (const auto& [least, most] :
                     {Interval{before, kInfinity}, Interval{after, kInfinity},
                      Interval{hit.t - size, after}, Interval{before, after}}) {
                    rays.push_back({ray.origin, ray.direction, least, most});
                }
            }
        }
    }

    void expect_first(const Ray& ray, bool met, const ShapeHit& hit) const {
        const auto expected =
            std::find_if(crossings.begin(), crossings.end(), [&](const ShapeHit& crossing) {
                return crossing.t >= ray.t_min && crossing.t <= ray.t_max;
            });
        EXPECT_EQ(met, expected != crossings.end()) << testing::to_text(ray);
        if (met && expected != crossings.end()) {
            EXPECT_TRUE(testing::same_bits(hit, *expected))
                << testing::to_text(ray) << " hit " << hit.t << " expected " << expected->t;
        }
    }
};

/// Side by side; the first through a patch, or nearly tangent to it.
std::vector<Ray> bundle_at(std::span<const BezierNet> nets, double size, Random& random) {
    const auto patch = static_cast<std::size_t>(random.below(static_cast<int>(nets.size())));
    const PatchPoint p = derivatives_at(nets[patch], random.uniform(), random.uniform());
    Vec3 direction = random.unit_vector();
    if (random.coin()) {
        const double angle = random.uniform(0, 2 * kPi);
        const Vec3 tangent = std::cos(angle) * p.du + std::sin(angle) * p.dv;
        const double off = random.log_uniform(1e-6, 0.3);
        if (length(tangent) > 0.0) direction = normalize(normalize(tangent) + off * direction);
    }
    const double spread = random.log_uniform(1e-6, 0.03), away = random.uniform(-1, 4) * size;
    const double per_t = random.log_uniform(0.1, 10);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < kBundle; ++i) {
        const double off = i == 0 ? 0.0 : spread;
        const Vec3 along = normalize(direction + off * random.unit_vector());
        const Vec3 target = p.point + off * size * random.unit_vector();
        rays.push_back({target - away * along, per_t * along});
    }
    return rays;
}

/// Many rays, of any of the lines.
void expect_first_of_many(const PatchTree& tree, std::span<const Line> lines, Random& random) {
    std::array<const Line*, kMostPatchRays> of;
    std::array<const Ray*, kMostPatchRays> rays;
    for (std::size_t i = 0; i < kMostPatchRays; ++i) {
        of[i] = &lines[static_cast<std::size_t>(random.below(static_cast<int>(lines.size())))];
        rays[i] = &of[i]->rays[static_cast<std::size_t>(
            random.below(static_cast<int>(of[i]->rays.size())))];
    }
    std::array<ShapeHit, kMostPatchRays> hits;
    const std::uint32_t met = tree.first_hits(rays, hits.data());
    for (std::size_t i = 0; i < kMostPatchRays; ++i) {
        of[i]->expect_first(*rays[i], (met >> i & 1) != 0, hits[i]);
    }
}

/// Returns how many crossings there were.
std::size_t expect_crossings_in_ranges(std::span<const BezierNet> nets, int bundles,
                                       std::uint64_t seed) {
    const PatchTree tree = testing::patch_tree(nets);
    const double size = length(tree.box().size());
    Random random(seed);
    std::size_t crossings = 0;
    std::vector<Line> all;
    for (int k = 0; k < bundles && !::testing::Test::HasFailure(); ++k) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", bundle " + std::to_string(k));
        std::vector<Line> lines;
        std::size_t most = 0;
        for (const Ray& ray : bundle_at(nets, size, random)) {
            const Line& line = lines.emplace_back(tree, ray);
            crossings += line.crossings.size();
            most = std::max(most, line.rays.size());
        }
        for (std::size_t place = 0; place < most; ++place) {
            std::array<const Ray*, kBundle> rays;
            for (std::size_t i = 0; i < kBundle; ++i) {
                rays[i] = &lines[i].rays[place % lines[i].rays.size()];
            }
            std::array<ShapeHit, kBundle> hits;
            const std::uint32_t met = tree.first_hits(rays, hits.data());
            for (std::size_t i = 0; i < kBundle; ++i) {
                lines[i].expect_first(*rays[i], (met >> i & 1) != 0, hits[i]);
                if (place >= lines[i].rays.size()) continue;
                ShapeHit hit;
                const bool alone = tree.first_hit(*rays[i], hit);
                lines[i].expect_first(*rays[i], alone, hit);
            }
        }
        all.insert(all.end(), lines.begin(), lines.end());
    }
    for (int k = 0; k < 20 * bundles && !::testing::Test::HasFailure(); ++k) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", many " + std::to_string(k));
        expect_first_of_many(tree, all, random);
    }
    return crossings;
}

/// Each instruction set has lines of its own. Every day a fifth of the bundles.
void expect_on_targets(std::span<const BezierNet> nets, int all_bundles, std::size_t all_least) {
    const int bundles = testing::thorough() ? all_bundles : all_bundles / 5;
    const std::size_t least = testing::thorough() ? all_least : all_least / 5;
    const std::vector<std::string> targets = simd_targets();
    const int count = static_cast<int>(targets.size());
    std::size_t crossings = 0;
    for (int k = 0; k < count; ++k) {
        const SimdTargetOverride forced(targets[static_cast<std::size_t>(k)]);
        SCOPED_TRACE(targets[static_cast<std::size_t>(k)]);
        const auto seed = static_cast<std::uint64_t>(k + 1);
        crossings += expect_crossings_in_ranges(nets, (bundles + count - 1) / count, seed);
    }
    EXPECT_GT(crossings, least);
}

std::vector<BezierNet> nets_of(const PatchMesh& mesh) {
    std::vector<BezierNet> nets;
    for (std::size_t k = 0; k < mesh.patch_count(); ++k) nets.push_back(mesh.net(k));
    return nets;
}

TEST(PatchRanges, OfTheTeapotHoldTheirCrossings) {
    ALHAZEN_NEEDS_DATA("patches/teapot.bpt");
    expect_on_targets(testing::patch_model("teapot.bpt"), 150, 1500);
}

TEST(PatchRanges, OfAnExactTorusHoldTheirCrossings) {
    expect_on_targets(nets_of(testing::torus_of_patches(1.0, 0.4)), 50, 500);
}

TEST(PatchRanges, OfMeshesThatFoldAndCrossThemselvesHoldTheirCrossings) {
    Random random(2);
    for (const double change : {0.0, 0.4}) {
        expect_on_targets(nets_of(testing::random_closed_patches(random, change)), 50, 500);
    }
}

TEST(PatchRanges, OfFoldedPatchesHoldTheirCrossings) {
    Random random(3);
    for (int round = 0; round < 10; ++round) {
        std::vector<Vec3> points;
        for (int k = 0; k < 16; ++k) {
            points.push_back(Vec3{(k / 4) / 3.0, (k % 4) / 3.0, 0.0} + random.in_cube(0.7));
        }
        expect_on_targets(std::vector{bezier_net(3, 3, points)}, 10, 60);
    }
}

TEST(PatchRanges, OfACuspHoldTheirCrossings) {
    expect_on_targets(std::vector{testing::cusp_patch()}, 50, 500);
}

// No leaf of the cusp has a plane.
TEST(PatchRanges, OfRaysThatBeginOrEndCloseToACuspHoldTheirCrossing) {
    const PatchTree tree = testing::patch_tree(std::vector{testing::cusp_patch()});
    Random random(4);
    for (int k = 0; k < 400; ++k) {
        const double z = random.uniform(0.01, 0.3), x = testing::cusp_x(z);
        const double off = random.log_uniform(1e-6, 1e-1);
        std::array<Ray, kBundle> rays;
        std::array<const Ray*, kBundle> pointers;
        for (std::size_t i = 0; i < kBundle; ++i) {
            const double y = random.uniform(0.1, 2.9);
            // From just before the surface, or to just behind it.
            rays[i] = i % 2 == 0 ? Ray{{x + off, y, z}, {-1, 0, 0}, 0.0, kInfinity}
                                 : Ray{{x + 1.0, y, z}, {-1, 0, 0}, 0.0, 1.0 + off};
            // The other half of the curve is nearer to the second.
            if (i % 2 != 0) rays[i].t_min = 1.0 - off;
            pointers[i] = &rays[i];
        }
        std::array<ShapeHit, kBundle> hits;
        EXPECT_EQ(tree.first_hits(pointers, hits.data()), 0xffu) << k;
        for (std::size_t i = 0; i < kBundle; ++i) {
            const double t = rays[i].origin.x - x;
            EXPECT_NEAR(hits[i].t, t, 1e-12) << testing::to_text(rays[i]);
            ShapeHit hit;
            ASSERT_TRUE(tree.first_hit(rays[i], hit)) << testing::to_text(rays[i]);
            EXPECT_NEAR(hit.t, t, 1e-12) << testing::to_text(rays[i]);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
