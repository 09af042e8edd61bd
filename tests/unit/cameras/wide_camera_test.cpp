#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "alhazen/base/error.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/cameras/pixel_cones.h"
#include "alhazen/cameras/projection.h"
#include "alhazen/imaging/image/image.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shading/lights/environment.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr WideProjection kAll[] = {WideProjection::Equidistant, WideProjection::Equisolid,
                                   WideProjection::Panorama};

/// A camera at the origin, along -z, with x to the right and y up.
WideCamera camera_of(WideProjection projection, double degrees, double aspect = 1.0) {
    return look_around({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, projection, degrees * kPi / 180.0, aspect);
}

Vec3 seen(const Camera& camera, double x, double y) {
    return eye_ray(camera, x, y).direction;
}

void expect_near(const Vec3& a, const Vec3& b) {
    EXPECT_NEAR(length(a - b), 0.0, 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(WideCamera, TheMiddleLooksAheadAndTheEdgesByTheirAngles) {
    for (const WideProjection projection : kAll) {
        for (const double degrees : {60.0, 180.0, 300.0, 360.0}) {
            const double fov =
                std::min(degrees, projection == WideProjection::Panorama ? 180 : 360.0);
            const Camera camera = camera_of(projection, fov);
            const double half = 0.5 * fov * kPi / 180.0;
            expect_near(seen(camera, 0.5, 0.5), {0, 0, -1});
            expect_near(seen(camera, 0.5, 1), {0, std::sin(half), -std::cos(half)});
            expect_near(seen(camera, 0.5, 0), {0, -std::sin(half), -std::cos(half)});
            expect_near(seen(camera, 1, 0.5), {std::sin(half), 0, -std::cos(half)});
            expect_near(seen(camera, 0, 0.5), {-std::sin(half), 0, -std::cos(half)});
        }
    }
}

TEST(WideCamera, HalfwayOutAFisheyeSeesHalfTheAngleOrTheSineOfItsHalf) {
    const double third = kPi / 3.0;  // of an edge at 120 degrees from the axis
    expect_near(seen(camera_of(WideProjection::Equidistant, 240), 0.75, 0.5),
                {std::sin(third), 0, -std::cos(third)});
    const double angle = 2.0 * std::asin(0.5 * std::sin(third));
    expect_near(seen(camera_of(WideProjection::Equisolid, 240), 0.5, 0.75),
                {0, std::sin(angle), -std::cos(angle)});
    // Behind the eye and beyond.
    expect_near(seen(camera_of(WideProjection::Equidistant, 360), 1, 1), {0, 0, 1});
}

TEST(WideCamera, APanoramaShowsLongitudeAndLatitude) {
    const Camera camera = camera_of(WideProjection::Panorama, 180, 2.0);
    const double a = 0.3 * 2.0 * kPi, b = -0.2 * kPi;
    expect_near(seen(camera, 0.8, 0.3),
                {std::cos(b) * std::sin(a), std::sin(b), -std::cos(b) * std::cos(a)});
    // Part of it.
    const Camera part = camera_of(WideProjection::Panorama, 40, 3.0);
    const double edge = kPi / 3.0;
    expect_near(seen(part, 1, 0.5), {std::sin(edge), 0, -std::cos(edge)});
}

TEST(WideCamera, FilmAndDirectionAreInversesAndTheirRatioIsTheSolidAngle) {
    RandomStream random(1);
    for (const WideProjection projection : kAll) {
        const bool panorama = projection == WideProjection::Panorama;
        const WideView view(look_around({0, 0, 0}, {1, 2, -3}, {0.2, 1, 0}, projection,
                                        (panorama ? 150 : 230) * kPi / 180.0, 1.3));
        for (int i = 0; i < 200; ++i) {
            const double x = random.uniform(0.1, 0.9), y = random.uniform(0.1, 0.9);
            if (view.solid_angle(x, y) == 0.0) continue;  // beyond what is straight behind
            const Vec3 d = view.direction(x, y);
            EXPECT_NEAR(length(d), 1.0, 1e-14);
            const Vec2 back = view.film(d);
            EXPECT_NEAR(back.x, x, 1e-12);
            EXPECT_NEAR(back.y, y, 1e-12);
            constexpr double kStep = 1e-5;
            const Vec3 dx = view.direction(x + kStep, y) - view.direction(x - kStep, y);
            const Vec3 dy = view.direction(x, y + kStep) - view.direction(x, y - kStep);
            const double area = length(cross(dx, dy)) / (4.0 * kStep * kStep);
            EXPECT_NEAR(view.solid_angle(x, y), area, 1e-6 * area);
        }
    }
}

TEST(WideCamera, PixelsOfAFullViewHaveFourPiTogether) {
    for (const WideProjection projection : kAll) {
        const bool panorama = projection == WideProjection::Panorama;
        const WideView view(camera_of(projection, panorama ? 180 : 360, panorama ? 2.0 : 1.0));
        constexpr int kSide = 512;
        double sum = 0.0;
        for (int i = 0; i < kSide * kSide; ++i) {
            sum += view.solid_angle((i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide);
        }
        // The border of a disc of pixels.
        const double tolerance = projection == WideProjection::Equisolid ? 2e-3 : 2e-5;
        EXPECT_NEAR(sum / (kSide * kSide), 4.0 * kPi, 4.0 * kPi * tolerance);
    }
}

TEST(WideCamera, ConesOfPixelsHaveTheirSolidAngle) {
    const Camera camera = camera_of(WideProjection::Equisolid, 200, 1.5);
    const PixelCones cones(camera, 300, 200, 1);
    const double expected = WideView(std::get<WideCamera>(camera)).solid_angle(0.5, 0.5) / 60000.0;
    for (const Vec2 film : {Vec2{0.5, 0.5}, Vec2{0.75, 0.3}}) {
        EXPECT_NEAR(kPi * std::pow(cones.at(film).spread, 2.0), expected, 1e-12);
    }
    // As wide as a pixel is high.
    EXPECT_NEAR(eye_cone(camera, 200, 1).spread, std::sqrt(expected), 1e-12);
}

TEST(WideCamera, APanoramaOfAnEnvironmentIsItsPicture) {
    RandomStream random(5);
    Image picture(16, 8, 3);
    for (float& sample : picture.samples) sample = static_cast<float>(random.uniform());
    EnvironmentSettings settings;
    settings.kind = EnvironmentKind::Picture;
    settings.picture = std::make_shared<const Image>(picture);
    for (const Vec3& up : {Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        const Environment environment(settings, up);
        const Camera camera =
            look_around({1, 2, 3}, cross(up, {1, 0, 0}), up, WideProjection::Panorama, kPi, 2.0);
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 16; ++x) {
                const Rgb c =
                    environment.radiance(seen(camera, (x + 0.5) / 16, 1.0 - (y + 0.5) / 8));
                const float* texel = picture.pixel(x, y);
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], texel[k], 1e-6) << x << " " << y;
            }
        }
    }
}

TEST(WideCamera, MovesTurnsAndWidens) {
    const WideCamera camera = camera_of(WideProjection::Panorama, 60, 1.5);
    const Affine turned = Affine::translate({1, 2, 3}) * Affine::rotate({0, 1, 0}, kPi / 2);
    const Camera moved = transformed(turned, camera);
    const Ray ray = eye_ray(moved, 0.7, 0.6);
    EXPECT_EQ(ray.origin, (Vec3{1, 2, 3}));
    expect_near(ray.direction, turned.vector(seen(camera, 0.7, 0.6)));
    EXPECT_NEAR(std::get<WideCamera>(with_aspect(camera, 1.5, 3.0)).width, kPi, 1e-12);
    EXPECT_NEAR(std::get<WideCamera>(with_aspect(camera, 1.5, 9.0)).width, 2 * kPi, 1e-12);
    const EyeRays eye{Camera(camera)};
    Ray out[3];
    const Vec3 sums[] = {eye.column(0.1) + eye.row(0.2), eye.column(0.3) + eye.row(0.9),
                         eye.column(1) + eye.row(0)};
    eye.rays(sums, out);
    EXPECT_EQ(out[1].direction, seen(camera, 0.3, 0.9));
    EXPECT_EQ(out[2].direction, seen(camera, 1, 0));
}

TEST(Projection, IsReadByNameAndKeepsThePlaceOfTheEye) {
    const Camera camera = look_along({1, 2, 3}, {0, -1, 0}, {0, 0, 1}, 0.7, 1.5);
    double aspect = 1.5;
    const Camera fisheye = with_projection(camera, parse_projection("fisheye:220"), aspect);
    EXPECT_EQ(aspect, 1.5);
    EXPECT_NEAR(std::get<WideCamera>(fisheye).height, 220 * kPi / 180, 1e-12);
    EXPECT_NEAR(std::get<WideCamera>(fisheye).width, 330 * kPi / 180, 1e-12);
    EXPECT_EQ(eye_ray(fisheye, 0.5, 0.5).origin, (Vec3{1, 2, 3}));
    expect_near(seen(fisheye, 0.5, 0.5), {0, -1, 0});
    const Camera around = with_projection(fisheye, parse_projection("panorama"), aspect);
    EXPECT_EQ(aspect, 2.0);
    aspect = 1.0;
    const Camera half = with_projection(camera, parse_projection("equisolid"), aspect);
    expect_near(seen(around, 0.75, 0.5), seen(half, 1, 0.5));
    for (const char* wrong : {"", "fish", "fisheye:", "fisheye:0", "fisheye:361", "panorama:181",
                              "perspective:180", "equisolid:1x"}) {
        EXPECT_THROW((void)parse_projection(wrong), Error) << wrong;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
