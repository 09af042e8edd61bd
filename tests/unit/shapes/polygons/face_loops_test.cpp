#include "alhazen/shapes/polygons/face_loops.h"

#include <gtest/gtest.h>

#include "alhazen/geometry/polygon/convex_corners.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// The volume within the loops, by the divergence theorem.
double volume_within(const std::vector<FaceLoop>& loops) {
    double six = 0.0;
    for (const FaceLoop& loop : loops) {
        const std::vector<Vec3>& c = loop.corners;
        for (std::size_t k = 1; k + 1 < c.size(); ++k) six += dot(c[0], cross(c[k], c[k + 1]));
        for (const Vec3& p : c) EXPECT_NEAR(dot(p - c[0], loop.normal), 0.0, 1e-12);
        EXPECT_GT(dot(cross(c[1] - c[0], c[2] - c[0]), loop.normal), 0.0) << loop.face;
    }
    return six / 6.0;
}

TEST(FaceLoops, EncloseTheVolumeOfABox) {
    BoxShape box;
    box.lo = {-1, 2, 0.5};
    box.hi = {3, 2.5, 4};
    const std::vector<FaceLoop> loops = face_loops(box);
    ASSERT_EQ(loops.size(), 6u);
    EXPECT_NEAR(volume_within(loops), 4.0 * 0.5 * 3.5, 1e-12);
}

TEST(FaceLoops, EncloseTheVolumeOfAPyramidAndLeaveOutAPlaneBesideIt) {
    Polyhedron solid = hexahedron({Vec3{-1, -1, 0},
                                   {1, -1, 0},
                                   {1, 1, 0},
                                   {-1, 1, 0},
                                   {0, 0, 3},
                                   {0, 0, 3},
                                   {0, 0, 3},
                                   {0, 0, 3}});
    solid.prepare();
    auto loops = face_loops(solid);
    ASSERT_TRUE(loops);
    ASSERT_EQ(loops->size(), 5u);
    EXPECT_NEAR(volume_within(*loops), 4.0, 1e-12);

    Polyhedron planes;
    for (const FaceLoop& loop : *loops) planes.planes.push_back({loop.corners[0], loop.normal});
    planes.planes.insert(planes.planes.begin(), OrientedPlane{{0, 0, 9}, {0, 0, 1}});
    planes.prepare();
    loops = face_loops(planes);
    ASSERT_TRUE(loops);
    EXPECT_EQ(loops->size(), 5u);
    EXPECT_EQ(loops->front().face, 1u);
    EXPECT_NEAR(volume_within(*loops), 4.0, 1e-9);

    planes.planes.resize(4);
    planes.prepare();
    EXPECT_FALSE(face_loops(planes));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
