#include "alhazen/laboratory/replay.h"

#include <gtest/gtest.h>

#include "alhazen/laboratory/scene_trial.h"
#include "unit/laboratory/small_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::small_scene;

TEST(RayStream, HoldsEveryRayOfThePictureByKind) {
    const SceneTrial trial(small_scene(), {});
    const auto by_kind = trial.stream().by_kind();
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        EXPECT_EQ(by_kind[k], trial.picture().counters.rays[k].cast) << kRayKindNames[k];
        EXPECT_GT(by_kind[k], 0u) << kRayKindNames[k];
    }
    std::size_t next = 0;
    for (const RayBatch& batch : trial.stream().batches) {
        EXPECT_EQ(batch.first, next);
        next += batch.count;
    }
    EXPECT_EQ(next, trial.stream().rays.size());
}

TEST(RayStream, HoldsAShareOfTheRaysWhereThereIsNoRoom) {
    const SceneTrial all(small_scene(), {});
    const std::size_t half = all.stream().rays.size() / 2;
    const SceneTrial some(small_scene(), {.most_rays = half});
    EXPECT_LT(some.stream().rays.size(), all.stream().rays.size());
    EXPECT_GT(some.stream().rays.size(), half / 3);
    EXPECT_LE(some.stream().rays.size(), half);
}

TEST(Replay, CountsWhatTheRendererCounts) {
    SceneTrial trial(small_scene(), {});
    const BuiltScene list = trial.build("list");
    RenderOptions options = trial.render_options();
    options.count_tests = true;
    const RenderResult picture = render(list.scene, trial.picture_settings(), options);
    const KindFigures total = trial.ask(list.scene, {}).total();
    EXPECT_EQ(total.tests.primitive_tests, picture.counters.tests.primitive_tests);
    EXPECT_EQ(total.counted, picture.counters.total_cast());
    std::uint64_t hits = 0;
    for (const RayCount& count : picture.counters.rays) hits += count.hit;
    EXPECT_EQ(total.hits, hits);
}

TEST(Replay, FindsNoDifferenceBetweenAcceleratorsThatAgree) {
    SceneTrial trial(small_scene(), {});
    for (const char* accelerator : {"list", "uniform_grid", "kd_tree"}) {
        const ReplayFigures figures = trial.ask(accelerator, {.repetitions = 1});
        EXPECT_EQ(figures.disagreements, 0u) << accelerator << figures.first_disagreement;
        EXPECT_TRUE(figures.all_counted);
        EXPECT_GT(figures.nanoseconds(), 0.0);
    }
}

TEST(Replay, FindsTheDifferenceOfAGridWithoutItsRule) {
    SceneTrial trial(small_scene(), {});
    const ReplayFigures figures = trial.ask("uniform_grid:hit_in_cell=off", {.repetitions = 0});
    EXPECT_GT(figures.disagreements, 0u);
    EXPECT_NE(figures.first_disagreement.find("origin"), std::string::npos);
}

TEST(Replay, AsksASampleOfAllKindsWhereTimeIsShort) {
    SceneTrial trial(small_scene(400), {.width = 160, .height = 120});
    const ReplayFigures figures = trial.ask("list", {.seconds = 0.01, .in_batches = false});
    EXPECT_FALSE(figures.all_counted);
    EXPECT_FALSE(figures.all_timed);
    EXPECT_LT(figures.total().counted, trial.stream().rays.size());
    for (const KindFigures& kind : figures.kinds) EXPECT_GT(kind.counted, 0u);
    // A closest-hit query tests all of them, whatever the sample.
    const KindFigures& eye = figures.kinds[static_cast<std::size_t>(RayKind::Eye)];
    EXPECT_EQ(eye.tests.primitive_tests, 403 * eye.counted);
}

TEST(Replay, MeansWeighKindsAsOftenAsTheyAreRecorded) {
    ReplayFigures figures;
    figures.recorded = {10, 30, 0, 0};
    figures.kinds[0].counted = figures.kinds[0].timed = 10;
    figures.kinds[0].tests.box_tests = 20;
    figures.kinds[0].seconds = 10e-9;
    figures.kinds[1].counted = figures.kinds[1].timed = 1;
    figures.kinds[1].tests.box_tests = 6;
    figures.kinds[1].seconds = 5e-9;
    EXPECT_DOUBLE_EQ(figures.each(&TraversalStats::box_tests), (10 * 2 + 30 * 6) / 40.0);
    EXPECT_DOUBLE_EQ(figures.nanoseconds(), (10 * 1 + 30 * 5) / 40.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
