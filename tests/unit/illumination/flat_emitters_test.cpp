#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/illumination.h"
#include "support/light_checks.h"
#include "support/odd_even_area.h"
#include "support/random.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

/// A triangle or rectangle of random size and direction at a random place.
Emitter random_emitter(Random& random, EmitterForm form) {
    Emitter e;
    e.form = form;
    e.two_sided = true;
    e.radiance = {1, 1, 1};
    const double size = random.log_uniform(1e-3, 1e3);
    const Vec3 u = random.unit_vector();
    e.world_from_own.translation = random.log_uniform(1e-2, 1e3) * random.unit_vector();
    e.world_from_own.linear.x_axis = size * u;
    e.world_from_own.linear.y_axis = size * random.log_uniform(0.1, 10) * perpendicular(u);
    e.world_from_own.linear.z_axis =
        normalize(cross(e.world_from_own.linear.x_axis, e.world_from_own.linear.y_axis));
    EXPECT_TRUE(make_ready(e));
    return e;
}

TEST(FlatEmitters, DoNotLightThemselves) {
    Random random(91);
    for (const EmitterForm form : {EmitterForm::Triangle, EmitterForm::Rectangle}) {
        for (int i = 0; i < 500; ++i) {
            const Emitter e = random_emitter(random, form);
            const Mat3& own = e.world_from_own.linear;
            for (int k = 0; k < 20; ++k) {
                const double x = random.uniform(0.05, 0.45), y = random.uniform(0.05, 0.45);
                const Vec3 exact = e.world_from_own.translation + x * own.x_axis + y * own.y_axis;
                // Off the plane by the rounding of a few operations.
                const double off = 8 * 0x1p-53 * random.uniform(-1, 1);
                const Vec3 from = exact + off * max_component(abs(exact)) * own.z_axis;
                double light = 0;
                constexpr int kDraws = 16;
                for (int n = 0; n < kDraws; ++n) {
                    const EmitterSample s = sample(e, from, {random.uniform(), random.uniform()});
                    if (!(s.density > 0.0)) continue;
                    light += 1.0 / s.density / kDraws;
                }
                // Half of all directions would be 6.28.
                ASSERT_LT(light, 1e-3) << "case " << i << ", point " << k;
            }
        }
    }
}

TEST(FlatEmitters, LightWhatLiesJustBesideTheirPlane) {
    Random random(92);
    for (const EmitterForm form : {EmitterForm::Triangle, EmitterForm::Rectangle}) {
        for (int i = 0; i < 500; ++i) {
            const Emitter e = random_emitter(random, form);
            const Mat3& own = e.world_from_own.linear;
            const double scale = max_component(abs(e.world_from_own.translation)) +
                                 length(own.x_axis) + length(own.y_axis);
            const Vec3 from = e.world_from_own.translation + 0.3 * (own.x_axis + own.y_axis) +
                              1e-11 * scale * own.z_axis;
            const EmitterSample s = sample(e, from, {0.3, 0.7});
            ASSERT_GT(s.density, 0.0);
            const EmitterHit hit{s.to_light, s.distance, own.z_axis, s.parameters};
            ASSERT_NEAR(density(e, from, hit) / s.density, 1.0, 1e-9);
            if (1e-11 * scale < 1e-6 * length(own.x_axis)) {
                ASSERT_NEAR(1.0 / s.density, 6.283, 0.01) << "case " << i;
            }
        }
    }
}

