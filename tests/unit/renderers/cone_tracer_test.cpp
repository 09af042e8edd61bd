/// The tree and the tracer of cones, without pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/geometry/cones/disc_area.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/cone_tracing/cone_scene.h"
#include "alhazen/renderers/cone_tracing/cone_tracer.h"
#include "alhazen/renderers/cone_tracing/cone_tree.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"
#include "unit/renderers/unit_pixels.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::glowing;
using testing::SceneMaker;
using testing::unit_pixels;
using testing::upright;

/// A tracer of a scene of occluders only.
struct Blockers {
    Scene scene;
    ConeScene geometry;
    Camera camera = unit_pixels(1);
    RenderJob job;
    RayCounters counters;
    ConeTracer tracer;

    explicit Blockers(SceneMaker& maker)
        : scene(maker.compile()),
          geometry(cone_scene(maker.description(), scene)),
          job{.scene = scene, .camera = camera, .description = &maker.description()},
          tracer(job, geometry, false, counters) {}

    /// Share of a sphere of light that is seen from outside of it.
    double share(const Vec3& point, const Vec3& light, double radius) {
        const double distance = length(light - point);
        const double spread = radius / std::sqrt((distance - radius) * (distance + radius));
        ConeStart start;
        start.kind = RayKind::Shadow;
        start.range.z_max = distance;
        return tracer.let_through({point, (light - point) / distance, 0.0, spread}, start).r;
    }
};

TEST(ConeTracing, ThePenumbraOfASphereOfLightBehindAnEdgeIsItsSegment) {
    SceneMaker maker;
    maker.add(upright(0, 9, 5.0), maker.material(glowing({1, 1, 1})));
    Blockers blockers(maker);
    const double R = 0.3, D = 10;
    for (double x = -0.6; x <= 0.6; x += 0.05) {
        // In the cone towards the light the edge is a line, at 5 of 10.
        const double tangent = R / std::sqrt(D * D - R * R);
        const double h = -x / (5.0 * tangent);
        const double seen = 1.0 - segment_area(1.0, h) / kPi;
        EXPECT_NEAR(blockers.share({x, 0, 0}, {x, 0, D}, R), seen, 1e-9) << x;
    }
}

TEST(ConeTracing, LightInFrontOfABlockerIsNotBlocked) {
    SceneMaker maker;
    maker.add(upright(-9, 9, 5.0), maker.material(glowing({1, 1, 1})));
    Blockers blockers(maker);
    EXPECT_EQ(blockers.share({0, 0, 0}, {0, 0, 4.9}, 0.1), 1.0);
    EXPECT_NEAR(blockers.share({0, 0, 0}, {0, 0, 5.1}, 0.1), 0.0, 1e-12);
}

TEST(ConeTree, HoldsBoxesThatAreHardlyApart) {
    for (const double apart : {0.0, 1e-320, 1e-310, 1e-300, 1.0}) {
        std::vector<Box3> boxes;
        for (int i = 0; i < 9; ++i) boxes.push_back({{i * apart, 0, 0}, {i * apart, 0, 0}});
        const ConeTree tree(boxes);
        std::vector<bool> found(boxes.size(), false);
        std::vector<std::uint32_t> open{0};
        while (!open.empty()) {
            const ConeTree::Node& node = tree.node(open.back());
            open.pop_back();
            for (std::uint32_t k = 0; k < node.count; ++k) found[tree.item(node.first + k)] = true;
            if (node.count == 0) open.insert(open.end(), {node.first, node.first + 1});
        }
        EXPECT_EQ(std::count(found.begin(), found.end(), true), 9) << apart;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
