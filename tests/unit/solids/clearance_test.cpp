#include "alhazen/solids/clearance.h"

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "alhazen/solids/solid_list.h"
#include "support/box_mesh.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::add_box;
using testing::SceneMaker;

/// Clearance of the only two shapes of a scene.
template <class A, class B>
Clearance between(const A& a, const B& b, const Affine& place_b = {}) {
    SceneMaker maker;
    maker.add(a, MaterialId{0}, Affine::translate({1, 2, 3}));
    maker.add(b, MaterialId{0}, Affine::translate({1, 2, 3}) * place_b);
    const SolidList solids(maker.compile().aggregate);
    // The table orders them as the list of shapes does.
    return clearance(IsolatedSolid(solids, SolidId{0}), IsolatedSolid(solids, SolidId{1}));
}

void expect_clearance(const Clearance& found, double truth, double within) {
    EXPECT_FALSE(found.overlap);
    EXPECT_NEAR(found.at_most, truth, within);
    EXPECT_GE(found.at_most, truth - 1e-12);
    EXPECT_LE(found.at_least, truth + 1e-12);
}

TEST(Clearance, OfConvexSolidsBothBoundsMeet) {
    const Clearance spheres = between(Sphere{{0, 0, 0}, 1}, Sphere{{3, 4, 0}, 2});
    expect_clearance(spheres, 2, 1e-9);
    EXPECT_NEAR(spheres.at_least, 2, 1e-9);
    const Clearance boxes = between(BoxShape{{0, 0, 0}, {1, 1, 1}}, BoxShape{{2, 3, 0}, {3, 4, 1}});
    expect_clearance(boxes, std::sqrt(5.0), 1e-6);
    EXPECT_NEAR(boxes.at_least, std::sqrt(5.0), 1e-6);
    const Clearance turned =
        between(Sphere{{0, 0, 0}, 1}, BoxShape{{-1, -1, -1}, {1, 1, 1}},
                Affine::translate({5, 0, 0}) * Affine::rotate({0, 0, 1}, 0.78539816339744831));
    expect_clearance(turned, 4 - std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(turned.at_least, 4 - std::sqrt(2.0), 1e-6);
    const Clearance crossed =
        between(Cylinder{{-5, 0, 0}, {5, 0, 0}, 1}, Cylinder{{0, -5, 3.25}, {0, 5, 3.25}, 2});
    expect_clearance(crossed, 0.25, 1e-9);
    EXPECT_NEAR(crossed.at_least, 0.25, 1e-9);
}

TEST(Clearance, SolidsThatShareVolumeOverlap) {
    const Clearance found = between(Sphere{{0, 0, 0}, 1}, Sphere{{1.5, 0, 0}, 1});
    EXPECT_TRUE(found.overlap);
    EXPECT_EQ(found.at_most, 0);
    EXPECT_TRUE(between(Sphere{{0, 0, 0}, 5}, BoxShape{{-1, -1, -1}, {1, 1, 1}}).overlap);
}

TEST(Clearance, AnEmptySolidHasNone) {
    SceneMaker maker;
    const ObjectIndex nothing = maker.object("nothing");
    maker.description().objects.back().combine = Combine::Intersection;
    maker.add(Sphere{}, MaterialId{0}, {}, nothing);
    maker.add(Sphere{{5, 0, 0}, 1}, MaterialId{0}, {}, nothing);
    maker.add(nothing);
    maker.add(Sphere{{9, 0, 0}, 1});
    const SolidList solids(maker.compile().aggregate);
    ASSERT_EQ(solids.count(), 2u);
    const IsolatedSolid a(solids, SolidId{0}), b(solids, SolidId{1});
    for (const bool first : {true, false}) {
        try {
            (void)(first ? clearance(a, b) : clearance(b, a));
            ADD_FAILURE();
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("empty"), std::string::npos) << error.what();
        }
    }
}

TEST(Clearance, APinInAFrameHasAnUpperBoundOnly) {
    // A closed frame of four bars around a rod.
    TriangleMesh frame;
    add_box(frame, {{-3, 2, -1}, {3, 3, 1}});
    add_box(frame, {{-3, -3, -1}, {3, -2, 1}});
    add_box(frame, {{-3, -1.9, -1}, {-2, 1.9, 1}});
    add_box(frame, {{2, -1.9, -1}, {3, 1.9, 1}});
    SceneMaker maker;
    maker.add(Cylinder{{0.5, 0.25, -4}, {0.5, 0.25, 4}, 1});
    maker.add(maker.mesh(frame));
    const SolidList solids(maker.compile("wide_bvh").aggregate);
    const Clearance found =
        clearance(IsolatedSolid(solids, SolidId{0}), IsolatedSolid(solids, SolidId{1}));
    expect_clearance(found, 0.5, 1e-6);
    EXPECT_EQ(found.at_least, 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