TEST(FlatEmitters, PolygonsWithCornersRoundedToFloatsAreDrawn) {
    for (const double away : {0.0, 1.0, 300.0}) {
        for (const bool has_hole : {false, true}) {
            // A plane in general position.
            const auto place = [&](double x, double y) {
                return Vec3{x + 0.03 * y, y - 0.1 * x, 3 + 0.31 * x - 0.17 * y};
            };
            Polygon lamp;
            for (const Vec2& at :
                 {Vec2{-1, -1}, Vec2{-1.2, 0.7}, Vec2{0.1, 1.3}, Vec2{1, 0.9}, Vec2{0.8, -1.1}}) {
                lamp.vertices.push_back(place(at.x, at.y));
            }
            lamp.loop_ends = {5};
            if (has_hole) {
                for (const Vec2& at : {Vec2{0, 0}, Vec2{0.5, 0.2}, Vec2{0.3, 0.6}}) {
                    lamp.vertices.push_back(place(at.x, at.y));
                }
                lamp.loop_ends.push_back(8);
            }
            const Vec3 shift{away, 0.7 * away, 0.4 * away};
            for (Vec3& v : lamp.vertices) {
                v += shift;
                for (int k = 0; k < 3; ++k) v[k] = static_cast<float>(v[k]);
            }
            SceneMaker maker;
            Material surface;
            surface.emission.color = {2, 3, 4};
            maker.add(lamp, maker.material(surface));
            const Scene scene = maker.compile();
            const Illumination lights(scene);
            const LitPoint at{Vec3{0.1, 0.2, 0} + shift, {0, 0, 1}, false};
            EXPECT_FALSE(lights.has_unsampled_emitters()) << away << has_hole;
            EXPECT_GT(mean_irradiance(scene, lights, at, 1000).a, 0.0) << away << has_hole;
            expect_equal_densities(scene, lights, at, 1e-5);
            EXPECT_LT(std::abs(irradiance_z(scene, lights, at, 20000, 7)), 4.5);
        }
    }
}

TEST(FlatEmitters, PolygonsThatMeetThemselvesShineOnce) {
    std::vector<std::vector<Vec3>> loops;
    for (const LoopOfArea& c : touching_loops()) loops.push_back(c.loop);
    Random random(93);
    for (int i = 0; i < 30; ++i) {
        const std::vector<Vec3> loop = random_loop(random);
        if (odd_even_area(loop) > 0.0) loops.push_back(loop);
    }
    for (const std::vector<Vec3>& loop : loops) {
        SceneMaker maker;
        Material surface;
        surface.emission.color = {2, 3, 4};
        maker.add(Polygon{.vertices = loop}, maker.material(surface));
        const Scene scene = maker.compile();
        const Illumination lights(scene);
        const LitPoint at{{0.3, 0.2, -2}, {0, 0, 1}, false};
        EXPECT_LT(std::abs(irradiance_z(scene, lights, at, 20000, 7)), 4.5) << &loop - loops.data();
    }
}

TEST(FlatEmitters, RaysFromPolygonsWithCornersOffTheirPlaneLeaveThem) {
    for (const bool has_hole : {false, true}) {
        for (double off = 1e-15; off < 1e-4; off *= 4.0) {
            // Two opposite corners are raised, and all of the hole.
            Polygon lamp;
            lamp.vertices = {{-1, -1, 3 + off}, {-1, 1, 3}, {1, 1, 3 + off}, {1, -1, 3}};
            lamp.loop_ends = {4};
            if (has_hole) {
                for (const Vec2& at : {Vec2{0, 0}, Vec2{0.5, 0.2}, Vec2{0.5, 0.6}}) {
                    lamp.vertices.push_back({at.x, at.y, 3 + off});
                }
                lamp.loop_ends.push_back(7);
            }
            SceneMaker maker;
            Material surface;
            surface.emission.color = {1, 1, 1};
            maker.add(lamp, maker.material(surface));
            const Scene scene = maker.compile();
            const Illumination lights(scene);
            Random random(93);
            for (int i = 0; i < 200; ++i) {
                const Vec2 place{random.uniform(), random.uniform()};
                const Vec2 direction{random.uniform(), random.uniform()};
                const LightRay out =
                    lights.emit(random.uniform(), place, direction, kColorChannels);
                ASSERT_GT(out.place_density, 0.0);
                Hit hit;
                ASSERT_FALSE(scene.aggregate->closest(out.ray, hit, {nullptr}))
                    << "off " << off << ", ray " << i;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
