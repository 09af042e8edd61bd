#include "alhazen/renderers/distributed/distributed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "alhazen/sampling/samplers/sampler.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
constexpr double kPi = std::numbers::pi;

Film picture_of(const Scene& scene, const Camera& camera, const Renderer& renderer, int side,
                int samples, int threads = 1, int tile = 32) {
    const SamplingPlan plan;
    Film film(side, side, {0, 0, side, side});
    const RenderJob job{.scene = scene,
                        .camera = camera,
                        .samples_per_pixel = samples,
                        .seed = 3,
                        .sampling = &plan,
                        .control = {.threads = threads, .tile_size = tile}};
    EXPECT_TRUE(renderer.render(job, film).complete());
    return film;
}

/// The mean of 1 / density over a grid of samples: the solid angle of the visible part of the
/// light.
double solid_angle(const LightExtent& extent, const Vec3& from) {
    const LightSurface surface(extent, false);
    constexpr int kSide = 400;
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const Vec2 u{(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide};
        const ExtentSample s = surface.sample(from, u);
        if (s.density > 0) sum += 1 / s.density;
    }
    return sum / (kSide * kSide);
}

TEST(LightExtent, DensitiesIntegrateToTheSolidAngle) {
    const double cap = 2 * kPi * (1 - 3 / std::sqrt(10.0));  // disc of radius 1 from 3 above
    EXPECT_NEAR(solid_angle(DiscExtent{{0, 0, 3}, {0, 0, -1}, 1, 0}, {}), cap, 1e-4);
    const double inner = 2 * kPi * (1 - 3 / std::sqrt(9.25));
    EXPECT_NEAR(solid_angle(DiscExtent{{0, 0, 3}, {0, 0, -1}, 1, 0.5}, {}), cap - inner, 1e-4);
    EXPECT_NEAR(solid_angle(SphereExtent{{0, 0, 2}, 1}, {}), 2 * kPi * (1 - std::sqrt(0.75)), 1e-9);
    // A side of a cube from its centre is a sixth of the sphere.
    const Vec3 a{-1, -1, 1}, b{-1, 1, 1}, c{1, 1, 1}, d{1, -1, 1};
    EXPECT_NEAR(solid_angle(RectangleExtent{a, b - a, d - a}, {}), 4 * kPi / 6, 1e-4);
    EXPECT_NEAR(solid_angle(PolygonExtent{{a, b, c, d}}, {}), 4 * kPi / 6, 1e-3);
    EXPECT_NEAR(solid_angle(MeshExtent{{a, b, c, d}, {{{0, 1, 2}}, {{0, 2, 3}}}}, {}), 4 * kPi / 6,
                1e-3);
    EXPECT_EQ(solid_angle(RectangleExtent{a, d - a, b - a}, {}), 0);  // from behind
    // A thin tube of length 2 from the distance 5: 2 r l / (d sqrt(d^2 + (l / 2)^2)).
    EXPECT_NEAR(solid_angle(TubeExtent{{5, 0, -1}, {5, 0, 1}, 1e-3}, {}),
                2e-3 * 2 / (5 * std::sqrt(26.0)), 1e-6);
}

TEST(Distributed, WithNothingToSpreadIsWhittedWithTheSameSamples) {
    SceneMaker maker;
    Material mirror;
    mirror.diffuse.color = {0.3, 0.4, 0.5};
    mirror.reflective.color = {0.5, 0.5, 0.5};
    maker.add(Sphere{}, maker.material(mirror));
    maker.light(PointLight{.position = {2, 3, 4}});
    const Scene scene = maker.compile();
    const Camera& camera = scene.cameras[0].camera;
    const Film a = picture_of(scene, camera, Whitted{}, 24, 16);
    const Film b = picture_of(scene, camera, Distributed{}, 24, 16);
    for (int i = 0; i < 24 * 24; ++i) EXPECT_EQ(a.at(i % 24, i / 24), b.at(i % 24, i / 24));
}

