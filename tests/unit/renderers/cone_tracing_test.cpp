#include "alhazen/renderers/cone_tracing/cone_tracing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/geometry/cones/disc_area.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/cone_tracing/cone_scene.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/image_texture.h"
#include "support/odd_even_area.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"
#include "unit/renderers/unit_pixels.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::glowing;
using testing::SceneMaker;
using testing::unit_pixels;
using testing::upright;

/// Of the cone of a pixel of side 1.
const double kRadius = std::sqrt(1 / kPi);

Film picture_of(SceneMaker& maker, const Camera& camera, int width, int height,
                const RenderControl& control = {}, const ConeTracingOptions& options = {}) {
    const Scene scene = maker.compile();
    Film film(width, height, {0, 0, width, height});
    const RenderJob job{
        .scene = scene, .camera = camera, .description = &maker.description(), .control = control};
    EXPECT_TRUE(ConeTracing(options).render(job, film).complete());
    return film;
}

double one_pixel(SceneMaker& maker) {
    return picture_of(maker, unit_pixels(1), 1, 1).at(0, 0).r;
}

TEST(ConeTracing, AnEdgeCoversItsSegmentOfThePixel) {
    for (const double x : {0.0, 0.25, -0.4}) {
        SceneMaker maker;
        maker.add(upright(x, 9), maker.material(glowing({1, 1, 1})));
        EXPECT_NEAR(one_pixel(maker), segment_area(kRadius, x), 1e-12) << x;
    }
}

/// Looks along +y from the origin, 9 x 7 pixels.
Film picture_from_origin(SceneMaker& maker) {
    return picture_of(maker, look_along({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1.0, 9.0 / 7.0), 9, 7);
}

TEST(ConeTracing, APolygonThatCrossesItselfIsFilledOddEven) {
    Polygon bow, pentagram;
    bow.vertices = {{-9, -9, 0}, {9, 9, 0}, {9, -9, 0}, {-9, 9, 0}};
    for (int k = 0; k < 5; ++k) {
        const double turn = 0.8 * kPi * k;
        pentagram.vertices.push_back({9 * std::cos(turn), 9 * std::sin(turn), 0});
    }
    SceneMaker half, hole;
    half.add(bow, half.material(glowing({1, 1, 1})));
    EXPECT_NEAR(one_pixel(half), 0.5, 1e-6);
    hole.add(pentagram, hole.material(glowing({1, 1, 1})));
    EXPECT_NEAR(one_pixel(hole), 0.0, 1e-12);
    // In its mean plane, if its corners are far off it.
    bow.vertices = {{-9, -9, 1}, {9, 9, 1}, {9, -9, -1}, {-9, 9, -1}};
    SceneMaker bent;
    bent.add(bow, bent.material(glowing({1, 1, 1})));
    EXPECT_NEAR(one_pixel(bent), 0.5, 1e-6);
    // A vertex in the crossing, on either diagonal.
    for (const std::vector<Vec3>& loop :
         {std::vector<Vec3>{{0, 0, 0}, {9, 9, 0}, {9, -9, 0}, {0, 0, 0}, {-9, 9, 0}, {-9, -9, 0}},
          std::vector<Vec3>{{-9, -9, 0}, {0, 0, 0}, {9, 9, 0}, {9, -9, 0}, {-9, 9, 0}}}) {
        SceneMaker touching;
        touching.add(Polygon{.vertices = loop}, touching.material(glowing({1, 1, 1})));
        EXPECT_NEAR(one_pixel(touching), 0.5, 1e-6);
    }
}

TEST(ConeTracing, PolygonsThatMeetThemselvesCoverTheirArea) {
    testing::Random random(3);
    for (int round = 0; round < 300; ++round) {
        std::vector<Vec3> loop = testing::random_loop(random);
        const double area = testing::odd_even_area(loop);
        if (!(area > 0.0)) continue;
        // All within the cone of the pixel.
        for (Vec3& p : loop) p = 0.15 * p;
        SceneMaker maker;
        maker.add(Polygon{.vertices = loop}, maker.material(glowing({1, 1, 1})));
        EXPECT_NEAR(one_pixel(maker), 0.0225 * area, 1e-6) << round;
    }
}

TEST(ConeTracing, AnEyeInsideSolidsSeesTheirInnerSides) {
    const std::vector<std::pair<const char*, std::function<void(SceneMaker&, MaterialId)>>> rooms{
        {"box",
         [](auto& m, auto id) {
             m.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, id);
         }},
        {"sphere",
         [](auto& m, auto id) {
             m.add(Sphere{{0, 0, 0}, 2}, id);
         }},
        {"half space",
         [](auto& m, auto id) {
             m.add(HalfSpace{{0, 2, 0}, {0, 1, 0}}, id);
         }},
        {"mesh", [](auto& m, auto id) { m.add(m.mesh(testing::tetrahedron()), id); }},
    };
    for (const auto& [name, add] : rooms) {
        SceneMaker maker;
        add(maker, maker.material(glowing({0.5, 0.5, 0.5})));
        // Another solid around the room is behind it.
        maker.add(Sphere{{0, 0, 0}, 50}, maker.material(glowing({1, 1, 1})));
        const Film film = picture_from_origin(maker);
        for (int y = 0; y < 7; ++y) {
            for (int x = 0; x < 9; ++x)
                EXPECT_NEAR(film.at(x, y).r, 0.5, 1e-12) << name << x << " " << y;
        }
    }
}

