#include "alhazen/session/framing/framing.h"

#include <gtest/gtest.h>

#include <numbers>

#include "alhazen/base/error.h"
#include "alhazen/session/framing/seen_parts.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
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

TEST(Framing, AModelWithLightsOfItsOwnGetsDimSurroundings) {
    SceneMaker maker;
    maker.add(Sphere{});
    maker.light(PointLight{.position = {0, 5, 0}});
    maker.description().conventions.importing.surroundings = true;
    Scene scene = maker.compile();
    const auto notes = complete_view(maker.description(), scene, {});
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("surroundings"), std::string::npos) << notes[0];
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(ambient_of(scene.lights[1]), scene.background);
    EXPECT_GT(scene.background.r, 0.0);
    EXPECT_LT(scene.background.r, 0.3);
    EXPECT_EQ(maker.description().lights.size(), 2u);

    SceneMaker own;
    own.add(Sphere{});
    own.light(PointLight{.position = {0, 5, 0}});
    own.description().conventions.importing.surroundings = true;
    own.description().picture.background = Rgb{0, 0, 0.5};
    Scene with_background = own.compile();
    EXPECT_TRUE(complete_view(own.description(), with_background, {}).empty());
    EXPECT_EQ(with_background.lights.size(), 1u);
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
    const Box3 box = SeenParts(*scene.aggregate).box();
    EXPECT_NEAR(box.lo.x, -11, 1e-9);
    EXPECT_NEAR(box.hi.x, 11, 1e-9);
    EXPECT_NEAR(box.hi.y, 1, 1e-9);
}

/// A patch of degree (2, 1), narrow where it is long: u goes along z = 2 u (1 - u) up to `length`.
BezierPatch narrow_patch(double length) {
    return {.degree_u = 2,
            .degree_v = 1,
            .points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {length, 0, 0}, {2, 1, 0}}};
}

TEST(SeenParts, PatchesReachAsFarAsTheirSurface) {
    for (const double length : {2.0, 1e5}) {
        SceneMaker maker;
        maker.add(narrow_patch(length));
        maker.add(narrow_patch(length), MaterialId{0}, Affine::translate({0, 0, 10}));
        const Scene scene = maker.compile();
        const SeenParts parts(*scene.aggregate);
        const auto reach = [&](const Vec3& direction) {
            const auto point = parts.farthest(direction, -1e300);
            return point ? dot(direction, *point) : -kInfinity;
        };
        EXPECT_EQ(reach({1, 0, 0}), length);
        EXPECT_EQ(reach({-1, 0, 0}), 0);
        EXPECT_EQ(reach({0, 1, 0}), 1);
        // The control points are at z = 11, the surface up to 2 u (1 - u) = 1/2 above 10.
        EXPECT_NEAR(reach({0, 0, 1}), 10.5, 1e-6);
        EXPECT_EQ(reach({0, 0, -1}), 0);
        EXPECT_FALSE(parts.farthest({0, 0, 1}, 10.500001));
    }
}

/// Gaps between what eye rays see and the sides of the picture, in shares of its width and height.
Gaps seen_gaps(const Scene& scene, double aspect) {
    constexpr int kHeight = 250;
    const int width = static_cast<int>(kHeight * aspect);
    const Camera& camera = scene.cameras[0].camera;
    Gaps g;
    for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < width; ++i) {
            const double x = (i + 0.5) / width, y = (j + 0.5) / kHeight;
            if (!scene.aggregate->occluded(eye_ray(camera, x, y),
                                           {nullptr, mask_of(RayKind::Eye)})) {
                continue;
            }
            g.left = std::min(g.left, x);
            g.right = std::min(g.right, 1 - x);
            g.bottom = std::min(g.bottom, y);
            g.top = std::min(g.top, 1 - y);
        }
    }
    return g;
}

