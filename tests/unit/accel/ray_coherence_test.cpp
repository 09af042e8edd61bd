#include "alhazen/accel/directions/ray_coherence.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

class Balls final : public BoundsSource {
  public:
    std::vector<BoundingSphere> balls;

    [[nodiscard]] std::size_t size() const override { return balls.size(); }
    [[nodiscard]] Box3 box(std::size_t i) const override {
        const Vec3 half{balls[i].radius, balls[i].radius, balls[i].radius};
        return {balls[i].center - half, balls[i].center + half};
    }
    [[nodiscard]] BoundingSphere sphere(std::size_t i) const override { return balls[i]; }
};

Vec3 point(RandomStream& random, double reach) {
    const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
    return {x, y, random.uniform(-reach, reach)};
}

/// Balls of the same density for any count.
Balls balls(int count) {
    RandomStream random(1);
    Balls made;
    const double reach = std::cbrt(count);
    for (int i = 0; i < count; ++i) {
        made.balls.push_back({point(random, reach), random.uniform(0.02, 0.1)});
    }
    return made;
}

TEST(CoherenceLists, ARayFromASphereMeetsNothingBesideItsList) {
    const Balls made = balls(400);
    const CoherenceLists lists(made, {{0, 0, 9}}, 1e-9, 8, 1 << 26);
    RandomStream random(2);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto from = static_cast<std::uint32_t>(random.below(401));
        const auto to = static_cast<std::uint32_t>(random.below(400));
        const bool light = from == 400;
        const Vec3 start =
            light ? Vec3{0, 0, 9}
                  : made.balls[from].center + made.balls[from].radius * normalize(point(random, 1));
        const Vec3 end = made.balls[to].center +
                         made.balls[to].radius * random.uniform() * normalize(point(random, 1));
        if (start == end) continue;
        const auto& list = *lists.find(from, end - start);
        const auto found = std::find_if(list.begin(), list.end(),
                                        [&](const auto& c) { return c.primitive == to; });
        ASSERT_NE(found, list.end()) << "from " << from << " to " << to;
        EXPECT_LE(found->begin, length(end - start));
        met += list.size() < 200;
    }
    EXPECT_GT(met, 10000);
    EXPECT_EQ(lists.origin_of_light(0), 400u);
}

TEST(CoherenceLists, APointIsInTheLeastSphereThatHoldsIt) {
    Balls made = balls(200);
    made.balls.push_back({{0, 0, 0}, 20});
    const CoherenceLists lists(made, {}, 1e-9, 4, 1 << 26);
    for (std::uint32_t i = 0; i < 200; ++i) {
        const auto origin = lists.origin_at(made.balls[i].center);
        ASSERT_TRUE(origin.primitive);
        EXPECT_LE(made.balls[*origin.primitive].radius, made.balls[i].radius);
        EXPECT_LE(length(made.balls[*origin.primitive].center - made.balls[i].center),
                  made.balls[*origin.primitive].radius + 1e-9);
    }
    EXPECT_EQ(lists.origin_at({15, 0, 0}).primitive, 200u);
    EXPECT_FALSE(lists.origin_at({19, 19, 19}).primitive);
    EXPECT_FALSE(lists.origin_at({99, 0, 0}).primitive);
}

TEST(CoherenceLists, WithoutMemoryThereIsNoList) {
    const CoherenceLists lists(balls(20), {}, 1e-9, 8, 0);
    EXPECT_EQ(lists.find(3, {1, 0, 0}), nullptr);
}

TEST(RayCoherence, TooManyPrimitivesAreLeftToTheOther) {
    const Balls made = balls(50);
    EXPECT_EQ(RayCoherence::build(made, {.most = 49}).lists(), nullptr);
    EXPECT_NE(RayCoherence::build(made, {.most = 50}).lists(), nullptr);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