TEST(ConeTracing, ASphereCoversItsLens) {
    SceneMaker maker;
    maker.add(Sphere{.center = {0.5, 0, 0}, .radius = 0.4}, maker.material(glowing({1, 1, 1})));
    EXPECT_NEAR(one_pixel(maker), lens_area(kRadius, 0.4, 0.5), 1e-12);
}

TEST(ConeTracing, FacesThatShareAnEdgeLeaveNoSeam) {
    SceneMaker maker;
    const auto white = maker.material(glowing({1, 1, 1}));
    maker.add(upright(-9, 0.125), white);
    maker.add(upright(0.125, 9), white);
    EXPECT_NEAR(one_pixel(maker), 1.0, 1e-12);
}

TEST(ConeTracing, SurfacesOfTheirOwnAreIndependent) {
    SceneMaker maker;
    const auto white = maker.material(glowing({1, 1, 1}));
    maker.add(upright(-9, 0.0, 1.0), white);
    maker.add(upright(0.0, 9), white);
    EXPECT_NEAR(one_pixel(maker), 0.75, 1e-12);
}

TEST(ConeTracing, TrianglesOfAMeshAddUp) {
    TriangleMesh fan;
    fan.positions.push_back({0.05, 0.02, 0});
    constexpr std::uint32_t kCount = 37;
    for (std::uint32_t k = 0; k < kCount; ++k) {
        const double angle = 2 * kPi * k / kCount;
        fan.positions.push_back({9 * std::cos(angle), 9 * std::sin(angle), 0});
        fan.triangles.push_back({0, k + 1, (k + 1) % kCount + 1});
    }
    SceneMaker maker;
    maker.add(maker.mesh(fan), maker.material(glowing({1, 1, 1})));
    EXPECT_NEAR(one_pixel(maker), 1.0, 1e-9);
}

TEST(ConeTracing, TheFrontOfASolidHidesItsBack) {
    SceneMaker maker;
    maker.add(BoxShape{{0.1, -9, -4}, {9, 9, 0}}, maker.material(glowing({1, 1, 1})));
    // Slightly from the side: two faces are seen, four are not.
    OrthographicCamera camera = unit_pixels(1);
    EXPECT_NEAR(picture_of(maker, camera, 1, 1).at(0, 0).r, segment_area(kRadius, 0.1), 1e-12);
    camera.origin = {-30, 0, 100};
    camera.direction = {0.3, 0, -1};
    const double seen = picture_of(maker, camera, 1, 1).at(0, 0).r;
    // The edge at x = 0.1 of the lower face is the first that the parallel rays meet.
    EXPECT_GT(seen, segment_area(kRadius, 0.1));
    EXPECT_LE(seen, 1.0);
}

