#include "alhazen/solids/section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "support/box_mesh.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::add_box;
using testing::SceneMaker;

/// Outlines of the only solid of a scene.
template <class S>
SectionOutlines outlines_of(const S& shape, const SectionPlane& plane,
                            const OutlineOptions& options) {
    SceneMaker maker;
    maker.add(shape);
    const SolidList solids(maker.compile().aggregate);
    return trace_section(IsolatedSolid(solids, SolidId{0}), frame_of(plane), options);
}

TEST(Section, AClosedMeshThatNoRaySeesIsCutAndMeasuredAlone) {
    for (const bool alone : {true, false}) {
        PrimitiveTable table;
        auto mesh = std::make_shared<TriangleMesh>();
        mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
        PlacedMesh placed;
        placed.mesh = mesh;
        placed.visible_to = 0;
        table.meshes.push_back(placed);
        if (!alone) table.meshes.push_back(placed);
        table.material_opacity = {Opacity::Opaque};
        table.finish();
        const SolidList solids(make_aggregate("wide_bvh", std::move(table), {}));
        ASSERT_EQ(solids.count(), alone ? 1u : 2u);
        const SectionOutlines found = trace_section(IsolatedSolid(solids, SolidId{0}),
                                                    frame_of({{0, 0, 1}, 0.5}), {.cells = 64});
        EXPECT_NEAR(found.area(), 0.125, 1e-6) << alone;
    }
}

TEST(Section, TheOutlineOfASphereStaysWithinTheToleranceOfItsCircle) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
        const SectionOutlines found = outlines_of(Sphere{{1, 2, 3}, 2}, {{0, 0, 1}, 4},
                                                  {.cells = 32, .tolerance = tolerance});
        ASSERT_EQ(found.loops.size(), 1u);
        EXPECT_EQ(found.unresolved, 0u);
        const double radius = std::sqrt(3.0);
        const Polyline& loop = found.loops[0];
        double farthest = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 next = loop[(i + 1) % loop.size()];
            const Vec2 middle = 0.5 * (loop[i] + next);
            farthest = std::max(farthest, radius - std::hypot(middle.x - 1, middle.y - 2));
            farthest =
                std::max(farthest, std::abs(std::hypot(loop[i].x - 1, loop[i].y - 2) - radius));
        }
        EXPECT_LE(farthest, tolerance);
        EXPECT_NEAR(found.area(), 3 * std::numbers::pi, 2 * std::numbers::pi * radius * tolerance);
        // At most a small factor more points than the tolerance needs.
        EXPECT_LT(static_cast<double>(loop.size()),
                  40 + 8 * std::numbers::pi * std::sqrt(radius / tolerance));
    }
}

TEST(Section, ThePlaneIsThatOfItsNormalOfAnyLength) {
    for (const double size : {1e-300, 1e-200, 3.0, 1e160, 1e300}) {
        const PlaneFrame frame = frame_of({{0, 0.6 * size, -0.8 * size}, 2 * size});
        EXPECT_NEAR(length(frame.normal - Vec3{0, 0.6, -0.8}), 0, 1e-15) << size;
        EXPECT_NEAR(length(frame.origin - Vec3{0, 1.2, -1.6}), 0, 1e-15) << size;
    }
    EXPECT_THROW((void)frame_of({{0, 0, 0}, 1}), Error);
    EXPECT_THROW((void)frame_of({{0, 0, 1e-320}, 0.5}), Error);
    EXPECT_THROW((void)frame_of({{0, 0, std::numeric_limits<double>::infinity()}, 1}), Error);
}

TEST(Section, CornersOfABoxAreFoundWithinTheTolerance) {
    const SectionOutlines found = outlines_of(BoxShape{{0, 0, 0}, {3, 2, 1}}, {{0, 0, 1}, 0.5},
                                              {.cells = 16, .tolerance = 1e-5});
    ASSERT_EQ(found.loops.size(), 1u);
    EXPECT_NEAR(found.area(), 6, 1e-4);
    EXPECT_LE(found.loops[0].size(), 60u);
    for (const Vec2 corner : {Vec2{0, 0}, {3, 0}, {3, 2}, {0, 2}}) {
        double nearest = 9;
        for (const Vec2& p : found.loops[0]) {
            nearest = std::min(nearest, std::hypot(p.x - corner.x, p.y - corner.y));
        }
        EXPECT_LE(nearest, 3e-5) << corner.x << " " << corner.y;
    }
}

