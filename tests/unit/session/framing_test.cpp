#include "alhazen/session/framing.h"

#include <gtest/gtest.h>

#include <numbers>

#include "alhazen/base/error.h"
#include "support/scene_maker.h"

namespace alhazen {
namespace {

using testing::SceneMaker;

/// Position of a point in the image: both coordinates in [0, 1] when inside.
Vec2 film_place(const PerspectiveCamera& c, const Vec3& point) {
    const Vec3 d = point - c.eye;
    const double ahead = dot(d, c.look);
    const double width = length(c.right);
    const double height = length(c.up);
    return {0.5 + dot(d, c.right) / (ahead * width * width),
            0.5 + dot(d, c.up) / (ahead * height * height)};
}

/// Smallest distances of the box from the four sides of the image.
struct Gaps {
    double left = 1, right = 1, bottom = 1, top = 1;
};
Gaps gaps(const PerspectiveCamera& camera, const Box3& box) {
    Gaps g;
    for (int i = 0; i < 8; ++i) {
        EXPECT_GT(dot(box.corner(i) - camera.eye, camera.look), 0.0) << "behind the eye";
        const Vec2 p = film_place(camera, box.corner(i));
        g.left = std::min(g.left, p.x);
        g.right = std::min(g.right, 1 - p.x);
        g.bottom = std::min(g.bottom, p.y);
        g.top = std::min(g.top, 1 - p.y);
    }
    return g;
}

TEST(Framing, TheBoxFillsThePictureButForItsMargins) {
    const Box3 boxes[] = {{{-1, -1, -1}, {1, 1, 1}},
                          {{0, 0, 0}, {10, 1, 0.5}},
                          {{5, 5, 5}, {5.1, 9, 6}},
                          {{-1e30, -2e30, -1e30}, {1e30, 2e30, 3e30}},
                          {{1e-30, 0, 0}, {2e-30, 1e-30, 1e-30}},
                          {{1000, 1000, 1000}, {1000.001, 1000.001, 1000.001}}};
    for (const Box3& box : boxes) {
        for (const double aspect : {0.5, 1.0, 2.5}) {
            for (const ViewAngles view :
                 {ViewAngles{30, 20}, ViewAngles{-130, 75}, ViewAngles{0, 0}, ViewAngles{45, 90}}) {
                for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
                    const PerspectiveCamera camera = framing_camera(box, up, view, aspect);
                    const Gaps g = gaps(camera, box);
                    // Centred in both directions, and touching the margin in at least one.
                    EXPECT_NEAR(g.left, g.right, 1e-6);
                    EXPECT_NEAR(g.bottom, g.top, 1e-6);
                    EXPECT_NEAR(std::min(g.left, g.bottom), 0.05, 1e-6);
                    EXPECT_NEAR(length(camera.right) / length(camera.up), aspect, 1e-9);
                }
            }
        }
    }
}

TEST(Framing, TheConventionsOfAzimuthAndElevationHold) {
    const Box3 box{{-1, -1, -1}, {1, 1, 1}};
    const auto look = [&](UpAxis up, double azimuth, double elevation) {
        return framing_camera(box, up, {azimuth, elevation}, 1).look;
    };
    EXPECT_EQ(look(UpAxis::Z, 0, 0), (Vec3{-1, 0, 0}));
    EXPECT_EQ(look(UpAxis::Z, 90, 0), (Vec3{0, -1, 0}));
    EXPECT_EQ(look(UpAxis::Z, 0, 90), (Vec3{0, 0, -1}));
    EXPECT_EQ(look(UpAxis::Y, 0, 0), (Vec3{0, 0, -1}));
    EXPECT_EQ(look(UpAxis::Y, 90, 0), (Vec3{-1, 0, 0}));
    EXPECT_EQ(look(UpAxis::Y, -270, -90), (Vec3{0, 1, 0}));
    // At the front of a Y-up file, right is +X.
    const PerspectiveCamera front = framing_camera(box, UpAxis::Y, {0, 0}, 1);
    EXPECT_GT(front.right.x, 0.0);
    EXPECT_GT(front.up.y, 0.0);
    const PerspectiveCamera solid = framing_camera(box, UpAxis::Z, {0, 0}, 1);
    EXPECT_GT(solid.right.y, 0.0);
    EXPECT_GT(solid.up.z, 0.0);
}

TEST(Framing, FlatThingsAreSeenFromTheFront) {
    EXPECT_EQ(default_view({{0, 0, 0}, {4, 4, 0.9}}, UpAxis::Y).azimuth_deg, 0);
    EXPECT_EQ(default_view({{0, 0, 0}, {4, 4, 1.1}}, UpAxis::Y).azimuth_deg, 30);
    EXPECT_EQ(default_view({{0, 0, 0}, {0.9, 4, 4}}, UpAxis::Z).elevation_deg, 0);
    EXPECT_EQ(default_view({{0, 0, 0}, {4, 4, 0.9}}, UpAxis::Z).elevation_deg, 20);
}

TEST(Framing, AnglesAreReadStrictly) {
    EXPECT_EQ(parse_view("12.5,-30").azimuth_deg, 12.5);
    EXPECT_EQ(parse_view("12.5,-30").elevation_deg, -30);
    for (const char* text :
         {"", "1", "1,", ",2", "1,91", "1,-91", "nan,0", "0,nan", "inf,0", "1,2,3", "1;2", "a,b"}) {
        EXPECT_THROW((void)parse_view(text), Error) << text;
    }
}

SceneMaker sphere_without_view() {
    SceneMaker maker;
    maker.description().cameras.clear();
    maker.add(Sphere{});
    return maker;
}

TEST(Framing, AFileWithoutCameraAndLightsGetsBothAndSaysSo) {
    SceneMaker maker = sphere_without_view();
    Scene scene = maker.compile();
    const auto notes = complete_view(maker.description(), scene, {});
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_NE(notes[0].find("azimuth 30, elevation 20"), std::string::npos) << notes[0];
    EXPECT_NE(notes[1].find("headlight"), std::string::npos);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(maker.description().cameras.size(), 1u);
    ASSERT_EQ(scene.lights.size(), 1u);
    const auto& eye = std::get<PerspectiveCamera>(scene.cameras[0].camera).eye;
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, eye);
    EXPECT_EQ(scene.background, (Rgb{0.3, 0.3, 0.3}));
    EXPECT_TRUE(complete_view(maker.description(), scene, {}).empty()) << "nothing is left to add";
}

