// Ten million lines aimed at borders, corners and tangents of closed patch meshes: none is crossed
// an odd number of times.

#include <gtest/gtest.h>

#include "closed_patches.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;

int odd_lines(const PatchMesh& mesh, Random& random, int lines) {
    int odd = 0;
    for (int i = 0; i < lines; ++i) {
        ShapeHits hits;
        mesh.intersect(testing::hard_line(mesh, random), hits);
        if (hits.size() % 2 != 0) ++odd;
    }
    return odd;
}

TEST(PatchParity, TenMillionHardLinesCrossClosedMeshesEvenly) {
    Random random(20);
    EXPECT_EQ(odd_lines(testing::torus_of_patches(1.0, 0.4), random, 2'500'000), 0);
    EXPECT_EQ(odd_lines(testing::sphere_of_patches(), random, 2'500'000), 0);
    for (int mesh = 0; mesh < 50; ++mesh) {
        const double change = mesh % 5 == 0 ? 0.0 : random.log_uniform(0.01, 1.0);
        EXPECT_EQ(odd_lines(testing::random_closed_patches(random, change), random, 100'000), 0)
            << mesh;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
