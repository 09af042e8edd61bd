/// Rays that emitters send: their power, where they begin.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/illumination/illumination.h"
#include "alhazen/sampling/random.h"
#include "support/light_checks.h"
#include "support/scene_maker.h"
#include "unit/illumination/lamps.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

TEST(Emitters, EmittedPowerIsAreaTimesPiTimesRadiance) {
    int index = 0;
    for (const Scene& scene : lamps()) {
        SCOPED_TRACE(index++);
        const Illumination lights(scene);
        RandomStream random(5);
        double power = 0.0;
        constexpr int kRays = 20000;
        for (int i = 0; i < kRays; ++i) {
            const double choice = (i + 0.5) / kRays;
            const Vec2 place{random.uniform(), random.uniform()};
            const Vec2 direction{random.uniform(), random.uniform()};
            const LightRay out = lights.emit(choice, place, direction, kColorChannels);
            const double cosine = dot(out.normal, out.ray.direction);
            power += out.radiance.a * cosine / (out.place_density * out.direction_density) / kRays;
            if (i % 100 != 0) continue;
            // A ray back to the start finds the same densities.
            const Ray back{out.ray.origin + 1e-7 * out.normal, -out.normal};
            Hit hit;
            ASSERT_TRUE(scene.aggregate->closest(back, hit, {nullptr}));
            const Surface surface = surface_at(*scene.aggregate, back, hit);
            const auto found = lights.emit_density(hit, surface, out.ray.direction);
            EXPECT_NEAR(found.place / out.place_density, 1.0, 1e-5);
            EXPECT_NEAR(found.direction / out.direction_density, 1.0, 1e-5);
        }
        EXPECT_GT(power, 0.0);
    }
    const Scene ball = lamp_of(Sphere{{0, 0, 3}, 0.5}, {}, false);
    const LightRay out = Illumination(ball).emit(0.5, {0.3, 0.2}, {0.1, 0.7}, kColorChannels);
    EXPECT_NEAR(out.radiance.a * dot(out.normal, out.ray.direction) /
                    (out.place_density * out.direction_density),
                kPi * 2.0 * kPi, 1e-9);
}

/// The number of rays out of 2000 that hit the scene after less than `reach`.
int hits_of_emitted(const Scene& scene, double reach) {
    const Illumination lights(scene);
    RandomStream random(7);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec2 place{random.uniform(), random.uniform()};
        const Vec2 direction{random.uniform(), random.uniform()};
        const LightRay out = lights.emit(random.uniform(), place, direction, kColorChannels);
        EXPECT_GT(out.place_density, 0.0);
        Hit hit;
        hits += scene.aggregate->closest(out.ray, hit, {nullptr}) &&
                hit.t * std::abs(dot(out.ray.direction, out.normal)) < reach;
    }
    return hits;
}

TEST(Emitters, EmittedRaysMissTheEmitterWhoseOwnFrameIsFar) {
    for (const double far : {0.0, 1e5, 1e6, 1e8}) {
        SCOPED_TRACE(far);
        const Vec3 at{far, -far, far};
        const Affine back = Affine::translate(-at);
        const auto expect_none = [&](const auto& shape) {
            EXPECT_EQ(hits_of_emitted(lamp_of(shape, back, false), 9), 0);
            // The placement of an instance.
            SceneMaker maker;
            const ObjectIndex lamp = maker.object("lamp");
            maker.add(shape, maker.material(lamp_material({2, 3, 4}, false)), {}, lamp);
            maker.add(lamp, MaterialId{0}, back);
            EXPECT_EQ(hits_of_emitted(maker.compile(), 9), 0);
        };
        expect_none(Sphere{at, 0.8});
        expect_none(BoxShape{at - Vec3{0.7, 0.5, 0.3}, at + Vec3{0.8, 0.5, 0.3}});
        expect_none(Disc{at, {0.2, 0.1, -1}, 1.1, 0.4});
        Rectangle rectangle;
        rectangle.corner = at;
        rectangle.edge_u = {1, 0, 0.25};
        rectangle.edge_v = {0, 1, 0.5};
        expect_none(rectangle);
        Cylinder cylinder;
        cylinder.base = at;
        cylinder.top = at + Vec3{0.25, 0.5, 1};
        expect_none(cylinder);
        Polygon polygon;
        for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0.25}, Vec3{1, 1, 0.75}, Vec3{0, 1, 0.5}}) {
            polygon.vertices.push_back(at + p);
        }
        expect_none(polygon);
    }
}

// A sheet in front of a lamp, nearer than 1e-11 of the coordinates.
TEST(Emitters, EmittedRaysMeetWhatIsCloseToTheEmitter) {
    for (const double x : {0.0, 1e5, 1e6}) {
        for (const int kind : {0, 1, 2}) {
            SCOPED_TRACE(x);
            SCOPED_TRACE(kind);
            SceneMaker maker;
            Rectangle lamp;
            lamp.corner = {x, 0, 1};
            lamp.edge_u = {0, 1, 0};
            lamp.edge_v = {1, 0, 0};
            if (kind == 0) {
                maker.add(lamp, maker.material(lamp_material({1, 1, 1}, false)));
            } else {
                AreaLight light;
                light.extent = RectangleExtent{lamp.corner, lamp.edge_u, lamp.edge_v};
                light.seen = kind == 1;
                maker.light(light);
            }
            Rectangle sheet;
            sheet.corner = {x - 1, -1, 1 - 1e-6};
            sheet.edge_u = {3, 0, 0};
            sheet.edge_v = {0, 3, 0};
            maker.add(sheet, maker.material({}));
            EXPECT_EQ(hits_of_emitted(maker.compile(), 2e-6), 2000);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