/// Cubes in one mesh, the second of which is turned inside out where `inward` says so.
TriangleMesh cubes(std::span<const Vec3> centers, double half, const std::vector<bool>& inward) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < centers.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < 8; ++k) {
            const Vec3 corner{k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half};
            mesh.positions.push_back(centers[i] + corner);
        }
        const std::array<std::array<std::uint32_t, 4>, 6> faces{
            {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
        for (const auto& f : faces) {
            for (std::array<std::uint32_t, 3> t :
                 {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
                for (std::uint32_t& corner : t) corner += first;
                if (inward[i]) std::swap(t[1], t[2]);
                mesh.triangles.push_back(t);
            }
        }
    }
    return mesh;
}

/// Their near faces are lit, their far ones in their shadow.
TEST(ConeTracing, EachShellOfAMeshHasItsOwnOutside) {
    const std::vector<Vec3> apart{{0, 0, 0}, {30, 0, 0}, {0, 30, 5}};
    Material white;
    white.diffuse.color = {1, 1, 1};
    for (const double mirror : {1.0, -1.0}) {
        for (int bits = 0; bits < 8; ++bits) {
            SceneMaker maker;
            const std::vector<bool> inward{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
            maker.add(maker.mesh(cubes(apart, 2, inward)), maker.material(white),
                      Affine::scale({mirror, 1, 1}));
            maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
            EXPECT_NEAR(one_pixel(maker), 1, 1e-9) << bits << mirror;
        }
    }
}

/// A smaller cube in a larger one is a cavity, whichever way it faces: the odd-even rule.
TEST(ConeTracing, AShellWithinAnotherIsACavity) {
    for (int bits = 0; bits < 4; ++bits) {
        TriangleMesh mesh = cubes(std::array{Vec3{0, 0, 0}}, 2, {(bits & 1) != 0});
        const TriangleMesh inner = cubes(std::array{Vec3{0, 0, 0}}, 1, {(bits & 2) != 0});
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), inner.positions.begin(), inner.positions.end());
        for (std::array<std::uint32_t, 3> t : inner.triangles) {
            for (std::uint32_t& corner : t) corner += first;
            mesh.triangles.push_back(t);
        }
        SceneMaker maker;
        maker.add(maker.mesh(mesh), maker.material(glowing({1, 1, 1})));
        const Scene scene = maker.compile();
        const ConeScene cones = cone_scene(maker.description(), scene);
        ASSERT_EQ(cones.sources.size(), 1u);
        EXPECT_EQ(cones.sources[0].is_inward(0), (bits & 1) != 0) << bits;
        EXPECT_EQ(cones.sources[0].is_inward(12), (bits & 2) == 0) << bits;
    }
}

TEST(ConeTracing, MoreCoverMeansFartherThingsShowLess) {
    SceneMaker maker;
    maker.add(upright(0.0, 9, 2.0), maker.material(glowing({1, 0, 0})));
    maker.add(upright(-9, 9, 1.0), maker.material(glowing({0, 1, 0})));
    maker.add(upright(-9, 9, 0.0), maker.material(glowing({0, 0, 1})));
    const Rgb c = picture_of(maker, unit_pixels(1), 1, 1).at(0, 0);
    EXPECT_NEAR(c.r, 0.5, 1e-12);
    EXPECT_NEAR(c.g, 0.5, 1e-12);
    EXPECT_EQ(c.b, 0.0);
}

/// Everything that the renderer takes, lit, mirrored and refracted.
void add_all(SceneMaker& maker) {
    Material floor, mirror, glass, clay;
    floor.diffuse.color = {0.8, 0.7, 0.6};
    mirror.reflective.color = {0.7, 0.8, 0.9};
    glass.transmissive.color = {0.9, 0.8, 0.7};
    glass.index.value = 1.5;
    clay.diffuse.color = {0.7, 0.3, 0.2};
    maker.add(Plane{.point = {0, -1, 0}, .normal = {0, 1, 0}}, maker.material(floor));
    maker.add(Sphere{.center = {-1.2, 0, 0}}, maker.material(mirror));
    maker.add(Sphere{.center = {1.2, 0, 0}}, maker.material(glass));
    maker.add(BoxShape{{-0.3, -1, -3}, {0.4, 1.5, -2.5}}, maker.material(clay));
    Polygon frame;
    frame.vertices = {{-3, -1, -4}, {3, -1, -4}, {3, 2, -4}, {-3, 2, -4},
                      {-2, 0, -4},  {2, 0, -4},  {2, 1, -4}, {-2, 1, -4}};
    frame.loop_ends = {4, 8};
    maker.add(frame, maker.material(clay));
    TriangleMesh mesh;
    mesh.positions = {{-2, 1, -1}, {2, 1, -1}, {0, 3, -1}, {0, 1.5, -1.5}};
    mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
    maker.add(maker.mesh(mesh), maker.material(clay));
    maker.light(PointLight{.position = {3, 4, 5}});
}