/// Frames from three sides in two shapes of picture.
void expect_centred(SceneMaker& maker, const std::string& what) {
    Scene scene = maker.compile("wide_bvh");
    for (const double aspect : {0.6, 1.5}) {
        for (const ViewAngles view : {ViewAngles{30, 20}, ViewAngles{0, 0}, ViewAngles{-100, 70}}) {
            scene.cameras.clear();
            SceneDescription description = maker.description();
            (void)complete_view(description, scene, {.view = view, .aspect = aspect});
            const Gaps g = seen_gaps(scene, aspect);
            const std::string where = what + " from " + std::to_string(view.azimuth_deg) +
                                      ", aspect " + std::to_string(aspect);
            constexpr double kPixels = 0.009;
            EXPECT_NEAR(g.left, g.right, kPixels) << where;
            EXPECT_NEAR(g.bottom, g.top, kPixels) << where;
            EXPECT_NEAR(std::min(g.left, g.bottom), 0.05, kPixels) << where;
        }
    }
}

/// A ball; one vertex, far outside, is in no triangle.
TriangleMesh ball(int rows) {
    TriangleMesh mesh;
    const int columns = 2 * rows;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const double a = 2 * std::numbers::pi * i / columns, b = std::numbers::pi * j / rows;
            mesh.positions.push_back(
                {std::cos(a) * std::sin(b), std::cos(b), std::sin(a) * std::sin(b)});
        }
    }
    const auto vertex = [&](int i, int j) {
        return static_cast<std::uint32_t>(j * columns + i % columns);
    };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    mesh.positions.push_back({50, 60, 70});
    return mesh;
}

TEST(Framing, ASphereIsCentredNotItsBox) {
    SceneMaker maker = sphere_without_view();
    expect_centred(maker, "sphere");
}

TEST(Framing, TheVerticesOfMeshesAreCentred) {
    SceneMaker maker;
    maker.add(maker.mesh(ball(40)), MaterialId{0}, Affine::translate({3, 4, 5}));
    expect_centred(maker, "ball");
}

TEST(Framing, WhatInstancesPlaceIsCentred) {
    SceneMaker maker;
    const ObjectIndex object = maker.object("object");
    maker.add(maker.mesh(ball(20)), MaterialId{0}, {}, object);
    maker.add(Torus{}, MaterialId{0}, Affine::translate({0, 1.5, 0}), object);
    maker.add(
        object, MaterialId{0},
        Affine::translate({3, 0, 0}) * Affine::rotate({1, 1, 0}, 0.7) * Affine::scale({1, 2, 0.5}));
    maker.add(object, MaterialId{0}, Affine::rotate({0, 1, 1}, 2.0));
    expect_centred(maker, "instances");
}

TEST(Framing, SolidsWithoutTightBoundsAreCentred) {
    const auto lens = [] {
        SceneMaker maker;
        const ObjectIndex solid = maker.object("lens");
        maker.description().objects[1].combine = Combine::Intersection;
        maker.add(Sphere{{0, 0, 0}, 1}, MaterialId{0}, {}, solid);
        maker.add(Sphere{{1, 0.5, 0}, 1}, MaterialId{0}, {}, solid);
        maker.add(solid);
        return maker;
    }();
    SceneMaker maker = lens;
    expect_centred(maker, "lens");
    SceneMaker blobs;
    Blob blob;
    blob.threshold = 0.4;
    blob.components = {{.base = {0, 0, 0}, .radius = 1, .strength = 1},
                       {.base = {0.8, 0.6, 0}, .radius = 0.8, .strength = 1}};
    blobs.add(blob);
    expect_centred(blobs, "blob");
    SceneMaker cushions;
    cushions.add(Superellipsoid{}, MaterialId{0}, Affine::rotate({1, 2, 3}, 0.5));
    expect_centred(cushions, "superellipsoid");
}

TEST(Framing, PartsThatNoEyeRaySeesAreLeftOut) {
    SceneMaker maker = sphere_without_view();
    maker.add(Sphere{{9, 0, 0}, 1});
    maker.description().objects[0].parts.back().visible_to = mask_of(RayKind::Shadow);
    expect_centred(maker, "half seen");
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
}  // namespace alhazen::ALHAZEN_TEST_FILE