/// A matt floor in z = 0, seen vertically from above without perspective.
struct Floor {
    Floor() {
        Material matt;
        matt.diffuse.color = {1, 1, 1};
        material = maker.material(matt);
        Rectangle floor;
        floor.corner = {-50, -50, 0};
        floor.edge_u = {100, 0, 0};
        floor.edge_v = {0, 100, 0};
        maker.add(floor, material);
    }
    /// The picture covers x from `from` to `from` + width; the camera is below all lights.
    static Camera above(double from, double width) {
        return OrthographicCamera{
            {from + width / 2, 0, 0.5}, {0, 0, -1}, {width, 0, 0}, {0, 1e-3, 0}};
    }
    SceneMaker maker;
    MaterialId material{};
};

TEST(Distributed, AMattFloorBelowADiscShowsItsIrradianceOverPi) {
    Floor floor;
    floor.maker.light(
        AreaLight{.extent = DiscExtent{{0, 0, 2}, {0, 0, -1}, 1, 0}, .radiance = {3, 2, 1}});
    const Scene scene = floor.maker.compile();
    const Film film = picture_of(scene, Floor::above(-1e-3, 2e-3), Distributed{}, 1, 1024);
    // E / (pi L) = r^2 / (r^2 + d^2)
    EXPECT_NEAR(film.at(0, 0).r, 3 * 0.2, 3e-3);
    EXPECT_NEAR(film.at(0, 0).b, 1 * 0.2, 1e-3);
}

/// A half plane at the height 1 under a light from x = -0.5 to 0.5 at the height 3: the shadow of
/// its edge at x = 0 goes from -0.25 to 0.25.
TEST(Distributed, ThePenumbraIsAsWideAsSimilarTrianglesSay) {
    Floor floor;
    Rectangle screen;
    screen.corner = {-50, -50, 1};
    screen.edge_u = {50, 0, 0};
    screen.edge_v = {0, 100, 0};
    floor.maker.add(screen, floor.material);
    floor.maker.light(
        AreaLight{.extent = RectangleExtent{{-0.5, -0.01, 3}, {0, 0.02, 0}, {1, 0, 0}},
                  .radiance = {900, 900, 900}});
    const Scene scene = floor.maker.compile();
    constexpr int kSide = 40;  // pixels of 0.025
    const Film film = picture_of(scene, Floor::above(-0.5, 1), Distributed{}, kSide, 256);
    for (int i = 0; i < kSide; ++i) {
        const double x = -0.5 + (i + 0.5) / kSide, value = film.at(i, kSide / 2).r;
        SCOPED_TRACE(x);
        if (x < -0.251) {
            EXPECT_EQ(value, 0);
        } else if (x > 0.251) {
            EXPECT_GT(value, 0.5);
        } else {
            // The share that is seen grows evenly; cosines and distances change by 6 % at most.
            const double whole = film.at(kSide - 1, kSide / 2).r;
            EXPECT_NEAR(value / whole, (x + 0.25) / 0.5, 0.07);
        }
    }
}

TEST(Distributed, TheCircleOfConfusionIsThatOfAThinLens) {
    PerspectiveCamera camera{{1, 2, 3}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {}};
    camera.lens = {0.1, 4, 0, 0};
    const LensRays lens(camera);
    const Ray center = eye_ray(camera, 0.8, 0.3);
    const Vec3 focus = center.at(4 / -center.direction.z);
    double widest = 0;
    for (int i = 0; i < 4096; ++i) {
        const Vec2 u{(i % 64 + 0.5) / 64, (i / 64 + 0.5) / 64};
        const Ray ray = lens.through(center, u);
        EXPECT_NEAR(length(ray.direction), 1, 1e-14);
        EXPECT_EQ(ray.origin.z, 3);
        EXPECT_LT(length(ray.at((focus.z - ray.origin.z) / ray.direction.z) - focus), 1e-12);
        // In the plane at twice the distance of focus the circle is as wide as the lens.
        const Vec3 far = center.at(8 / -center.direction.z);
        widest = std::max(widest, length(ray.at((far.z - ray.origin.z) / ray.direction.z) - far));
    }
    EXPECT_NEAR(widest, 0.1, 1e-3);
    camera.lens.radius = 0;
    EXPECT_FALSE(LensRays(camera).open());
}

