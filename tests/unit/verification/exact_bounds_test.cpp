#include "alhazen/verification/exact_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/formats/importer_list.h"
#include "alhazen/scene/scene.h"
#include "alhazen/session/load.h"
#include "support/scratch_folder.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

Box3 bounds_of(const std::string& name, const std::string& text) {
    const testing::ScratchFolder folder;
    const LoadedScene loaded = load(folder.write(name, text));
    return exact_bounds(*loaded.scene.aggregate);
}

TEST(ExactBounds, AreThoseOfTheVertices) {
    const Box3 box = bounds_of("t.obj", "v 0.1 -0.3 0\nv 1 0 0.7\nv 0.2 1 -5\nf 1 2 3\nv 9 9 9\n");
    EXPECT_EQ(box.lo, (Vec3{0.1, -0.3, -5}));
    EXPECT_EQ(box.hi, (Vec3{1, 1, 0.7}));
}

TEST(ExactBounds, LeaveOutWhatIsEndless) {
    const Box3 box =
        bounds_of("s.alhazen", "alhazen 1\nplane { }\nsphere { center = (3, 0, 0); radius = 1 }\n");
    EXPECT_EQ(box.lo, (Vec3{2, -1, -1}));
    EXPECT_EQ(box.hi, (Vec3{4, 1, 1}));
}

/// A strip of 70 triangles on x + y = 1, whose box grows considerably by rotation.
std::string strip() {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 72\nproperty float x\nproperty float "
        "y\nproperty float z\nelement face 70\nproperty list uchar int vertex_indices\n"
        "end_header\n";
    for (int i = 0; i < 72; ++i) {
        const double x = (i / 2) / 35.0;
        text +=
            std::to_string(x) + " " + std::to_string(1 - x) + " " + std::to_string(i % 2) + "\n";
    }
    for (int i = 0; i < 70; ++i) {
        text += "3 " + std::to_string(i) + " " + std::to_string(i + 1) + " " +
                std::to_string(i + 2) + "\n";
    }
    return text;
}

TEST(ExactBounds, OfSharedMeshesAreThoseOfTheirPlacedVertices) {
    const testing::ScratchFolder folder;
    folder.write("strip.ply", strip());
    const LoadedScene loaded =
        load(folder.write("s.alhazen",
                          "alhazen 1\nobject \"m\" { mesh { file = \"strip.ply\" } }\n"
                          "instance \"m\" { transform = rotate((0, 0, 1), 45) }\n"
                          "instance \"m\" { transform = rotate((0, 0, 1), 45) }\n"));
    ASSERT_EQ(loaded.scene.census.instances, 2U);
    const Box3 box = exact_bounds(*loaded.scene.aggregate);
    // The rotated box of the strip would reach from -0.71 to 0.71 and from 0 to 1.41.
    EXPECT_NEAR(box.lo.x, -std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(box.lo.y, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(box.hi.y, std::sqrt(0.5), 1e-6);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
