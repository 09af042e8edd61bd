#include "alhazen/laboratory/traversal_figure.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/base/error.h"
#include "alhazen/geometry/polygon/convex_outline.h"
#include "alhazen/laboratory/html_text.h"
#include "alhazen/laboratory/plane_corners.h"
#include "alhazen/laboratory/scene_trial.h"
#include "unit/laboratory/small_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::small_scene;
using Kind = TraversalStep::Kind;

std::uint64_t count(const TraversalTrace& trace, Kind kind) {
    return static_cast<std::uint64_t>(
        std::count_if(trace.steps.begin(), trace.steps.end(),
                      [&](const TraversalStep& step) { return step.kind == kind; }));
}

TEST(TraversalTrace, HasTheStepsThatTheAggregateCountsAndItsHit) {
    const SceneTrial trial(small_scene(), {.max_depth = 0});
    for (const std::string name :
         {"list", "hierarchy", "hierarchy:bound=sphere,order=stored", "goldsmith_salmon",
          "kay_kajiya", "uniform_grid", "octree", "kd_tree", "ray_classification"}) {
        const Scene scene = trial.build(name).scene;
        for (int x = 0; x < 40; x += 7) {
            const Ray ray = trial.eye_ray_of(x, 15);
            const TraversalTrace trace = trace_traversal(scene, name, ray);
            TraversalStats stats;
            Hit hit;
            (void)scene.aggregate->closest(ray, hit, {&stats});
            EXPECT_EQ(trace.hit.t, hit.t) << name << x;
            EXPECT_EQ(trace.hit.primitive, hit.primitive) << name << x;
            EXPECT_EQ(count(trace, Kind::Primitive), stats.primitive_tests) << name << x;
            EXPECT_EQ(count(trace, Kind::Bound), stats.box_tests) << name << x;
            if (name == "uniform_grid") {
                EXPECT_EQ(count(trace, Kind::Cell), stats.node_visits) << x;
            }
        }
    }
}

TEST(TraversalTrace, TheRayGoesThroughEveryCell) {
    const SceneTrial trial(small_scene(), {.max_depth = 0});
    const Ray ray = trial.eye_ray_of(17, 12);
    for (const char* name : {"uniform_grid", "octree", "kd_tree"}) {
        for (const TraversalStep& step : trace_traversal(trial.reference(), name, ray).steps) {
            if (step.kind != Kind::Cell) continue;
            Box3 box;
            for (const Vec3& corner : step.corners) box.include(corner);
            double enter = 0, leave = 1e300;
            for (int k = 0; k < 3; ++k) {
                const double a = (box.lo[k] - ray.origin[k]) / ray.direction[k];
                const double b = (box.hi[k] - ray.origin[k]) / ray.direction[k];
                enter = std::max(enter, std::min(a, b));
                leave = std::min(leave, std::max(a, b));
            }
            EXPECT_LE(enter, leave + 1e-9) << name << " cell " << step.number;
        }
    }
}

TEST(TraversalTrace, RefusesWhatItCannotTrace) {
    const SceneTrial trial(small_scene(3), {.max_depth = 0});
    EXPECT_THROW((void)trace_traversal(trial.reference(), "light_buffer", trial.eye_ray_of(0, 0)),
                 Error);
    EXPECT_THROW((void)trace_traversal(trial.reference(), "octree:walk=x", trial.eye_ray_of(0, 0)),
                 Error);
    EXPECT_THROW((void)trial.eye_ray_of(40, 0), Error);
}

TEST(TraversalFigure, DrawsEveryStep) {
    const SceneTrial trial(small_scene(), {.max_depth = 0});
    const TraversalTrace trace =
        trace_traversal(trial.reference(), "uniform_grid", trial.eye_ray_of(20, 15));
    for (const char* view : {"x", "y", "z", "isometric"}) {
        const std::string svg = traversal_svg(trial.reference(), trace, parse_figure_view(view));
        std::uint64_t cells = 0;
        for (std::size_t at = 0;
             (at = svg.find("<polygon class=\"cell\"", at)) != std::string::npos; ++at) {
            ++cells;
        }
        EXPECT_EQ(cells, count(trace, Kind::Cell)) << view;
        // Search behind the style, whose "dominant" contains the letters.
        EXPECT_EQ(svg.find("nan", svg.find("</style>")), std::string::npos) << view;
        EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
    }
    EXPECT_THROW((void)parse_figure_view("w"), Error);
}

TEST(ConvexCorners, ACubeHasEightAndACutOneTen) {
    std::vector<HalfSpaceOfPoints> sides;
    for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        sides.push_back({n, 1});
        sides.push_back({-n, 1});
    }
    EXPECT_EQ(plane_corners(sides).size(), 8u);
    sides.push_back({Vec3{1, 1, 1}, 2});  // cuts one corner off
    EXPECT_EQ(plane_corners(sides).size(), 10u);
    std::vector<Vec2> points;
    for (const Vec3& p : plane_corners(sides)) points.push_back({p.x, p.y});
    EXPECT_EQ(convex_outline(points).size(), 4u);
}

TEST(HtmlText, IsSafeAndBase64IsThatOfTheStandard) {
    EXPECT_EQ(html_escaped("<b a=\"1\">&\n"), "&lt;b a=&quot;1&quot;&gt;&amp; ");
    EXPECT_EQ(html_escaped("a\xff\u00e9"), "a\\xff\u00e9");
    const auto encoded = [](std::string_view text) {
        return base64(std::as_bytes(std::span(text.data(), text.size())));
    };
    EXPECT_EQ(encoded(""), "");
    EXPECT_EQ(encoded("f"), "Zg==");
    EXPECT_EQ(encoded("fo"), "Zm8=");
    EXPECT_EQ(encoded("foo"), "Zm9v");
    EXPECT_EQ(encoded("foob"), "Zm9vYg==");
    EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