Camera front(double aspect) {
    return look_along({0, 0.5, 7}, {0, 0, -1}, {0, 1, 0}, 0.8, aspect);
}

TEST(ConeTracing, TheBitsDependOnNeitherThreadsNorTiles) {
    SceneMaker maker;
    add_all(maker);
    const Film one = picture_of(maker, front(1.5), 48, 32, {.threads = 1, .tile_size = 32});
    for (const RenderControl& control : {RenderControl{.threads = 2, .tile_size = 7},
                                         RenderControl{.threads = 4, .tile_size = 1}}) {
        const Film other = picture_of(maker, front(1.5), 48, 32, control);
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 48; ++x) ASSERT_EQ(one.at(x, y), other.at(x, y)) << x << ',' << y;
        }
    }
}

TEST(ConeTracing, IsNearManyRaysEverywhere) {
    SceneMaker maker;
    add_all(maker);
    const Film cones = picture_of(maker, front(1.5), 48, 32);
    const Scene scene = maker.compile();
    Film rays(48, 32, {0, 0, 48, 32}), few = rays;
    RenderJob job{.scene = scene, .camera = front(1.5), .samples_per_pixel = 256};
    (void)Whitted().render(job, rays);
    job.samples_per_pixel = 1;
    (void)Whitted().render(job, few);
    double ours = 0, theirs = 0, largest = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 48; ++x) {
            const Rgb d = cones.at(x, y) - rays.at(x, y), e = few.at(x, y) - rays.at(x, y);
            ours += d.r * d.r + d.g * d.g + d.b * d.b;
            theirs += e.r * e.r + e.g * e.g + e.b * e.b;
            largest = std::max({largest, std::abs(d.r), std::abs(d.g), std::abs(d.b)});
        }
    }
    EXPECT_LT(ours, 0.2 * theirs);
    EXPECT_LT(largest, 0.35);
}

TEST(ConeTracing, ASphereThatPenetratesABoxDoesNotDarkenTheContact) {
    SceneMaker maker;
    Material white;
    white.diffuse.color = {1, 1, 1};
    maker.add(Sphere{.center = {0.1, -0.1, 2.2}, .radius = 0.58}, maker.material({}));
    maker.add(BoxShape{{-0.5, -0.56, 2}, {0.64, 0.48, 2.45}}, maker.material(white));
    maker.light(PointLight{.position = {0.05, 0.1, 3.94}});
    const Camera camera = look_along({0.5, -2, 6}, {-0.5, 2, -6}, {0, 0, 1}, 0.3, 4.0 / 3);
    const Film cones = picture_of(maker, camera, 32, 24);
    const Scene scene = maker.compile();
    Film rays(32, 24, {0, 0, 32, 24});
    (void)Whitted().render({.scene = scene, .camera = camera, .samples_per_pixel = 256}, rays);
    double sum = 0, light = 0;
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 32; ++x) {
            const double d = cones.at(x, y).r - rays.at(x, y).r;
            sum += d * d;
            light += d;
        }
    }
    EXPECT_LT(std::sqrt(sum / (32 * 24)), 0.06);
    EXPECT_LT(std::abs(light) / (32 * 24), 0.005);
}

TEST(ConeTracing, TablesChangeAPictureByAThousandth) {
    SceneMaker maker;
    for (int k = 0; k < 20; ++k) {
        maker.add(Sphere{.center = {-4.5 + 0.47 * k, 0.3 * (k % 7) - 1, -2.0 * k},
                         .radius = 0.05 + 0.02 * k},
                  maker.material(glowing({1, 1, 1})));
    }
    const Film formulas = picture_of(maker, front(1), 40, 40);
    const Film tables = picture_of(maker, front(1), 40, 40, {}, {.tables = true});
    double largest = 0;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) {
            largest = std::max(largest, std::abs(formulas.at(x, y).r - tables.at(x, y).r));
        }
    }
    EXPECT_GT(largest, 0.0);
    EXPECT_LT(largest, 2e-3);
}

