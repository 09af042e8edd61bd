#include "alhazen/accel/directions/ray_classification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "unit/accel/random_boxes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

Ray random_ray(RandomStream& random, double reach) {
    Ray ray;
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = random.uniform(-reach, reach);
        ray.direction[k] = random.uniform(-1, 1);
    }
    return ray;
}

TEST(ClassifiedRay, FiveNumbersAndADirectionAreTheRayAgain) {
    RandomStream random(1);
    for (int i = 0; i < 1000; ++i) {
        const Ray ray = random_ray(random, 2);
        const double t = random.uniform(0, 3);
        const ClassifiedRay c(ray, t);
        EXPECT_EQ((Vec3{c.point[0], c.point[1], c.point[2]}), ray.at(t));
        const int axis = c.direction / 2;
        Vec3 direction;
        direction[axis] = c.direction % 2 == 0 ? 1 : -1;
        direction[(axis + 1) % 3] = c.point[3];
        direction[(axis + 2) % 3] = c.point[4];
        const Vec3 scaled = ray.direction / max_component(abs(ray.direction));
        EXPECT_LT(max_component(abs(direction - scaled)), 1e-15);
        EXPECT_LE(std::abs(c.point[3]), 1);
        EXPECT_LE(std::abs(c.point[4]), 1);
    }
}

TEST(RayHypercubes, TheListOfARayHasAllThatItMeetsInOrder) {
    const Boxes boxes = random_boxes(500, 0.1, 2);
    const RayHypercubes classes(boxes, {});
    RandomStream random(3);
    std::size_t met = 0, listed = 0;
    for (int i = 0; i < 5000; ++i) {
        const Ray ray = random_ray(random, 1);
        const RaySpan inside(classes.space().box, ray, ray.t_max);
        if (inside.empty()) continue;
        const ClassifiedRay classified(ray, inside.begin);
        const RayHypercubes::List& list = *classes.find(classified).list;
        listed += list.size();
        for (std::size_t e = 1; e < list.size(); ++e) {
            EXPECT_LE(classes.begin_along(list[e - 1], classified.direction),
                      classes.begin_along(list[e], classified.direction));
        }
        for (std::uint32_t b = 0; b < boxes.size(); ++b) {
            if (RaySpan(boxes.box(b), ray, ray.t_max).empty()) continue;
            ++met;
            EXPECT_NE(std::find(list.begin(), list.end(), b), list.end())
                << "ray " << i << ", box " << b;
        }
    }
    EXPECT_GT(met, 1000u);
    EXPECT_LT(listed, 5000u * 100);
}

TEST(RayHypercubes, WithoutMemoryTheListIsEverything) {
    const Boxes boxes = random_boxes(50, 0.1, 2);
    const RayHypercubes classes(boxes, {.memory_bytes = 0});
    RandomStream random(4);
    const ClassifiedRay ray(random_ray(random, 1), 0);
    EXPECT_EQ(classes.find(ray).list->size(), 50u);
}

TEST(RayHypercubes, WhereMemoryRunsOutListsAreMadeAnewAndHoldAllTheSame) {
    const Boxes boxes = random_boxes(500, 0.1, 2);
    constexpr std::size_t kMemory = 200'000;
    const RayHypercubes all(boxes, {}), few(boxes, {.memory_bytes = kMemory});
    RandomStream random(7);
    for (int i = 0; i < 3000; ++i) {
        const ClassifiedRay ray(random_ray(random, 1), 0);
        const RayHypercubes::List& shorter = *all.find(ray).list;
        const RayHypercubes::List& list = *few.find(ray).list;
        EXPECT_EQ(list, shorter) << "ray " << i;
    }
    EXPECT_LE(few.memory_bytes(), kMemory + few.bodies().memory_bytes());
    EXPECT_LT(few.nodes_made(), all.nodes_made());
}

TEST(RayHypercubes, ARayLikeTheLastOneIsInItsClass) {
    const RayHypercubes classes(random_boxes(500, 0.1, 2), {});
    Ray ray{{0.1, 0.1, 0.1}, {1, 0.3, 0.2}};
    EXPECT_FALSE(classes.find({ray, 0}).cached);
    ray.direction.y += 1e-9;
    EXPECT_TRUE(classes.find({ray, 0}).cached);
    // Rays from outside start in a face of the space.
    int cached = 0;
    for (int i = 0; i < 1000; ++i) {
        const Ray eye{{0, -4, 0.3}, {0.0001 * i, 3.5, 0.2}};
        cached += classes.find({eye, RaySpan(classes.space().box, eye, 1e9).begin}).cached;
    }
    EXPECT_GT(cached, 900);
    // A hypercube of another scene is not reused.
    const RayHypercubes other(random_boxes(300, 0.1, 3), {});
    EXPECT_FALSE(other.find({ray, 0}).cached);
}

TEST(RayHypercubes, ListsDoNotDependOnTheThreadsThatMakeThem) {
    const Boxes boxes = random_boxes(300, 0.1, 5);
    std::vector<ClassifiedRay> rays;
    RandomStream random(6);
    for (int i = 0; i < 2000; ++i) rays.emplace_back(random_ray(random, 1), 0);
    const RayHypercubes alone(boxes, {});
    std::vector<RayHypercubes::List> expected;
    for (const ClassifiedRay& ray : rays) expected.push_back(*alone.find(ray).list);
    const RayHypercubes shared(boxes, {});
    std::array<int, 4> wrong{};
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < wrong.size(); ++t) {
        threads.emplace_back([&, t] {
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const std::size_t r = (i + 500 * t) % rays.size();
                wrong[t] += *shared.find(rays[r]).list != expected[r];
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, (std::array<int, 4>{}));
    EXPECT_EQ(shared.nodes_made(), alone.nodes_made());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
