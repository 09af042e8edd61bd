#include "alhazen/session/build_choice.h"

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// A mesh of 2 n n triangles with a camera and lights, without its tree.
LoadedScene field(int n, int lights) {
    std::string text =
        "alhazen 1\nperspective_camera { eye = (0, 0, 9); look_at = (0, 0, 0); aspect = 1 }\n";
    for (int i = 0; i < lights; ++i) text += "point_light { position = (3, 5, 4) }\n";
    text += "mesh { points = [";
    const auto list = [&](int count, const auto& item) {
        for (int i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + item(i);
    };
    const int side = n + 1;
    list(side * side, [&](int i) {
        return "(" + std::to_string(i % side) + ", " + std::to_string(i / side) + ", 0)";
    });
    text += "]; faces = [";
    list(n * n, [&](int i) {
        const int at = i / n * side + i % n;
        return "(" + std::to_string(at) + ", " + std::to_string(at + 1) + ", " +
               std::to_string(at + side + 1) + ", " + std::to_string(at + side) + ")";
    });
    text += "] }\n";
    const auto path = std::filesystem::path(::testing::TempDir()) / "build_choice.alhazen";
    write_file_atomically(path, text);
    LoadOptions options;
    options.with_aggregate = false;
    return load(path, options);
}

RenderOptions picture(int width, int height) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    return options;
}

TEST(BuildChoice, IsFastWhereRaysAreFewForTheTriangles) {
    EXPECT_EQ(quality_for(1000, 31999.0), BuildQuality::Fast);
    EXPECT_EQ(quality_for(1000, 32000.0), BuildQuality::Default);
    EXPECT_EQ(quality_for(0, 0.0), BuildQuality::Default);
}

TEST(BuildChoice, CountsTheRaysOfThePicture) {
    const LoadedScene scene = field(20, 1);  // 800 triangles: up to 25600 rays
    EXPECT_EQ(quality_for_picture(scene, picture(127, 100)), BuildQuality::Fast);
    EXPECT_EQ(quality_for_picture(scene, picture(128, 100)), BuildQuality::Default);
    RenderOptions options = picture(128, 100);
    options.crop = PixelBox{0, 0, 127, 100};
    EXPECT_EQ(quality_for_picture(scene, options), BuildQuality::Fast);
    options.samples_per_pixel = 2;
    EXPECT_EQ(quality_for_picture(scene, options), BuildQuality::Default);
    // The other side by the camera's ratio, 1.
    RenderOptions height;
    height.height = 113;
    EXPECT_EQ(quality_for_picture(scene, height), BuildQuality::Fast);
    height.height = 114;
    EXPECT_EQ(quality_for_picture(scene, height), BuildQuality::Default);
    EXPECT_EQ(quality_for_picture(field(20, 2), picture(127, 100)), BuildQuality::Default);
    RenderOptions adaptive = picture(10, 10);
    adaptive.antialias = AntialiasSettings{};
    EXPECT_EQ(quality_for_picture(scene, adaptive), BuildQuality::Default);
    EXPECT_THROW((void)quality_for_picture(scene, picture(0, 10)), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
