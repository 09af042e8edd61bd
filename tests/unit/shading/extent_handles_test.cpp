#include "alhazen/shading/lights/extent_handles.h"

#include <gtest/gtest.h>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::vector<LightExtent> all_extents() {
    const PolygonExtent outline{{{1, 1, 1}, {3, 1, 1}, {3, 2, 1}, {2, 3, 1}, {1, 2, 1}}};
    const MeshExtent roof{{{0, 0, 0}, {2, 0, 0}, {2, 1, 1}, {0, 1, 1}}, {{0, 1, 2}, {0, 2, 3}}};
    return {RectangleExtent{{-1, 2, 1}, {2, 0, 0}, {0, 0, 3}},
            DiscExtent{{1, 2, 3}, {0, -2, 0}, 0.5, 0.25},
            SphereExtent{{3, 2, 1}, 0.75},
            TubeExtent{{0, 1, 0}, {2, 1, 1}, 0.125},
            outline,
            roof};
}

TEST(ExtentHandles, WhatIsSetIsWhatIsThenThere) {
    const Vec3 position{4, -5, 6}, direction = normalize(Vec3{-1, 2, 0.5});
    for (const LightExtent& extent : all_extents()) {
        const ExtentHandles before = handles_of(extent);
        std::vector<double> sizes;
        for (const ExtentSize& size : before.sizes) sizes.push_back(1.5 * size.value);
        ExtentChange change{position, {}, sizes};
        if (before.direction) change.direction = direction;
        const ExtentHandles after = handles_of(changed(extent, change));
        EXPECT_LT(length(after.position - position), 1e-14) << extent.index();
        ASSERT_EQ(after.direction.has_value(), before.direction.has_value());
        if (before.direction) {
            EXPECT_LT(length(normalize(*after.direction) - direction), 1e-14) << extent.index();
        }
        // A scale is relative to the present extent, so it is 1.
        const bool scales = std::string(before.sizes.front().name) == "scale";
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            EXPECT_NEAR(after.sizes[i].value, scales ? 1.0 : sizes[i], 1e-14) << extent.index();
        }
        EXPECT_NEAR(LightSurface(changed(extent, change), false).area(),
                    2.25 * LightSurface(extent, false).area(), 1e-13)
            << extent.index();
    }
}

TEST(ExtentHandles, WhatIsSetToWhatItIsStays) {
    for (const LightExtent& extent : all_extents()) {
        EXPECT_EQ(changed(extent, {}), extent) << extent.index();
        const ExtentHandles now = handles_of(extent);
        std::vector<double> sizes;
        for (const ExtentSize& size : now.sizes) sizes.push_back(size.value);
        EXPECT_EQ(changed(extent, {now.position, now.direction, sizes}), extent) << extent.index();
    }
}

// The cross product of opposite normals does not define an axis.
TEST(ExtentHandles, ASurfaceIsTurnedToItsBack) {
    for (const LightExtent& extent : all_extents()) {
        const ExtentHandles now = handles_of(extent);
        if (!now.direction) continue;
        const Vec3 back = Vec3{} - *now.direction;
        const LightExtent turned = changed(extent, {{}, back, {}});
        EXPECT_EQ(fault_of(turned), nullptr);
        EXPECT_LT(length(normalize(*handles_of(turned).direction) - normalize(back)), 1e-15)
            << extent.index();
        EXPECT_LT(length(handles_of(turned).position - now.position), 1e-15) << extent.index();
    }
}

TEST(ExtentHandles, TheLeastRotationKeepsWhatIsAcross) {
    const LightExtent lamp = RectangleExtent{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    // From z to -y about x: the edge along x stays.
    const LightExtent turned = changed(lamp, {{}, Vec3{0, -3, 0}, {}});
    const auto& r = std::get<RectangleExtent>(turned);
    EXPECT_LT(length(r.edge_u - Vec3{2, 0, 0}), 1e-15);
    EXPECT_LT(length(r.edge_v - Vec3{0, 0, 1}), 1e-15);
    EXPECT_LT(length(r.corner - Vec3{0, 0.5, -0.5}), 1e-15);
}

TEST(ExtentHandles, SizesThatLeaveNoAreaAreAFault) {
    EXPECT_NE(fault_of(changed(SphereExtent{}, {{}, {}, std::vector<double>{0}})), nullptr);
    EXPECT_NE(fault_of(changed(DiscExtent{}, {{}, {}, std::vector<double>{1, 1}})), nullptr);
    EXPECT_NE(fault_of(changed(RectangleExtent{}, {{}, {}, std::vector<double>{1, 0}})), nullptr);
    EXPECT_EQ(fault_of(changed(DiscExtent{}, {{}, {}, std::vector<double>{2, 1}})), nullptr);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
