#include "alhazen/accel/wide_bvh/build/morton_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "alhazen/accel/wide_bvh/build/curve_builder.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// The place of a point on the curve in a box, found by halving the longest side of its cell.
std::uint32_t place_on_curve(Float4 point, const Box4& box) {
    float side[3];
    int halvings[3]{};
    std::vector<int> axes;
    for (int k = 0; k < 3; ++k) side[k] = box.hi[k] - box.lo[k];
    while (axes.size() < 32) {
        int longest = -1;
        for (int k = 0; k < 3; ++k) {
            if (halvings[k] == 11 || side[k] <= 0) continue;
            if (longest < 0 || side[k] > side[longest]) longest = k;
        }
        if (longest < 0) break;
        side[longest] /= 2;
        ++halvings[longest];
        axes.push_back(longest);
    }
    std::uint32_t cell[3];
    for (int k = 0; k < 3; ++k) {
        const float cells = std::ldexp(1.0f, halvings[k]);
        const float place =
            halvings[k] == 0 ? 0 : (point[k] - box.lo[k]) * (cells / (box.hi[k] - box.lo[k]));
        cell[k] = static_cast<std::uint32_t>(std::min(place, cells - 1));
    }
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::uint32_t bit = cell[axes[i]] >> --halvings[axes[i]] & 1;
        code |= bit << (31 - i);
    }
    return code;
}

TEST(MortonOrder, DividesCrowdedCellsAnewAndKeepsTheOrderOfEqualPlaces) {
    std::mt19937_64 random(6);
    std::vector<Float4> points;
    // Most lie in a corner so small that it is one cell, in a flat box.
    for (std::size_t i = 0; i < 150000; ++i) {
        const float scale = i % 10 == 0 ? 1.0f : 0x1p-14f;
        const auto coordinate = [&] { return scale * static_cast<float>(random() % 64) / 64.0f; };
        const float x = coordinate(), y = coordinate();
        points.push_back(Float4{x, y, 0.125f * coordinate(), 0});
    }
    HugeRoom room(CurveOrder::room_bytes(points.size()));
    const auto make = [&](std::size_t begin, std::size_t end, Float4* to) {
        std::copy(points.data() + begin, points.data() + end, to);
    };
    const CurveOrder order({points.size(), make}, room);
    Box4 all;
    for (const Float4& p : points) all.include_point(p);
    std::vector<bool> seen(points.size());
    std::size_t inner = 0, same = 0;
    for (std::size_t begin = 0; begin < points.size();) {
        const auto cell_of = [&](std::size_t i) { return order.place(i) >> 32; };
        std::size_t end = begin;
        Box4 box;
        for (; end < points.size() && cell_of(end) == cell_of(begin); ++end) {
            box.include_point(points[order.index(end)]);
        }
        for (std::size_t i = begin; i < end; ++i) {
            const Float4 point = points[order.index(i)];
            ASSERT_FALSE(seen[order.index(i)]);
            seen[order.index(i)] = true;
            ASSERT_EQ(cell_of(i), place_on_curve(point, all));
            const bool crowded = end - begin > kCurveLeafSize;
            ASSERT_EQ(static_cast<std::uint32_t>(order.place(i)),
                      crowded ? place_on_curve(point, box) : 0);
            if (i == 0) continue;
            ASSERT_LE(order.place(i - 1), order.place(i));
            inner += cell_of(i - 1) == cell_of(i) && order.place(i - 1) < order.place(i);
            if (order.place(i - 1) != order.place(i)) continue;
            ++same;
            ASSERT_LT(order.index(i - 1), order.index(i));
        }
        begin = end;
    }
    EXPECT_GT(inner, 1000u);
    EXPECT_GT(same, 1000u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
