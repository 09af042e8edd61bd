#include "alhazen/shading/textures/normal_map.h"

#include <gtest/gtest.h>

#include "support/expect_near.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;

const Vec3 kUp{0, 0, 1};
const Rgb kTiltedRight{1, 0.5, 0.5}, kTiltedUp{0.5, 1, 0.5}, kFlat{0.5, 0.5, 1};

TEST(NormalMap, RedTiltsAlongUAndGreenAlongV) {
    const TangentFrame frame = frame_from_derivatives(kUp, {3, 0, 0}, {0, 5, 0});
    expect_near(bent_normal(kTiltedRight, 1, kUp, frame), {1, 0, 0});
    expect_near(bent_normal(kTiltedUp, 1, kUp, frame), {0, 1, 0});
    expect_near(bent_normal(kFlat, 1, kUp, frame), kUp);
}

TEST(NormalMap, MirroredCoordinatesMirrorTheTilt) {
    // u runs to the left: a texel tilted to the right is tilted to the left in space; v still runs
    // upward.
    const TangentFrame frame = frame_from_derivatives(kUp, {-1, 0, 0}, {0, 1, 0});
    expect_near(bent_normal(kTiltedRight, 1, kUp, frame), {-1, 0, 0});
    expect_near(bent_normal(kTiltedUp, 1, kUp, frame), {0, 1, 0});
}

TEST(NormalMap, TangentsOfTheMeshGiveTheSameFrameAsItsCoordinates) {
    for (const double sign : {1.0, -1.0}) {
        const Vec3 tangent{1, 0, 0};
        const Vec3 bitangent = sign * cross(kUp, tangent);
        const TangentFrame from_mesh = frame_from_tangents(kUp, tangent, bitangent);
        const TangentFrame from_uv = frame_from_derivatives(kUp, tangent, {0.3, sign, 0});
        expect_near(from_mesh.tangent, from_uv.tangent);
        expect_near(from_mesh.bitangent, from_uv.bitangent);
        expect_near(bent_normal(kTiltedUp, 1, kUp, from_mesh), {0, sign, 0});
    }
}

TEST(NormalMap, ScaleTiltsMore) {
    const TangentFrame frame = frame_from_derivatives(kUp, {1, 0, 0}, {0, 1, 0});
    const Rgb texel{0.75, 0.5, 1};
    expect_near(bent_normal(texel, 2, kUp, frame), normalize(Vec3{1, 0, 1}));
    expect_near(bent_normal(texel, 0, kUp, frame), kUp);
}

TEST(NormalMap, WithoutAFrameOrADirectionTheNormalStays) {
    expect_near(bent_normal(kTiltedUp, 1, kUp, {}), kUp);
    const TangentFrame frame = frame_from_derivatives(kUp, {1, 0, 0}, {0, 1, 0});
    expect_near(bent_normal({0.5, 0.5, 0.5}, 1, kUp, frame), kUp);
    EXPECT_EQ(frame_from_derivatives(kUp, {}, {}).tangent, Vec3{});
    EXPECT_EQ(frame_from_derivatives(kUp, {0, 0, 2}, {0, 1, 0}).tangent, Vec3{});
}

TEST(NormalMap, ATransformOfTheCoordinatesTurnsTheFrame) {
    // (u', v') = (-v, u): u' grows along -v, v' along u.
    const UvTransform quarter{.uu = 0, .uv = -1, .vu = 1, .vv = 0};
    Vec3 dpdu{1, 0, 0}, dpdv{0, 1, 0};
    apply_uv_transform(quarter, dpdu, dpdv);
    expect_near(dpdu, {0, -1, 0});
    expect_near(dpdv, {1, 0, 0});
    const UvTransform flat{.uu = 0, .uv = 0, .vu = 0, .vv = 1};
    apply_uv_transform(flat, dpdu, dpdv);
    EXPECT_EQ(dpdu, Vec3{});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