/// A bright screen whose edge runs over the picture while the shutter is open.
TEST(Distributed, TheExposureOfAMovingEdgeRisesLinearly) {
    SceneMaker maker;
    Material bright;
    bright.emission.color = {1, 1, 1};
    Rectangle screen;
    screen.corner = {-10, -5, 0};
    screen.edge_u = {9.5, 0, 0};  // its edge at x = -0.5
    screen.edge_v = {0, 10, 0};
    maker.add(screen, maker.material(bright));
    SceneDescription& d = maker.description();
    d.objects[0].parts[0].motion = std::make_shared<const PartMotion>(
        PartMotion{{}, {{10, Affine{}}, {14, Affine::translate({2, 0, 0})}}, {}});
    // A unit of length each two units of time.
    open_shutter(d, {11, 13});
    const Scene scene = maker.compile();
    ASSERT_TRUE(scene.has_motion);
    constexpr int kSide = 32;
    const Film film = picture_of(scene, Floor::above(-0.5, 2), Distributed{}, kSide, 256);
    for (int i = 0; i < kSide; ++i) {
        // The edge runs from 0 to 1.
        const double x = -0.5 + 2 * (i + 0.5) / kSide;
        EXPECT_NEAR(film.at(i, 7).r, std::clamp(1 - x, 0.0, 1.0), 0.03) << x;
    }
    const Film whitted = picture_of(scene, Floor::above(-0.5, 2), Whitted{}, kSide, 16);
    EXPECT_EQ(whitted.at(4, 7).r, 1);  // x = -0.22, as the shutter opens
    EXPECT_EQ(whitted.at(9, 7).r, 0);  // x = 0.09
}

TEST(Distributed, TheCameraMovesAndNotTheScene) {
    SceneMaker maker;
    Material bright;
    bright.emission.color = {1, 1, 1};
    maker.add(Sphere{{0.9, 0.2, 0}, 0.3}, maker.material(bright));
    SceneDescription& d = maker.description();
    SceneDescription moving = d;
    // Both move the sphere in the picture by the same.
    const Affine to = Affine::rotate({0, 0, 1}, 0.8);
    d.cameras[0].keys = {{0, Affine{}}, {1, inverse(to)}};
    const Scene by_camera = compile(d, {.accelerator = "list"});
    const TransformMotion camera(by_camera.cameras[0].keys);
    const auto picture = [&](const Scene& scene, const TransformMotion* motion) {
        const SamplingPlan plan;
        Film film(24, 24, {0, 0, 24, 24});
        RenderJob job{.scene = scene,
                      .camera = scene.cameras[0].camera,
                      .samples_per_pixel = 256,
                      .camera_motion = motion,
                      .sampling = &plan};
        EXPECT_TRUE(Distributed{}.render(job, film).complete());
        return film;
    };
    const Film a = picture(by_camera, &camera);
    moving.objects[0].parts[0].motion =
        std::make_shared<const PartMotion>(PartMotion{{}, {{0, Affine{}}, {1, to}}, {}});
    const Film b = picture(compile(moving, {.accelerator = "list"}), nullptr);
    double sum = 0;
    for (int i = 0; i < 24 * 24; ++i) {
        EXPECT_NEAR(a.at(i % 24, i / 24).r, b.at(i % 24, i / 24).r, 0.08);
        sum += a.at(i % 24, i / 24).r;
    }
    EXPECT_GT(sum, 10);
}

TEST(Distributed, SameBitsForAnyNumberOfThreadsAndTileSize) {
    Floor floor;
    floor.maker.add(Sphere{{0, 0, 0.2}, 0.2}, floor.material);
    floor.maker.light(AreaLight{.extent = SphereExtent{{1, 1, 3}, 0.5}, .radiance = {4, 4, 4}});
    const Scene scene = floor.maker.compile();
    const Camera camera = Floor::above(-1, 2);
    const Film a = picture_of(scene, camera, Distributed{}, 20, 8);
    const Film b = picture_of(scene, camera, Distributed{}, 20, 8, 2, 7);
    for (int i = 0; i < 400; ++i) EXPECT_EQ(a.at(i % 20, i / 20), b.at(i % 20, i / 20));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