TEST(Section, HolesRunTheOtherWayRound) {
    // A tube of square section as a mesh: two boxes, the inner one reversed.
    TriangleMesh tube;
    add_box(tube, {{-2, -2, -2}, {2, 2, 2}});
    add_box(tube, {{-1, -1, -1}, {1, 1, 1}}, true);
    SceneMaker maker;
    maker.add(maker.mesh(tube));
    const SolidList solids(maker.compile("wide_bvh").aggregate);
    const SectionOutlines found =
        trace_section(IsolatedSolid(solids, SolidId{0}), frame_of({{1, 0, 0}, 0.25}), {});
    ASSERT_EQ(found.loops.size(), 2u);
    EXPECT_NEAR(found.area(), 16 - 4, 1e-2);
    SectionOutlines hole;
    hole.loops = {found.loops[0].front().x < -1.5 || found.loops[0].front().y < -1.5
                      ? found.loops[1]
                      : found.loops[0]};
    EXPECT_LT(std::min(hole.area(), SectionOutlines{{found.loops[0]}, 0}.area()), 0);
}

TEST(Section, ThePictureShowsTheCutInTheColourOfTheSolidAndWhatLiesBehind) {
    SceneMaker maker;
    Material red, green;
    red.diffuse.color = {1, 0, 0};
    green.diffuse.color = {0, 1, 0};
    const MaterialId red_id = maker.material(red), green_id = maker.material(green);
    maker.add(Sphere{{0, 0, 0}, 1}, red_id);
    maker.add(BoxShape{{2, -1, -3}, {4, 1, -1}}, green_id);
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    const Image image =
        section_picture(solids, scene, {{0, 0, 1}, 0}, {.width = 120, .height = 60});
    // The window spans x from -1 to 4 plus a margin and is centred there; y from -1 to 1.
    const double per_unit = 120 / (1.06 * 5);
    const auto at = [&](double x, double y) {
        return image.rgb(static_cast<int>(60 + per_unit * (x - 1.5)),
                         static_cast<int>(30 - per_unit * y));
    };
    EXPECT_EQ(at(0, 0).r, 1);
    EXPECT_EQ(at(0.5, -0.5).g, 0);
    EXPECT_EQ(at(1.5, 0).b, 1);  // background
    EXPECT_NEAR(at(3, 0).g, 0.5, 0.01);
    EXPECT_EQ(at(3, 0).r, 0);
    bool inked = false;
    for (int x = 0; x < 120; ++x) inked = inked || image.rgb(x, 30).r < 0.7f;
    EXPECT_TRUE(inked);
    const Image above = section_picture(solids, scene, {{0, 0, -1}, 5}, {.width = 12, .height = 6});
    EXPECT_EQ(above.rgb(6, 3).b, 1);
}

TEST(Section, PicturesOfNoOrTooManyPixelsAreRefused) {
    SceneMaker maker;
    maker.add(Sphere{});
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    for (const auto& [width, height] :
         {std::pair{0, 5}, std::pair{5, -1}, std::pair{1 << 30, 1 << 30}}) {
        EXPECT_THROW((void)section_picture(solids, scene, {{0, 0, 1}, 0},
                                           {.width = width, .height = height}),
                     Error)
            << width;
    }
}

