#include "alhazen/shading/lights/light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/extent_triangles.h"
#include "support/odd_even_area.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Light, PointLightAttenuatesByItsQuadratic) {
    PointLight light;
    light.position = {0, 0, 2};
    light.attenuation = {1, 2, 3};
    const LightSample s = sample(light, {0, 0, 0}, true);
    EXPECT_EQ(s.distance, 2.0);
    EXPECT_EQ(s.to_light, (Vec3{0, 0, 1}));
    EXPECT_DOUBLE_EQ(s.intensity.r, 1.0 / (1 + 4 + 12));
}

TEST(Light, AttenuationIsClampedToOneOnlyWhenTheConventionSaysSo) {
    PointLight light;
    light.position = {0, 0, 0.5};
    light.attenuation = {0, 0, 1};
    EXPECT_EQ(sample(light, {0, 0, 0}, true).intensity.r, 1.0);
    EXPECT_EQ(sample(light, {0, 0, 0}, false).intensity.r, 4.0);
    light.attenuation = {0, 0, 0};
    EXPECT_EQ(sample(light, {0, 0, 0}, true).intensity.r, 1.0);
}

TEST(Light, SpotIsFullInsideNothingOutsideAndHalfwayBetween) {
    SpotLight light;
    light.position = {0, 0, 1};
    light.direction = {0, 0, -1};
    light.inner_angle = 0.2;
    light.outer_angle = 0.4;
    const auto at_angle = [&](double a) {
        return sample(light, {std::tan(a), 0, 0}, true).intensity.r;
    };
    EXPECT_EQ(at_angle(0.1), 1.0);
    EXPECT_NEAR(at_angle(0.3), 0.5, 1e-12);
    EXPECT_EQ(at_angle(0.5), 0.0);
}

TEST(Light, AmbientLightOnlyHasAnAmbientTerm) {
    const Light light = AmbientLight{{0.1, 0.2, 0.3}};
    EXPECT_FALSE(illuminates(light));
    EXPECT_EQ(ambient_of(light), (Rgb{0.1, 0.2, 0.3}));
    EXPECT_TRUE(illuminates(Light{DirectionalLight{}}));
}

TEST(Light, CosinesOfASpotDecideAsItsAnglesDo) {
    for (const auto& [inner, outer] :
         {std::pair{0.2, 0.5}, {0.0, 0.0}, {0.3, 0.3}, {0.0, kPi}, {kPi, kPi}}) {
        SpotLight light;
        light.direction = {0, 0, -1};
        light.inner_angle = inner;
        light.outer_angle = outer;
        const Light prepared = ready_to_sample(light);
        const auto expect_same = [&](double angle) {
            const Vec3 point{std::sin(angle), 0, -std::cos(angle)};
            EXPECT_EQ(sample(prepared, point, true).intensity,
                      sample(Light{light}, point, true).intensity)
                << angle;
        };
        for (int i = 0; i <= 1000; ++i) expect_same(kPi * i / 1000);
        for (const double edge : {inner, outer}) {
            for (double apart = 1e-17; apart < 1e-3; apart *= 3) {
                expect_same(edge - apart);
                expect_same(edge + apart);
            }
        }
    }
}

