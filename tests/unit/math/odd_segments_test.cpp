#include "alhazen/math/odd_segments.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Parts = std::vector<SegmentPart>;

TEST(OddSegments, WithoutOverlapAreTheSegments) {
    const std::vector<PlaneSegment> segments{
        {Vec2{0, 0}, Vec2{1, 0}},   {Vec2{1, 0}, Vec2{2, 0}},  // on one line, end to end
        {Vec2{2, 0}, Vec2{0, 0.5}}, {Vec2{0.5, -1}, Vec2{0.5, 1}},
        {Vec2{3, 3}, Vec2{3, 3}},   {Vec2{3, 3}, Vec2{3, 3}}};
    EXPECT_EQ(odd_segments(segments),
              (Parts{{0, 0, 1}, {1, 2, 3}, {2, 4, 5}, {3, 6, 7}, {4, 8, 9}, {5, 10, 11}}));
    EXPECT_TRUE(odd_segments({}).empty());
}

TEST(OddSegments, PairsInEitherDirectionAreLeftOut) {
    const PlaneSegment a{Vec2{0.1, 0.7}, Vec2{-0.3, 0.2}}, b{Vec2{0.1, 0.7}, Vec2{1, 1}};
    const PlaneSegment back{a[1], a[0]};
    EXPECT_EQ(odd_segments(std::vector{a, b, back}), (Parts{{1, 2, 3}}));
    EXPECT_EQ(odd_segments(std::vector{b, a, a, back}), (Parts{{0, 0, 1}, {1, 2, 3}}));
    EXPECT_TRUE(odd_segments(std::vector{a, a, back, back}).empty());
}

TEST(OddSegments, PartsEndAtTheEndsOfOthers) {
    for (const Vec2 step : {Vec2{1, 0}, Vec2{0, -1}, Vec2{1, 1}, Vec2{-3, 1}}) {
        const auto at = [&](double s) { return s * step; };
        // Two share 2 to 3 and 6 to 7; four share 5 to 6.
        const std::vector<PlaneSegment> segments{
            {at(8), at(0)}, {at(2), at(3)}, {at(6), at(5)}, {at(5), at(6)}, {at(5), at(7)}};
        const Parts parts = odd_segments(segments);
        std::vector<std::array<Vec2, 2>> found;
        for (const SegmentPart& p : parts) {
            EXPECT_EQ(p.segment, 0u);
            found.push_back({segments[p.from / 2][p.from % 2], segments[p.to / 2][p.to % 2]});
        }
        EXPECT_EQ(found, (std::vector<std::array<Vec2, 2>>{
                             {at(8), at(7)}, {at(5), at(3)}, {at(2), at(0)}}));
    }
}

TEST(OddSegments, NearlyOnOneLineIsNotOnIt) {
    const double up = std::nextafter(0.5, 1.0);
    EXPECT_EQ(odd_segments(
                  std::vector<PlaneSegment>{{Vec2{0, 0}, Vec2{1, 1}}, {Vec2{0, 0}, Vec2{0.5, up}}})
                  .size(),
              2u);
    EXPECT_EQ(odd_segments(std::vector<PlaneSegment>{{Vec2{0, 0}, Vec2{1, 1}},
                                                     {Vec2{0, 0}, Vec2{0.5, 0.5}}}),
              (Parts{{0, 3, 1}}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