TEST(Framing, WhatTheFileHasIsKept) {
    SceneMaker maker;
    maker.add(Sphere{});
    maker.light(AmbientLight{{0.1, 0.1, 0.1}});
    Scene scene = maker.compile();
    EXPECT_TRUE(complete_view(maker.description(), scene, {}).empty());
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.background, Rgb{});
}

TEST(Framing, ScenesThatAreMeantToBeDarkStayDark) {
    SceneMaker maker = sphere_without_view();
    maker.description().conventions.importing.headlight = false;
    Scene scene = maker.compile();
    EXPECT_EQ(complete_view(maker.description(), scene, {}).size(), 1u);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.background, Rgb{});
}

TEST(Framing, TheHeadlightKeepsABackgroundThatTheFileGives) {
    SceneMaker maker = sphere_without_view();
    maker.description().picture.background = Rgb{0.1, 0.2, 0.3};
    Scene scene = maker.compile();
    (void)complete_view(maker.description(), scene, {});
    EXPECT_EQ(scene.background, (Rgb{0.1, 0.2, 0.3}));
}

TEST(Framing, AViewThatIsAskedForComesBeforeTheCamerasOfTheFile) {
    SceneMaker maker;
    maker.add(Sphere{});
    maker.light(AmbientLight{{1, 1, 1}});
    Scene scene = maker.compile();
    EXPECT_TRUE(complete_view(maker.description(), scene, {.view = ViewAngles{0, 90}}).empty());
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(std::get<PerspectiveCamera>(find_camera(scene, "").camera).look, (Vec3{0, -1, 0}));
}

TEST(Framing, PlanesAreLeftOutOfTheBoxAlsoInsideInstances) {
    SceneMaker maker = sphere_without_view();
    maker.add(Plane{});
    const ObjectIndex both = maker.object("both");
    maker.add(Sphere{}, MaterialId{0}, {}, both);
    maker.add(Plane{}, MaterialId{0}, {}, both);
    maker.add(both, MaterialId{0}, Affine::translate({10, 0, 0}));
    maker.add(both, MaterialId{0}, Affine::translate({-10, 0, 0}));
    const Scene scene = maker.compile();
    EXPECT_FALSE(scene.aggregate->box().bounded());
    const Box3 box = bounded_part(*scene.aggregate);
    EXPECT_NEAR(box.lo.x, -11, 1e-9);
    EXPECT_NEAR(box.hi.x, 11, 1e-9);
    EXPECT_NEAR(box.hi.y, 1, 1e-9);
}

TEST(Framing, NothingToFrameIsAnError) {
    SceneMaker empty;
    empty.description().cameras.clear();
    Scene nothing = empty.compile();
    EXPECT_THROW((void)complete_view(empty.description(), nothing, {}), Error);
    SceneMaker endless;
    endless.description().cameras.clear();
    endless.add(Plane{});
    Scene plane = endless.compile();
    EXPECT_THROW((void)complete_view(endless.description(), plane, {}), Error);
}

TEST(Framing, PointsAndFlatBoxesAreSeenFromOutside) {
    for (const Box3& box : {Box3{{3, 3, 3}, {3, 3, 3}}, Box3{{0, 0, 0}, {0, 0, 0}},
                            Box3{{0, 0, 0}, {1, 0, 0}}, Box3{{0, 0, 0}, {0, 0, 1}}}) {
        const PerspectiveCamera camera = framing_camera(box, UpAxis::Y, {0, 0}, 1.5);
        EXPECT_TRUE(is_finite(camera.eye));
        for (int i = 0; i < 8; ++i) {
            EXPECT_GT(dot(box.corner(i) - camera.eye, camera.look), 0.0);
        }
    }
}

}  // namespace
}  // namespace alhazen
