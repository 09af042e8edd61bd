/// Crossings of patches in 113 bits: against formulas, and the classification of missed ones.

#include "alhazen/verification/exact_patches.h"

#include <gtest/gtest.h>

#include "alhazen/base/file.h"
#include "alhazen/formats/bpt/bpt_reader.h"
#include "alhazen/session/generators/teapot_patches.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/verification/patch_trials.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

PatchModel torus_model() {
    Torus torus{.major_radius = 1.2, .minor_radius = 0.5};
    torus.prepare();
    std::vector<BezierPiece> pieces;
    append_pieces(torus, pieces);
    std::vector<BezierNet> nets;
    for (const BezierPiece& piece : pieces) nets.push_back(piece.net);
    return {"torus", nets};
}

PatchModel teapot_model() {
    std::vector<BezierNet> nets;
    for (const TeapotPatch& patch : teapot_patches())
        nets.push_back(bezier_net(3, 3, {&patch[0][0], 16}));
    return {"teapot", nets};
}

TEST(ExactPatches, ATorusOfPatchesHasTheRootsOfItsQuartic) {
    const PatchModel model = torus_model();
    Torus torus{.major_radius = 1.2, .minor_radius = 0.5};
    torus.prepare();
    RandomStream random(1);
    int roots = 0;
    for (int k = 0; k < 300; ++k) {
        const Ray ray = patch_ray(model, PatchRayKind::Random, random);
        const ExactPatchRoots exact = exact_patch_roots(model.nets, ray);
        ShapeHit hits[kMaxShapeHits];
        const int count = torus.intersect(ray, hits);
        ASSERT_EQ(exact.roots.size(), static_cast<std::size_t>(count)) << k;
        EXPECT_EQ(exact.undecided, 0);
        for (int i = 0; i < count; ++i) {
            const auto& root = exact.roots[static_cast<std::size_t>(i)];
            EXPECT_NEAR(static_cast<double>(root.t), hits[i].t, 1e-12 * (1.0 + root.slope) * 8);
        }
        roots += count;
    }
    EXPECT_GT(roots, 100);
}

TEST(ExactPatches, TwoRootsThatAreNearlyOneAreFound) {
    // z = (2 u - 1)^2 over the unit square, at the height h: u = (1 -+ sqrt(h)) / 2.
    std::vector<Vec3> points;
    for (const double z : {1.0, -1.0, 1.0}) {
        for (const double y : {0.0, 1.0}) points.push_back({double(points.size() / 2) / 2, y, z});
    }
    const BezierNet net = bezier_net(2, 1, points);
    for (const double h : {1e-2, 1e-8, 1e-16, 1e-24}) {
        const Ray ray{{-1.0, 0.3, h}, {1, 0, 0}, -kInfinity, kInfinity};
        const ExactPatchRoots exact = exact_patch_roots({&net, 1}, ray);
        ASSERT_EQ(exact.roots.size(), 2u) << h;
        const double apart = static_cast<double>(exact.roots[1].t - exact.roots[0].t);
        // Rounding of 2^-113 over the slope there.
        EXPECT_NEAR(apart / std::sqrt(h), 1.0, 1e-12 + 1e-33 / h) << h;
        const Ray below{{-1.0, 0.3, -h}, {1, 0, 0}, -kInfinity, kInfinity};
        EXPECT_TRUE(exact_patch_roots({&net, 1}, below).roots.empty()) << h;
    }
}

TEST(PatchTrials, AMissingAndAnInventedCrossingAreSeen) {
    const PatchModel model = torus_model();
    const Ray ray{{-3, 0.21, 0.07}, {1, 0.01, 0.02}, -kInfinity, kInfinity};
    const ExactPatchRoots exact = exact_patch_roots(model.nets, ray);
    ASSERT_EQ(exact.roots.size(), 4u);
    std::vector<PatchCrossing> found;
    for (const ExactPatchRoot& root : exact.roots) {
        found.push_back({double(root.t), double(root.u), double(root.v), root.patch});
    }
    const auto judged = [&](const std::vector<PatchCrossing>& list) {
        return judge_crossings(model, ray, exact, list, 1e-6);
    };
    EXPECT_EQ(judged(found).missed + judged(found).invented, 0);
    EXPECT_LT(judged(found).worst_t, 1e-15 * 8);
    std::vector<PatchCrossing> fewer = found, more = found, moved = found;
    fewer.erase(fewer.begin() + 1);
    EXPECT_EQ(judged(fewer).missed, 1);
    EXPECT_EQ(judged(fewer).invented, 0);
    more.push_back(found[2]);  // twice
    EXPECT_EQ(judged(more).invented, 1);
    EXPECT_EQ(judged(more).missed, 0);
    moved[0].t += 1e-9;
    EXPECT_NEAR(judged(moved).worst_t, 1e-9 * length(ray.direction), 1e-14);
    EXPECT_GT(judged(moved).worst_of_bound, 1.0);
    moved[0].t += 1e-3;
    EXPECT_EQ(judged(moved).missed, 1);
    EXPECT_EQ(judged(moved).invented, 1);
}

