// List of crossings: holds any number, in order, in inline and in allocated storage.

#include "alhazen/shapes/core/shape_hits.h"

#include <gtest/gtest.h>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(ShapeHits, KeepAnyNumberInOrder) {
    for (const int count : {0, 1, kMaxShapeHits, kMaxShapeHits + 1, 1000}) {
        ShapeHits hits;
        for (int i = 0; i < count; ++i) hits.push_back({double(i), 0, 0, std::uint32_t(i)});
        ASSERT_EQ(hits.size(), std::size_t(count));
        ASSERT_EQ(hits.empty(), count == 0);
        int expected = 0;
        for (const ShapeHit& hit : hits) {
            ASSERT_EQ(hit.t, expected);
            ASSERT_EQ(hit.part, std::uint32_t(expected));
            ++expected;
        }
    }
}

TEST(ShapeHits, RoomBehindWhatIsThereLeavesItAsItWas) {
    ShapeHits hits;
    for (int i = 0; i < 100; ++i) {
        ShapeHit* room = hits.room(kMaxShapeHits);
        for (int k = 0; k < i % 4; ++k) room[k] = {double(hits.size()) + k, 0, 0, 0};
        hits.grow(i % 4);
    }
    ASSERT_EQ(hits.size(), 150u);
    for (std::size_t i = 0; i < hits.size(); ++i) ASSERT_EQ(hits[i].t, double(i));
}

TEST(ShapeHits, ACopyOfItsOwnSurvivesGrowing) {
    ShapeHits hits;
    hits.push_back({7, 1, 2, 3});
    for (int i = 0; i < 200; ++i) hits.push_back(hits.front());
    for (const ShapeHit& hit : hits) ASSERT_EQ(hit.u, 1);
}

TEST(ShapeHits, KnowWhenThereAreEnough) {
    ShapeHits one(1);
    EXPECT_FALSE(one.enough());
    one.push_back({});
    EXPECT_TRUE(one.enough());
    ShapeHits all;
    for (int i = 0; i < 50; ++i) all.push_back({});
    EXPECT_FALSE(all.enough());
    all.shrink(2);
    EXPECT_EQ(all.size(), 2u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
