#include "alhazen/accel/motion/motion_bvh.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Whether the ray meets the box, by clipping it against each pair of planes.
bool meets(const Box3& box, const Ray& ray) {
    double enter = ray.t_min, exit = ray.t_max;
    for (int k = 0; k < 3; ++k) {
        if (ray.direction[k] == 0.0) {
            if (ray.origin[k] < box.lo[k] || ray.origin[k] > box.hi[k]) return false;
            continue;
        }
        const double a = (box.lo[k] - ray.origin[k]) / ray.direction[k];
        const double b = (box.hi[k] - ray.origin[k]) / ray.direction[k];
        enter = std::max(enter, std::min(a, b));
        exit = std::min(exit, std::max(a, b));
    }
    return enter <= exit;
}

std::vector<MovingBox> random_boxes(std::mt19937_64& random, int count, double size,
                                    const Vec3& center) {
    std::uniform_real_distribution<double> number(-1, 1);
    const auto vector = [&] { return Vec3{number(random), number(random), number(random)}; };
    std::vector<MovingBox> boxes;
    for (int i = 0; i < count; ++i) {
        MovingBox& box = boxes.emplace_back();
        const Vec3 at = center + size * vector(), move = 0.2 * size * vector();
        const Vec3 half = 0.05 * size * vector();
        box.at_open = {at - abs(half), at + abs(half)};
        box.at_close = {at + move - abs(half), at + move + 1.5 * abs(half)};
    }
    return boxes;
}

TEST(MotionBvh, VisitsAllThatARayMeetsAtItsTime) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    for (const int count : {0, 1, 2, 7, 8, 9, 60, 1000}) {
        for (const double size : {1.0, 1e-6, 1e8}) {
            const Vec3 center = count % 2 == 0 ? Vec3{} : Vec3{30 * size, -7 * size, 0};
            std::vector<MovingBox> boxes = random_boxes(random, count, size, center);
            if (count > 8) {
                boxes[3] = {};                      // cannot be hit
                boxes[5] = {kAllSpace, kAllSpace};  // unbounded
                boxes[6].at_open.hi = boxes[6].at_open.lo;
                boxes[6].at_close = boxes[6].at_open;
            }
            const MotionBvh tree(boxes);
            for (int i = 0; i < 200; ++i) {
                const double time = i < 2 ? i : 0.5 * (1 + number(random));
                Ray ray{center + 2 * size * Vec3{number(random), number(random), number(random)},
                        {number(random), number(random), i % 5 == 0 ? 0.0 : number(random)}};
                // Along an axis and along planes, from either side of zero.
                if (i % 5 == 1) ray.direction.z = -0.0;
                if (i % 7 == 3) {
                    ray.direction = {i % 2 == 0 ? 1.0 : -1.0, -0.0, i % 3 == 0 ? -0.0 : 0.0};
                    ray.origin =
                        center + Vec3{-2 * size * ray.direction.x, 0.3 * size * number(random),
                                      0.3 * size * number(random)};
                }
                if (i % 4 == 0) ray.t_max = size;
                std::multiset<std::uint32_t> visited, in_any_order;
                tree.traverse<MotionBvh::Order::NearFirst>(
                    ray, time, [&] { return ray.t_max; },
                    [&](std::uint32_t thing) {
                        visited.insert(thing);
                        return false;
                    },
                    NoStats{});
                tree.traverse<MotionBvh::Order::Any>(
                    ray, time, [&] { return ray.t_max; },
                    [&](std::uint32_t thing) {
                        in_any_order.insert(thing);
                        return false;
                    },
                    NoStats{});
                EXPECT_EQ(visited, in_any_order);
                for (std::uint32_t thing = 0; thing < boxes.size(); ++thing) {
                    EXPECT_LE(visited.count(thing), 1u);
                    if (boxes[thing].empty()) {
                        EXPECT_EQ(visited.count(thing), 0u);
                    } else if (meets(boxes[thing].at(time), ray)) {
                        EXPECT_EQ(visited.count(thing), 1u) << count << ' ' << size << ' ' << i;
                    }
                }
            }
        }
    }
}

TEST(MotionBvh, SkipsMostOfWhatARayMisses) {
    std::mt19937_64 random(4);
    const std::vector<MovingBox> boxes = random_boxes(random, 5000, 1, {});
    const MotionBvh tree(boxes);
    TraversalStats stats;
    for (int i = 0; i < 100; ++i) {
        const Ray ray{{-3, 0.01 * i - 0.5, 0}, {1, 0, 0}};
        tree.traverse<MotionBvh::Order::NearFirst>(
            ray, 0.01 * i, [&] { return ray.t_max; }, [&](std::uint32_t) { return false; },
            CountingStats{&stats});
    }
    EXPECT_LT(stats.node_visits, 100 * 120u);
}

TEST(MotionBvh, EndsWhereTheVisitorSays) {
    std::mt19937_64 random(5);
    const MotionBvh tree(random_boxes(random, 500, 1, {}));
    int visits = 0;
    tree.traverse<MotionBvh::Order::Any>(
        Ray{{-3, 0, 0}, {1, 0, 0}}, 0.5, [] { return 100.0; },
        [&](std::uint32_t) {
            ++visits;
            return true;
        },
        NoStats{});
    EXPECT_LE(visits, 1);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
