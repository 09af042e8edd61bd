#include "alhazen/csg/crossing_memo.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>
#include <vector>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::vector<ShapeHit> hits(std::size_t count, double first) {
    std::vector<ShapeHit> result;
    for (std::size_t i = 0; i < count; ++i) {
        result.push_back({first + double(i), 0.25, -1.0, static_cast<std::uint32_t>(i)});
    }
    return result;
}
Ray ray(double x) {
    return {{x, 2, 3}, {0, 0, 1}};
}

TEST(CrossingMemo, FindsWhatWasKept) {
    CrossingMemo memo;
    const CrossingMemo::Key key(1, 5, ray(0.5));
    EXPECT_FALSE(memo.find(key).known);
    memo.keep(key, hits(3, 0.5));
    const CrossingMemo::Found found = memo.find(key);
    ASSERT_TRUE(found.known);
    ASSERT_EQ(found.hits.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(found.hits[i].t, 0.5 + double(i));
        EXPECT_EQ(found.hits[i].u, 0.25);
        EXPECT_EQ(found.hits[i].v, -1.0);
        EXPECT_EQ(found.hits[i].part, i);
    }
}

TEST(CrossingMemo, ALineThatMissesIsKnown) {
    CrossingMemo memo;
    const CrossingMemo::Key key(1, 0, ray(0));
    memo.keep(key, {});
    EXPECT_TRUE(memo.find(key).known);
    EXPECT_TRUE(memo.find(key).hits.empty());
}

TEST(CrossingMemo, TellsSolidsLeavesAndLinesApart) {
    CrossingMemo memo;
    memo.keep({1, 0, ray(0.0)}, hits(2, 1));
    EXPECT_FALSE(memo.find({2, 0, ray(0.0)}).known);
    EXPECT_FALSE(memo.find({1, 1, ray(0.0)}).known);
    EXPECT_FALSE(memo.find({1, 0, ray(-0.0)}).known);
    EXPECT_FALSE(memo.find({1, 0, {{0, 2, 3}, {0, 0, -1}}}).known);
    // The range of the ray is no part of its line.
    EXPECT_TRUE(memo.find({1, 0, {{0, 2, 3}, {0, 0, 1}, 0.5, 1.0}}).known);
}

TEST(CrossingMemo, DoesNotKeepManyCrossings) {
    CrossingMemo memo;
    const CrossingMemo::Key key(1, 0, ray(0));
    memo.keep(key, hits(9, 0));
    EXPECT_FALSE(memo.find(key).known);
    memo.keep(key, hits(8, 0));
    EXPECT_EQ(memo.find(key).hits.size(), 8U);
}

TEST(CrossingMemo, LinesEvictEachOtherAndAreNeverMixed) {
    CrossingMemo memo;
    constexpr int kLines = 20000;
    for (int i = 0; i < kLines; ++i) memo.keep({1, 0, ray(i)}, hits(2, i));
    int known = 0;
    for (int i = 0; i < kLines; ++i) {
        const CrossingMemo::Found found = memo.find({1, 0, ray(i)});
        if (!found.known) continue;
        ++known;
        EXPECT_EQ(found.hits[0].t, i);
    }
    EXPECT_GT(known, 1900);
    EXPECT_LE(known, 2048);
    EXPECT_TRUE(memo.find({1, 0, ray(kLines - 1)}).known);
}

TEST(CrossingMemo, NumbersOfSolidsAreUnique) {
    std::vector<std::uint64_t> numbers[2];
    const auto take = [](std::vector<std::uint64_t>& into) {
        for (int i = 0; i < 1000; ++i) into.push_back(CrossingMemo::number_of_solid());
    };
    std::thread other([&] { take(numbers[1]); });
    take(numbers[0]);
    other.join();
    std::set<std::uint64_t> all(numbers[0].begin(), numbers[0].end());
    all.insert(numbers[1].begin(), numbers[1].end());
    EXPECT_EQ(all.size(), 2000U);
    EXPECT_EQ(all.count(0), 0U);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
