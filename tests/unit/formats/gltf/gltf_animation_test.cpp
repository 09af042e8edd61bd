#include "alhazen/formats/gltf/scene/gltf_animation.h"

#include <gtest/gtest.h>

#include "unit/formats/gltf/gltf_text.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

using gltf::Interpolation;
using gltf::Keys;
using gltf::Quaternion;

TEST(GltfAnimation, LinearKeysInterpolateAndEndsAreClamped) {
    const Keys keys{{1, 3}, {10, 0, 20, 4}, 2, Interpolation::Linear};
    EXPECT_EQ(gltf::value_at(keys, -5), (std::vector<double>{10, 0}));
    EXPECT_EQ(gltf::value_at(keys, 1), (std::vector<double>{10, 0}));
    EXPECT_EQ(gltf::value_at(keys, 1.5), (std::vector<double>{12.5, 1}));
    EXPECT_EQ(gltf::value_at(keys, 3), (std::vector<double>{20, 4}));
    EXPECT_EQ(gltf::value_at(keys, 99), (std::vector<double>{20, 4}));
}

TEST(GltfAnimation, StepKeysHoldUntilTheNextKey) {
    const Keys keys{{0, 1, 2}, {5, 6, 7}, 1, Interpolation::Step};
    EXPECT_EQ(gltf::value_at(keys, 0.999), std::vector<double>{5});
    EXPECT_EQ(gltf::value_at(keys, 1), std::vector<double>{6});
    EXPECT_EQ(gltf::value_at(keys, 1.5), std::vector<double>{6});
    EXPECT_EQ(gltf::value_at(keys, 2), std::vector<double>{7});
}

TEST(GltfAnimation, CubicSplineTangentsAreTimesTheSecondsBetweenKeys) {
    // Keys at 0 and 2 s: values 1 and 3, out-tangent 4, in-tangent -2. Halfway t = 1/2:
    // 1/2 * 1 + 2 * 1/8 * 4 + 1/2 * 3 + 2 * (-1/8) * (-2) = 0.5 + 1 + 1.5 + 0.5.
    const Keys keys{{0, 2}, {9, 1, 4, -2, 3, 9}, 1, Interpolation::CubicSpline};
    EXPECT_DOUBLE_EQ(gltf::value_at(keys, 1)[0], 3.5);
    // t = 1/4: 27/32 * 1 + 2 * 9/64 * 4 + 5/32 * 3 + 2 * (-3/64) * (-2).
    EXPECT_DOUBLE_EQ(gltf::value_at(keys, 0.5)[0], 27.0 / 32 + 72.0 / 64 + 15.0 / 32 + 12.0 / 64);
    EXPECT_DOUBLE_EQ(gltf::value_at(keys, 0)[0], 1);
    EXPECT_DOUBLE_EQ(gltf::value_at(keys, 7)[0], 3);
}

TEST(GltfAnimation, RotationsTurnTheShorterWayAround) {
    const double s = std::sqrt(0.5);
    // A quarter turn about z, given as a quaternion and as its negative: the same rotation.
    for (const double sign : {1.0, -1.0}) {
        const Keys keys{{0, 1}, {0, 0, 0, 1, 0, 0, sign * s, sign * s}, 4, Interpolation::Linear};
        const Quaternion third = gltf::rotation_at(keys, 1.0 / 3);
        EXPECT_NEAR(third[2], std::sin(0.5 * 3.14159265358979 / 6), 1e-12) << sign;
        EXPECT_NEAR(third[3], std::cos(0.5 * 3.14159265358979 / 6), 1e-12) << sign;
    }
}

TEST(GltfAnimation, RotationsAreUnitWhateverTheKeysAre) {
    const Keys spline{{0, 1},
                      {0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0},
                      4,
                      Interpolation::CubicSpline};
    const Quaternion q = gltf::rotation_at(spline, 0.5);
    // (0, 0, 1.5, 1) normalized.
    EXPECT_NEAR(q[2], 1.5 / std::sqrt(3.25), 1e-12);
    EXPECT_NEAR(q[3], 1.0 / std::sqrt(3.25), 1e-12);
    const Keys nothing{{0}, {0, 0, 0, 0}, 4, Interpolation::Linear};
    EXPECT_EQ(gltf::rotation_at(nothing, 0), (Quaternion{0, 0, 0, 1}));
}

/// A triangle that animation 0 ("slide") translates and animation 1 rotates.
std::string animated_triangle() {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const int times = t.floats("SCALAR", {0, 2}, bounds("0", "2"));
    const int slide = t.floats("VEC3", {0, 0, 0, 4, 0, 0});
    const int turn =
        t.signed_bytes("VEC4", {0, 0, 0, 127, 0, 0, 127, 0}, R"(, "normalized": true)");
    const auto n = [](int i) { return std::to_string(i); };
    return t.file(R"("scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "n", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": )" +
                  n(p) + R"(}}]}],
        "animations": [
          {"name": "slide", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
           "samplers": [{"input": )" +
                  n(times) + R"(, "output": )" + n(slide) + R"(}]},
          {"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
           "samplers": [{"input": )" +
                  n(times) + R"(, "output": )" + n(turn) + R"(}]}])");
}

TEST(GltfAnimation, WithoutATimeNodesRest) {
    const Imported result = import_gltf(animated_triangle());
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_EQ(world_positions(result.scene)[1], (Vec3{1, 0, 0}));
    ASSERT_EQ(result.scene.animations.size(), 2u);
    EXPECT_EQ(result.scene.animations[0].name, "slide");
    EXPECT_EQ(result.scene.animations[0].end, 2.0);
}

TEST(GltfAnimation, AtATimeAllAnimationsApply) {
    ImportOptions options;
    options.time = 1.0;
    const Imported result = import_gltf(animated_triangle(), options);
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    // Half of a half turn about z, and half of the translation along x.
    EXPECT_NEAR_VEC((Vec3{2, 1, 0}), world_positions(result.scene)[1], 1e-12);
}

TEST(GltfAnimation, OneAnimationIsChosenByNameOrPosition) {
    ImportOptions options;
    options.time = 2.0;
    options.animation = "slide";
    EXPECT_NEAR_VEC((Vec3{5, 0, 0}),
                    world_positions(import_gltf(animated_triangle(), options).scene)[1], 1e-12);
    options.animation = "1";
    EXPECT_NEAR_VEC((Vec3{-1, 0, 0}),
                    world_positions(import_gltf(animated_triangle(), options).scene)[1], 1e-12);
}

TEST(GltfAnimation, AnUnknownAnimationIsRefusedWithTheListOfThem) {
    ImportOptions options;
    options.animation = "jump";
    try {
        import_gltf(animated_triangle(), options);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        EXPECT_NE(std::string(error.what()).find("'jump'; the file has 0 'slide', 1"),
                  std::string::npos)
            << error.what();
    }
}

TEST(GltfAnimation, ATimeForAFileWithoutAnimationsIsAWarning) {
    ImportOptions options;
    options.time = 1.0;
    const Imported result =
        import_gltf(GltfText().file(R"("scenes": [{"nodes": [0]}], "nodes": [{}])"), options);
    EXPECT_TRUE(result.says("the file has no animations")) << result.messages();
    const TemporaryFolder folder;
    Diagnostics diagnostics;
    (void)import_scene(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), options,
                       diagnostics);
    EXPECT_TRUE(mentions(diagnostics, "files of the format obj have no animations"))
        << text_of(diagnostics);
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
