#include "alhazen/laboratory/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/laboratory/report/compare_report.h"
#include "unit/laboratory/small_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::small_scene;

CompareOptions options_with(std::vector<std::string> accelerators) {
    CompareOptions options;
    options.accelerators = std::move(accelerators);
    options.tune = false;
    return options;
}

TEST(ParseAccelerators, TellsSettingsFromNames) {
    EXPECT_EQ(parse_accelerators("list,octree:walk=smart,max_depth=4,kd_tree"),
              (std::vector<std::string>{"list", "octree:walk=smart,max_depth=4", "kd_tree"}));
    EXPECT_EQ(parse_accelerators("all").size(), accelerator_table().size());
    for (const char* wrong : {"", "octopus", "list,", "walk=smart", "octree:walk=crawl",
                              "octree:walk=smart,walk=smart"}) {
        EXPECT_THROW((void)parse_accelerators(wrong), Error) << wrong;
    }
}

TEST(Compare, EveryAcceleratorGivesTheSamePictureAndRays) {
    const Comparison c = compare(small_scene(), "small", options_with(parse_accelerators("all")));
    EXPECT_EQ(c.measurements.size(), accelerator_table().size());
    EXPECT_TRUE(c.holds());
    for (const Measurement& m : c.measurements) {
        EXPECT_TRUE(m.agrees()) << m.accelerator << " " << m.figures.first_disagreement;
        EXPECT_EQ(m.unavailable, "") << m.accelerator;
        EXPECT_EQ(m.picture.pixels, 40u * 30u) << m.accelerator;
        EXPECT_GT(m.figures.each(&TraversalStats::primitive_tests), 0.0) << m.accelerator;
        for (const float cost : m.cost) EXPECT_TRUE(std::isfinite(cost)) << m.accelerator;
    }
}

TEST(Compare, TheCostOfThePixelsIsAllThatIsVisitedAndTested) {
    const Comparison c =
        compare(small_scene(), "small",
                options_with({"bounding_volumes", "kay_kajiya", "uniform_grid", "octree", "bsp"}));
    for (const Measurement& m : c.measurements) {
        if (m.name() == kDefaultAccelerator)
            continue;  // measured in batches, rendered by single rays
        ASSERT_TRUE(m.figures.all_counted && m.picture.complete) << m.accelerator;
        double cost = 0;
        for (const float pixel : m.cost) cost += double{pixel};
        const TraversalStats tests = m.figures.total().tests;
        EXPECT_EQ(cost,
                  static_cast<double>(tests.node_visits + tests.box_tests + tests.primitive_tests))
            << m.accelerator;
        if (m.name() == "bounding_volumes") {
            EXPECT_GT(tests.box_tests, tests.primitive_tests);
        }
    }
}

TEST(Compare, ColumnsOfTheTableStayApartWhateverTheFigures) {
    Comparison c = compare(small_scene(), "small", options_with({"kd_tree"}));
    const auto words_of_lines = [&] {
        std::vector<std::size_t> counts;
        std::istringstream table(comparison_table(c));
        for (std::string line, word; std::getline(table, line);) {
            std::istringstream words(line);
            std::size_t count = 0;
            bool named = false;
            for (; words >> word; ++count) named = named || word == "kd_tree";
            if (named) counts.push_back(count);
        }
        return counts;
    };
    const std::vector<std::size_t> usual = words_of_lines();
    ASSERT_EQ(usual.size(), 2u);
    for (const double factor : {1e3, 99999.6, 1e6, 3.3e8, 9.999e11}) {
        for (KindFigures& kind : c.measurements[2].figures.kinds) {
            const auto count =
                static_cast<std::uint64_t>(factor * static_cast<double>(kind.counted));
            kind.tests = {.box_tests = count,
                          .primitive_tests = count,
                          .primitive_hits = count,
                          .mailbox_saved = count,
                          .node_visits = count,
                          .empty_cells = count,
                          .slab_tests = count,
                          .heap_pushes = count};
            kind.seconds = 1e-9 * factor * static_cast<double>(kind.timed);
        }
        c.measurements[2].build_seconds = std::min(factor, 99999.0);
        c.measurements[2].bytes = static_cast<std::uint64_t>(1e6 * factor);
        EXPECT_EQ(words_of_lines(), usual) << comparison_table(c);
    }
}

TEST(Compare, FindsAnAcceleratorThatDiffers) {
    const Comparison c =
        compare(small_scene(), "small", options_with({"uniform_grid:hit_in_cell=off"}));
    EXPECT_FALSE(c.holds());
    ASSERT_EQ(c.measurements.size(), 3u);
    EXPECT_GT(c.measurements[2].figures.disagreements, 0u);
    EXPECT_GT(c.measurements[2].picture.differing, 0u);
    EXPECT_NE(comparison_table(c).find("DIFFERS"), std::string::npos);
    EXPECT_EQ(comparison_json({&c, 1})["scenes"][0]["all_agree"], false);
}

TEST(Compare, MeasuresTilesByChanceWhereThePictureWouldTakeTooLong) {
    CompareOptions options = options_with({});
    options.time_limit = 0.02;
    options.trial.width = 200;
    options.trial.height = 150;
    const Comparison c = compare(small_scene(600), "small", options);
    const Measurement& list = *c.find("list");
    EXPECT_FALSE(list.figures.all_counted);
    EXPECT_FALSE(list.picture.complete);
    EXPECT_GT(list.picture.pixels, 0u);
    EXPECT_LT(list.picture.pixels, 200u * 150u);
    EXPECT_TRUE(list.agrees());
    std::uint64_t known = 0;
    for (const float cost : list.cost) known += std::isfinite(cost);
    EXPECT_EQ(known, list.picture.pixels);
}

TEST(Compare, TheSearchAddsALineOnlyWhereItFoundSomething) {
    CompareOptions options = options_with({"octree"});
    options.tune = true;
    options.time_limit = 0.2;
    const Comparison c = compare(small_scene(), "small", options);
    std::set<std::string> tuned;
    for (const Measurement& m : c.measurements) {
        if (m.variant != Measurement::Variant::Tuned) continue;
        EXPECT_NE(m.settings(), "");
        EXPECT_GT(m.tried, 0);
        EXPECT_TRUE(tuned.insert(m.name()).second) << m.name() << " has two tuned lines";
    }
    // Untuned: list, wide_bvh and octree.
    EXPECT_EQ(c.measurements.size(), 3 + tuned.size());
    EXPECT_TRUE(c.holds());
}

TEST(Compare, TheReportHasEveryAcceleratorAndTheCountsByKind) {
    const Comparison c = compare(small_scene(), "small", options_with({"kd_tree"}));
    const auto json = comparison_json({&c, 1});
    const auto& scene = json["scenes"][0];
    ASSERT_EQ(scene["accelerators"].size(), 3u);
    const auto& list = scene["accelerators"][1];
    EXPECT_EQ(list["accelerator"], "list");
    EXPECT_EQ(list["by_kind"]["eye"]["tests"]["primitive"], 43 * 40 * 30);
    EXPECT_EQ(list["time_over_list"], 1.0);
    EXPECT_TRUE(list["agrees"]);
    const std::string table = comparison_table(c);
    for (const char* name : {"wide_bvh", "list", "kd_tree"}) {
        EXPECT_NE(table.find(name), std::string::npos) << name;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