TEST(ConeTracing, ARectangleHasItsTexture) {
    for (const double slide : {0.0, 5.0}) {
        SceneMaker maker;
        maker.description().textures.push_back({"", testing::red_and_green(), {}});
        Material material;
        material.emission = {{1, 1, 1}, TextureId{0}};
        maker.add(upright(-2 - slide, 2 - slide), maker.material(material),
                  Affine::translate({slide, 0, 0}));
        const Film film = picture_of(maker, unit_pixels(4), 4, 4);
        for (int y = 0; y < 4; ++y) {
            EXPECT_GT(film.at(0, y).r, 0.9) << y;
            EXPECT_EQ(film.at(0, y).g, 0.0) << y;
            EXPECT_GT(film.at(3, y).g, 0.9) << y;
            EXPECT_EQ(film.at(3, y).r, 0.0) << y;
        }
    }
}

TEST(ConeTracing, OtherShapesAreRefusedByName) {
    SceneMaker maker;
    maker.add(Torus{}, maker.material(glowing({1, 1, 1})));
    maker.add(Cylinder{}, maker.material(glowing({1, 1, 1})));
    maker.add(Sphere{}, maker.material(glowing({1, 1, 1})), Affine::scale({1, 2, 1}));
    const Scene scene = maker.compile();
    Film film(1, 1, {0, 0, 1, 1});
    const RenderJob job{
        .scene = scene, .camera = unit_pixels(1), .description = &maker.description()};
    try {
        (void)ConeTracing().render(job, film);
        FAIL();
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("torus"), std::string::npos) << what;
        EXPECT_NE(what.find("cylinder"), std::string::npos) << what;
        EXPECT_NE(what.find("stretched sphere"), std::string::npos) << what;
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
    }
}

TEST(ConeTracing, AFlatMirrorShowsTheMirroredScene) {
    // A sphere above a mirror, and below the place of the mirror.
    const auto scene = [](bool mirrored) {
        SceneMaker maker;
        Material mirror;
        mirror.reflective.color = {1, 1, 1};
        maker.add(Sphere{.center = {0.3, mirrored ? 1.0 : -1.0, -3}, .radius = 0.35},
                  maker.material(glowing({1, 1, 1})));
        if (mirrored) {
            maker.add(Plane{.point = {0, 0, 0}, .normal = {0, 1, 0}}, maker.material(mirror));
        }
        const Camera camera = look_along({0, 1, 2}, {0, -0.4, -1}, {0, 1, 0}, 0.5, 1);
        return picture_of(maker, camera, 24, 24);
    };
    const Film mirrored = scene(true), direct = scene(false);
    for (int y = 8; y < 24; ++y) {
        for (int x = 0; x < 24; ++x) {
            EXPECT_NEAR(mirrored.at(x, y).r, direct.at(x, y).r, 1e-4) << x << ',' << y;
        }
    }
}

TEST(ConeTracing, TheEdgeOfAShadowCrossesAPixel) {
    SceneMaker maker;
    Material white;
    white.diffuse.color = {1, 1, 1};
    maker.add(Plane{}, maker.material(white));
    maker.add(Rectangle{.corner = {0.1, -90, 3}, .edge_u = {90, 0, 0}, .edge_v = {0, 180, 0}},
              maker.material(white));
    maker.light(DirectionalLight{.to_light = {0, 0, 1}});
    OrthographicCamera camera = unit_pixels(1);
    camera.origin = {0, 0, 2};  // below the blocker
    EXPECT_NEAR(picture_of(maker, camera, 1, 1).at(0, 0).r, 1 - segment_area(kRadius, 0.1), 1e-9);
}

TEST(ConeTracing, InstancesUnderAnyPlacementAreTheMovedMesh) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const Affine placement = Affine::translate({-0.4, 0.2, 1}) * Affine::rotate({1, 2, 3}, 0.7) *
                             Affine::scale({2, -0.8, 1.3});
    const auto render = [&](bool moved) {
        SceneMaker maker;
        Material white;
        white.diffuse.color = {1, 1, 1};
        TriangleMesh own = mesh;
        if (moved) own.transform(placement);
        maker.add(maker.mesh(own), maker.material(white), moved ? Affine{} : placement);
        maker.light(PointLight{.position = {3, 4, 5}});
        return picture_of(maker, front(1), 32, 32);
    };
    const Film placed = render(false), moved = render(true);
    double lit = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            EXPECT_NEAR(placed.at(x, y).r, moved.at(x, y).r, 1e-9) << x << ',' << y;
            lit += placed.at(x, y).r;
        }
    }
    EXPECT_GT(lit, 1.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