TEST(PatchTrials, OnlyAPairWithinRoundingMayBeMissing) {
    const PatchModel model = torus_model();
    // Next to the highest circle, where two crossings merge.
    for (const auto& [depth, may] : {std::pair{1e-15, true}, std::pair{1e-9, false}}) {
        const Ray ray{{1.2, -3, 0.5 - depth}, {0.013, 1, 0}, -kInfinity, kInfinity};
        const ExactPatchRoots exact = exact_patch_roots(model.nets, ray);
        const PatchJudgement none = judge_crossings(model, ray, exact, {}, 1e-2);
        EXPECT_EQ(none.missed, may ? 0 : none.exact) << depth;
        EXPECT_EQ(none.pairs, may ? none.exact / 2 : 0) << depth;
    }
}

TEST(PatchTrials, TheProductionSearchMissesAndInventsNothing) {
    for (const PatchModel& model : {torus_model(), teapot_model()}) {
        const auto method = patch_method("certified_newton").make(model.nets);
        for (int kind = 0; kind < kPatchRayKinds; ++kind) {
            RandomStream random(20);
            PatchTally tally;
            PatchMethodCounts counts;
            for (int k = 0; k < 250; ++k) {
                const Ray ray = patch_ray(model, static_cast<PatchRayKind>(kind), random);
                std::vector<PatchCrossing> found;
                method->crossings(ray, found, counts);
                tally.add(judge_crossings(model, ray, exact_patch_roots(model.nets, ray), found,
                                          1e-3 * length(model.box.size())));
            }
            const char* name = patch_ray_name(static_cast<PatchRayKind>(kind));
            EXPECT_EQ(tally.missed, 0) << model.name << ' ' << name;
            EXPECT_EQ(tally.invented, 0) << model.name << ' ' << name;
            EXPECT_LE(tally.worst_of_bound, 1.0) << model.name << ' ' << name;
            EXPECT_LT(tally.undecided, 10) << model.name << ' ' << name;
            EXPECT_GT(tally.exact, 50) << model.name << ' ' << name;
        }
    }
}

// Two lines of ten million: they meet a crease where one patch is almost edge-on, and the other has
// the exact crossing.
TEST(PatchTrials, AtACreaseTheSlopeOfThePatchThatReportsCounts) {
    ALHAZEN_NEEDS_DATA("patches/teacup_sjbaker.bpt");
    const std::string file = "teacup_sjbaker.bpt";
    Diagnostics diagnostics;
    std::vector<BezierNet> nets;
    for (const BptMesh& part :
         read_bpt(read_file(testing::test_data() / "patches" / file), file, {}, diagnostics)) {
        for (std::size_t k = 0; k < part.mesh.patch_count(); ++k) nets.push_back(part.mesh.net(k));
    }
    const PatchModel model{file, nets};
    const auto method = patch_method("certified_newton").make(model.nets);
    const auto line = [](const Vec3& origin, const Vec3& direction) {
        return Ray{origin, direction, -kInfinity, kInfinity};
    };
    for (const Ray& ray :
         {line({0x1.e9ba62ff294f7p-1, 0x1.1e9356cd3fb9dp+2, -0x1.78a0f9f9ad18ep+1},
               {-0x1.51e600333b412p-2, -0x1.8cfdc8a7b2be8p+0, 0x1.d62440f823cf3p-1}),
          line({-0x1.387845899d864p+0, 0x1.8c940291f8879p+0, 0x1.37a19e33fd8adp-2},
               {0x1.9c40aca4ec2a6p-1, -0x1.577824c0e3edbp+0, -0x1.160e9c8ac058ap-2})}) {
        std::vector<PatchCrossing> found;
        PatchMethodCounts counts;
        method->crossings(ray, found, counts);
        const PatchJudgement one = judge_crossings(model, ray, exact_patch_roots(model.nets, ray),
                                                   found, 1e-3 * length(model.box.size()));
        EXPECT_GT(one.exact, 0);
        EXPECT_EQ(one.missed + one.invented, 0);
        EXPECT_LE(one.worst_of_bound, 1.0);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