/// A square of side 1 in z = 1, which faces downwards; `up`: upwards.
MeshExtent square(bool up) {
    MeshExtent mesh{{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, {{{0, 1, 2}}, {{0, 2, 3}}}};
    if (up) {
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return mesh;
}

TEST(Light, AnOpenMeshShinesToItsOuterSideLikeThePolygon) {
    const PolygonExtent polygon{square(false).points};
    for (const bool two_sided : {false, true}) {
        const auto at = [&](const LightExtent& extent, const Vec3& point) {
            return sample(ready_to_sample(AreaLight{.extent = extent, .two_sided = two_sided}),
                          point, false)
                .intensity.r;
        };
        for (const Vec3& point : {Vec3{0.5, 0.5, 0}, {3, -1, 0.2}, {0.2, 0.7, 2}, {5, 5, 1}}) {
            EXPECT_NEAR(at(square(false), point), at(polygon, point), 1e-15);
        }
        EXPECT_NEAR(at(square(false), {0.5, 0.5, 0}), 1 / kPi, 1e-15);
        EXPECT_NEAR(at(square(true), {0.5, 0.5, 0}), two_sided ? 1 / kPi : 0.0, 1e-15);
    }
}

TEST(Light, APolygonThatMeetsItselfShinesOnceByTheOddEvenRule) {
    for (const testing::LoopOfArea& c : testing::touching_loops()) {
        EXPECT_NEAR(LightSurface(PolygonExtent{c.loop}, true).area(), c.area, 1e-6);
    }
    const PolygonExtent bow{{{-1, -1, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}}};
    const LightSurface surface(bow, true);
    EXPECT_NEAR(surface.area(), 2, 1e-6);
    EXPECT_NEAR(surface.projected_area({0.6, 0, 0.8}), 1.6, 1e-6);
    EXPECT_LT(length(surface.center()), 1e-6);
    // All face one way.
    const MeshExtent triangles = triangles_of(bow);
    double area = 0;
    for (const auto& [a, b, c] : triangles.triangles) {
        const Vec3 normal = cross(triangles.points[b] - triangles.points[a],
                                  triangles.points[c] - triangles.points[a]);
        area += 0.5 * normal.z;
    }
    EXPECT_NEAR(std::abs(area), 2, 1e-6);
    testing::Random random(8);
    for (int round = 0; round < 500; ++round) {
        const PolygonExtent loop{testing::random_loop(random)};
        EXPECT_NEAR(LightSurface(loop, true).area(), testing::odd_even_area(loop.vertices), 1e-5)
            << round;
    }
}

/// As a mesh of the same surface does. Light of the inner side of a seen sphere stays in it.
TEST(Light, TubesAndUnseenSpheresOfTwoSidesGiveTheLightOfBoth) {
    const Vec3 point{3, 2, -400};
    const auto light = [](const LightExtent& extent, bool two_sided, bool seen) {
        return ready_to_sample(AreaLight{.extent = extent, .two_sided = two_sided, .seen = seen});
    };
    const auto whole = [&](const Light& l) {
        constexpr int kGrid = 64;
        double sum = 0;
        for (int i = 0; i < kGrid * kGrid; ++i) {
            const Vec2 u{(i % kGrid + 0.5) / kGrid, (i / kGrid + 0.5) / kGrid};
            sum += sample_extent(std::get<AreaLight>(l), point, u).intensity.r;
        }
        return sum / (kGrid * kGrid);
    };
    const SphereExtent sphere{{0, 0, 0}, 0.5};
    const TubeExtent tube{{-1, 0, 0}, {1, 0.5, 0.5}, 0.25};
    for (const bool seen : {false, true}) {
        for (const LightExtent& extent : {LightExtent{sphere}, LightExtent{tube}}) {
            const bool closed = std::holds_alternative<SphereExtent>(extent);
            const double sides = closed && seen ? 1 : 2;
            const Light one = light(extent, false, seen), two = light(extent, true, seen);
            const double from_one = sample(one, point, false).intensity.r;
            EXPECT_NEAR(sample(two, point, false).intensity.r, sides * from_one, 1e-15);
            EXPECT_NEAR(whole(one), from_one, 2e-3 * from_one) << closed << seen;
            EXPECT_NEAR(whole(two), sides * from_one, 5e-3 * from_one) << closed << seen;
        }
    }
    // Points of both sides, at their distances.
    const auto ball = std::get<AreaLight>(light(sphere, true, false));
    for (const double u : {0.1, 0.4, 0.6, 0.9}) {
        const LightSample s = sample_extent(ball, point, {u, 0.3});
        const Vec3 place = point + s.distance * s.to_light;
        EXPECT_NEAR(length(place), 0.5, 1e-12);
        EXPECT_EQ(dot(place, s.to_light) > 0.0, u < 0.5) << u;
    }
}

TEST(Light, AMeshOfManyTrianglesHasTheProjectedAreaOfItsTriangles) {
    // The upper half of a sphere, from a few triangles to many.
    for (const int rings : {6, 12, 24, 48}) {
        MeshExtent dome;
        const int around = 4 * rings;
        for (int i = 0; i <= rings; ++i) {
            for (int k = 0; k < around; ++k) {
                const double down = 0.5 * kPi * i / rings, turn = 2 * kPi * k / around;
                dome.points.push_back({std::sin(down) * std::cos(turn),
                                       std::sin(down) * std::sin(turn), std::cos(down)});
            }
        }
        for (int i = 0; i < rings; ++i) {
            for (int k = 0; k < around; ++k) {
                const auto at = [&](int ring, int column) {
                    return static_cast<std::uint32_t>(ring * around + column % around);
                };
                dome.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
                dome.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
            }
        }
        for (const bool two_sided : {false, true}) {
            const LightSurface surface(dome, two_sided);
            for (const Vec3& towards :
                 {Vec3{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0.6, 0, -0.8}, {-0.48, 0.36, 0.8}}) {
                double sum = 0;
                for (const auto& [a, b, c] : dome.triangles) {
                    const double seen = -0.5 * dot(towards, cross(dome.points[b] - dome.points[a],
                                                                  dome.points[c] - dome.points[a]));
                    sum += two_sided ? std::abs(seen) : std::max(0.0, seen);
                }
                const bool single = dome.triangles.size() <= LightSurface::kMostTriangles;
                EXPECT_NEAR(surface.projected_area(towards), sum, single ? 1e-12 : 0.02)
                    << rings << ' ' << towards.x << ' ' << towards.z;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