TEST(Section, MediaHaveTheirColoursAndTheWallBetweenThemIsNoOutline) {
    SceneMaker maker;
    Material glass, water;
    glass.transmissive.color = {1, 0.5, 0.5};
    water.transmissive.color = {0.25, 0.5, 1};
    const MaterialId glass_id = maker.material(glass), water_id = maker.material(water);
    const ObjectIndex tank = maker.object("tank");
    maker.description().objects.back().combine = Combine::Union;
    maker.add(BoxShape{{-2, -1, -1}, {0, 1, 1}}, glass_id, {}, tank);
    maker.add(BoxShape{{-0.5, -1, -1}, {2, 1, 1}}, water_id, {}, tank);
    maker.add(tank);
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    const Image image =
        section_picture(solids, scene, {{0, 0, 1}, 0.3}, {.width = 100, .height = 60});
    EXPECT_NEAR(image.rgb(40, 30).r, 0.8, 1e-6);
    EXPECT_NEAR(image.rgb(40, 30).b, 0.4, 1e-6);
    EXPECT_NEAR(image.rgb(60, 30).r, 0.2, 1e-6);
    EXPECT_NEAR(image.rgb(60, 30).b, 0.8, 1e-6);
    const IsolatedSolid alone(solids.solids(), SolidId{0});
    const SectionOutlines found = trace_section(alone, frame_of({{0, 0, 1}, 0.3}), {});
    EXPECT_EQ(found.unresolved, 0u);
    ASSERT_EQ(found.loops.size(), 1u);
    EXPECT_NEAR(found.area(), 8, 1e-2);
    LineSpans line;
    alone.cross({{-5, 0.1, 0.2}, {1, 0, 0}}, true, line);
    ASSERT_EQ(line.spans.size(), 1u);
    EXPECT_EQ(line.spans[0].lo, 3);
    EXPECT_EQ(line.spans[0].hi, 7);
    EXPECT_EQ(line.cosines, 2);
}

TEST(Section, AToleranceThatIsNoNumberIsRefused) {
    SceneMaker maker;
    maker.add(Sphere{});
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid ball(solids, SolidId{0});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double tolerance : {nan, 0.0, -1.0}) {
        EXPECT_THROW((void)trace_section(ball, frame_of({{0, 0, 1}, 0}), {.tolerance = tolerance}),
                     Error);
    }
}

TEST(Section, TheSvgHasTheUnitsOfTheSceneAndALayerForEachSolid) {
    SectionLayer layer{SolidId{7}, "a<b>\"&", {1, 0, 0}, {}};
    layer.outlines.loops = {{{0, 0}, {10, 0}, {10, 5}}};
    const std::string svg = section_svg({layer}, frame_of({{0, 0, 1}, 2}), {.unit = "cm"});
    EXPECT_NE(svg.find("width=\"10.4cm\" height=\"5.4cm\" viewBox=\"-0.2 -5.2 10.4 5.4\""),
              std::string::npos)
        << svg;
    EXPECT_NE(svg.find("<g id=\"solid-7\""), std::string::npos);
    EXPECT_NE(svg.find("inkscape:label=\"a&lt;b&gt;&quot;&amp;\""), std::string::npos);
    EXPECT_NE(svg.find("d=\"M0 0L10 0L10 -5Z\""), std::string::npos) << svg;
    EXPECT_THROW((void)section_svg({}, frame_of({{0, 0, 1}, 2}), {.unit = "furlong"}), Error);
}

TEST(Section, AToleranceBelowTheRoundingOfCrossingsIsRefused) {
    SceneMaker maker;
    maker.add(Sphere{{0, 0, 0}, 3});
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid ball(solids, SolidId{0});
    const double least = least_tolerance(ball.box());
    EXPECT_GT(least, 1e-8);
    EXPECT_LT(least, 1.1e-8);
    const PlaneFrame frame = frame_of({{0, 0, 1}, 0});
    EXPECT_THROW((void)trace_section(ball, frame, {.tolerance = 0.5 * least}), Error);
    EXPECT_NEAR(trace_section(ball, frame, {.tolerance = 1e-5}).area(), 9 * 3.14159265358979, 1e-3);
}

TEST(Section, TheSvgOfNothingShowsWhereItWouldHaveBeen) {
    SvgOptions options;
    options.around = {{1, 2, 3}, {11, 7, 4}};
    const PlaneFrame frame = frame_of({{0, 0, 1}, 20});
    const std::string svg = section_svg({}, frame, options);
    EXPECT_NE(svg.find("width=\"10.4mm\" height=\"5.4mm\""), std::string::npos) << svg;
    const std::string unknown = section_svg({}, frame, {});
    EXPECT_NE(unknown.find("width=\"1.04mm\" height=\"1.04mm\""), std::string::npos) << unknown;
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
