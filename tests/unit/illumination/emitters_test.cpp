#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/sampling/random.h"
#include "support/light_checks.h"
#include "support/scene_maker.h"
#include "unit/illumination/lamps.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

TEST(Emitters, ARayAlongADrawFindsItsDensity) {
    int index = 0;
    for (const Scene& scene : lamps()) {
        SCOPED_TRACE(index++);
        const Illumination lights(scene);
        ASSERT_TRUE(lights.emits());
        expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
    }
}

TEST(Emitters, DrawsAreDistributedByTheirDensity) {
    const std::vector<Scene> all = lamps();
    for (std::size_t i = 0; i < all.size(); ++i) {
        // Where a tube or a face is seen edge on, the density has no bound: bins cannot count it.
        if (i % 10 == 4 || i % 10 == 5 || i % 10 == 7) continue;
        const Illumination lights(all[i]);
        const double p = draw_p_value(all[i], lights, kBelowLamps, {{0, 0, 1}, 0.6}, 11 + i);
        EXPECT_GT(p, sidak_level(static_cast<int>(all.size()))) << i;
    }
}

TEST(Emitters, DrawsGiveTheLightThatRaysFindByChance) {
    const std::vector<Scene> all = lamps();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Illumination lights(all[i]);
        const LitPoint beside{{0.9, -0.7, 1}, normalize(Vec3{-0.4, 0.3, 1}), false};
        EXPECT_LT(std::abs(irradiance_z(all[i], lights, kBelowLamps, 20000, i)), 4.5) << i;
        EXPECT_LT(std::abs(irradiance_z(all[i], lights, beside, 20000, 99 + i)), 4.5) << i;
    }
}

TEST(Emitters, APolygonWithACornerOffItsPlaneIsToldFromOthers) {
    Polygon p;
    p.vertices = {{-0.3, 0, 1.1}, {-0.2, 0.5, 1.1333333}, {0.3, 0.4, 1.2}, {0.3, 0, 1.2}};
    EXPECT_TRUE(Illumination(lamp_of(p)).has_unsampled_emitters());
    p.vertices[1].z = 1.1 + 0.1 / 6;
    EXPECT_FALSE(Illumination(lamp_of(p)).has_unsampled_emitters());
}

TEST(Emitters, PolygonsThatCrossThemselvesOrHaveHolesAreDrawn) {
    Polygon bow, ring;
    bow.vertices = {{-1, -1, 3}, {1, 1, 3}, {1, -1, 3}, {-1, 1, 3}};
    ring.vertices = {{-1, -1, 3}, {-1, 1, 3},    {1, 1, 3},    {1, -1, 3},
                     {0, 0, 3},   {0.5, 0.2, 3}, {0.5, 0.5, 3}};
    ring.loop_ends = {4, 7};
    // A strip of 500 degrees around a centre: every triangle of it turns left.
    Polygon strip;
    for (int i = 0; i < 50; ++i) {
        const double angle = kPi / 180.0 * 20.0 * (i < 25 ? i : 49 - i) * 500.0 / 480.0;
        const double r = i < 25 ? 1.0 : 0.5;
        strip.vertices.push_back({r * std::cos(angle), r * std::sin(angle), 3});
    }
    for (const Polygon& lamp : {bow, ring, strip}) {
        for (const Affine& placement : {Affine{}, kSkew, kMirror}) {
            const Scene scene = lamp_of(lamp, placement);
            const Illumination lights(scene);
            ASSERT_TRUE(lights.emits());
            EXPECT_GT(mean_irradiance(scene, lights, kBelowLamps, 1000).a, 0.0);
            expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
            EXPECT_LT(std::abs(irradiance_z(scene, lights, kBelowLamps, 20000, 7)), 4.5);
        }
    }
}

TEST(Emitters, ASphereLightsAPlaneByTheClosedForm) {
    const Scene scene = lamp_of(Sphere{{0, 0, 3}, 1});
    const Illumination lights(scene);
    // A sphere wholly above the horizon: pi L (r / d)^2 cos.
    for (const double x : {0.0, 1.0, 4.0}) {
        const double d2 = 9.0 + x * x;
        const Spectrum found = mean_irradiance(scene, lights, {{x, 0, 0}, {0, 0, 1}}, 20000);
        const double truth = kPi * 2.0 / d2 * (3.0 / std::sqrt(d2));
        EXPECT_NEAR(found.a / truth, 1.0, 2e-3) << x;
        EXPECT_NEAR(found.b / found.a, 1.5, 1e-9);
    }
}

TEST(Emitters, ARectangleLightsAPlaneByTheClosedForm) {
    Rectangle r;
    r.corner = {0, 0, 1.5};
    r.edge_u = {0, 2, 0};
    r.edge_v = {1, 0, 0};
    const Scene scene = lamp_of(r, {}, false);
    const Illumination lights(scene);
    // Siegel and Howell, configuration factor of a parallel rectangle with a corner above the
    // point.
    const double a = 1.0 / 1.5, b = 2.0 / 1.5;
    const double sa = std::sqrt(1 + a * a), sb = std::sqrt(1 + b * b);
    const double factor = (a / sa * std::atan(b / sa) + b / sb * std::atan(a / sb)) / (2.0 * kPi);
    const Spectrum found = mean_irradiance(scene, lights, {{0, 0, 0}, {0, 0, 1}}, 40000);
    EXPECT_NEAR(found.a / (kPi * 2.0 * factor), 1.0, 2e-3);
}

TEST(Emitters, AnEmittingSphereLightsItsOwnInsideEvenly) {
    const Scene scene = lamp_of(Sphere{{0, 0, 0}, 2});
    const Illumination lights(scene);
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0, 0, -1.9}, Vec3{0, 0, -2}}) {
        const Spectrum found = mean_irradiance(scene, lights, {p, {0, 0, 1}}, 20000);
        EXPECT_NEAR(found.a / (kPi * 2.0), 1.0, 0.02) << p.z;
    }
}

TEST(Emitters, InstancesAreLightsOfTheirOwn) {
    SceneMaker maker;
    const MaterialId m = maker.material(lamp_material({1, 1, 1}));
    const ObjectIndex inner = maker.object("inner"), outer = maker.object("outer");
    maker.add(Sphere{{0, 0, 0}, 0.2}, m, {}, inner);
    maker.add(cylinder_lamp(true), m, Affine::scale({0.3, 0.3, 0.3}), inner);
    maker.add(inner, {}, Affine::translate({1, 0, 3}), outer);
    maker.add(inner, {}, Affine::translate({-1, 0, 3}) * Affine::rotate({1, 2, 3}, 1), outer);
    maker.add(outer);
    maker.add(outer, {}, Affine::translate({0, 2, 1}));
    const Scene scene = maker.compile();
    const Illumination lights(scene, {.choice = LightChoice::Uniform});
    expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
    EXPECT_LT(std::abs(irradiance_z(scene, lights, kBelowLamps, 40000, 5)), 3.5);
}

PatchMesh patch_mesh_lamp() {
    PatchMesh mesh;
    mesh.degree_u = mesh.degree_v = 1;
    mesh.points = {{-1, -1, 3}, {-1, 1, 3.2}, {0, -1, 3.4}, {0, 1, 3}, {1, -1, 2.8}, {1, 1, 3.3}};
    mesh.patches = {0, 1, 2, 3, 2, 3, 4, 5};
    return mesh;
}

TEST(Emitters, OneSidedOnesShineToTheirOuterSideAlone) {
    const LitPoint above{{0.2, 0.1, 7}, {0, 0, -1}, false};
    for (const Affine& placement : {Affine{}, kSkew, kMirror, kMirror * kSkew}) {
        std::vector<Scene> all;
        all.push_back(lamp_of(rectangle_lamp(), placement, false));
        all.push_back(lamp_of(Disc{{0, 0, 3}, {0.2, 0.1, -1}, 1}, placement, false));
        all.push_back(lamp_of(Disc{{0, 0, 3}, {0.2, 0.1, 1}, 1}, placement, false));
        all.push_back(lamp_of(polygon_lamp(), placement, false));
        all.push_back(lamp_of(patch_lamp(), placement, false));
        all.push_back(lamp_of(patch_mesh_lamp(), placement, false));
        all.push_back(lamp_of(cylinder_lamp(true), placement, false));
        all.push_back(lamp_of(BoxShape{{-0.7, -0.5, 2.5}, {0.8, 0.5, 3}}, placement, false));
        all.push_back(lamp_of(Sphere{{0.3, 0, 3}, 0.8}, placement, false));
        all.push_back(mesh_lamp(placement, false));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Illumination lights(all[i]);
            int lit = 0;
            for (const LitPoint& at : {kBelowLamps, above}) {
                const double z = irradiance_z(all[i], lights, at, 8000, 31 + i);
                // No variance: the point is dark.
                if (!std::isnan(z)) ++lit;
                EXPECT_FALSE(std::abs(z) > 4.5) << i << " " << z;
            }
            EXPECT_GE(lit, 1) << i;
        }
    }
}

/// How many emitters are drawn for a point.
std::size_t emitters_drawn(const Illumination& lights, const LitPoint& at) {
    std::set<std::size_t> sources;
    RandomStream random(3);
    for (int i = 0; i < 200; ++i) {
        const Vec2 u{random.uniform(), random.uniform()};
        const LightDraw drawn = lights.draw(at, random.uniform(), u, kColorChannels);
        if (drawn.density > 0.0) sources.insert(drawn.place.source);
    }
    return sources.size();
}

TEST(Emitters, HalvesOfARectangleAreOneEmitter) {
    const Rectangle alike = rectangle_lamp();
    const Vec3 a = alike.corner, b = a + alike.edge_u, d = a + alike.edge_v, c = b + alike.edge_v;
    const auto lamp = [&](const std::array<Vec3, 4>& corners,
                          const std::vector<std::array<std::uint32_t, 3>>& triangles,
                          const Affine& placement) {
        SceneMaker maker;
        TriangleMesh mesh;
        mesh.positions.assign(corners.begin(), corners.end());
        mesh.triangles = triangles;
        const MaterialId m = maker.material(lamp_material({2, 3, 4}, false));
        maker.add(maker.mesh(mesh), m, placement);
        return maker.compile();
    };
    for (const Affine& placement : {Affine{}, kMirror, Affine::translate({0.5, 0.25, 1})}) {
        const Scene whole = lamp_of(alike, placement, false);
        const LightDraw by_shape =
            Illumination(whole).draw(kBelowLamps, 0.5, {0.25, 0.75}, kColorChannels);
        for (const auto& triangles :
             {std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}},
              {{1, 2, 3}, {1, 3, 0}},
              {{2, 0, 1}, {2, 3, 0}}}) {
            const Scene scene = lamp({a, b, c, d}, triangles, placement);
            const Illumination lights(scene);
            EXPECT_EQ(emitters_drawn(lights, kBelowLamps), 1u);
            const LightDraw drawn = lights.draw(kBelowLamps, 0.5, {0.25, 0.75}, kColorChannels);
            EXPECT_NEAR(drawn.density, by_shape.density, 1e-12 * by_shape.density);
            expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
            EXPECT_LT(std::abs(irradiance_z(scene, lights, kBelowLamps, 20000, 5)), 4.0);
        }
    }
    // Pairs of triangles that are no rectangle: slanted, folded, of two sizes, overlapping.
    const Vec3 aside{0.3, 0, 0}, up{0, 0, 0.1};
    const std::vector<std::array<std::uint32_t, 3>> usual{{0, 1, 2}, {0, 2, 3}};
    for (const Scene& scene :
         {lamp({a, b + aside, c + aside, d}, usual, {}), lamp({a, b, c, d + up}, usual, {}),
          lamp({a, b, c, d + 0.01 * alike.edge_u}, usual, {})}) {
        const Illumination lights(scene);
        EXPECT_EQ(emitters_drawn(lights, kBelowLamps), 2u);
        expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
    }
    const Scene doubled = lamp({a, b, c, d}, {{0, 1, 2}, {0, 1, 3}}, {});
    EXPECT_EQ(emitters_drawn(Illumination(doubled), kBelowLamps), 2u);
}

/// A material whose emission is a picture.
Material pictured(SceneMaker& maker) {
    Image image(4, 4, 3);
    for (std::size_t i = 0; i < image.samples.size(); ++i) {
        image.samples[i] = static_cast<float>(i * 7 % 11);
    }
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(image));
    maker.description().textures.push_back({"picture", texture, {}});
    Material m = lamp_material({1, 1, 1});
    m.emission.texture = TextureId{0};
    return m;
}

TEST(Emitters, APictureOfEmissionIsDrawnAsItIsSeen) {
    for (const int kind : {0, 1, 2, 3}) {
        SceneMaker maker;
        const MaterialId m = maker.material(pictured(maker));
        const ObjectIndex inner = maker.object("inner");
        if (kind == 0) maker.add(rectangle_lamp(), m, {}, inner);
        if (kind == 1) maker.add(Sphere{{0, 0, 3}, 0.8}, m, {}, inner);
        if (kind == 2) maker.add(cylinder_lamp(true), m, {}, inner);
        if (kind == 3) {
            TriangleMesh mesh;
            mesh.positions = {{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}};
            mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
            mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            maker.add(maker.mesh(mesh), m, {}, inner);
        }
        maker.add(inner, {}, kSkew);
        maker.add(inner, {}, Affine::translate({3, 0, 0}));
        const Scene scene = maker.compile();
        const Illumination lights(scene);
        expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
        EXPECT_LT(std::abs(irradiance_z(scene, lights, kBelowLamps, 40000, 17)), 4.0) << kind;
    }
}

TEST(Emitters, WhatMovesIsLeftToChanceAndWhatRestsBesideItIsNot) {
    SceneMaker maker;
    const MaterialId m = maker.material(lamp_material({1, 1, 1}));
    maker.add(Sphere{{-1, 0, 3}, 0.4}, m);
    maker.add(Sphere{{1, 0, 3}, 0.4}, m);
    maker.add(rectangle_lamp(), m, Affine::translate({0, 0, 2}));
    maker.description().objects[0].parts[1].motion = std::make_shared<const PartMotion>(
        PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({1, 0, 0})}}, {}});
    const Scene scene = maker.compile();
    ASSERT_TRUE(scene.has_motion);
    const Illumination lights(scene);
    const auto density = [&](const Vec3& to) {
        return density_along(scene, lights, kBelowLamps, normalize(to - kBelowLamps.point));
    };
    EXPECT_GT(density({-1, 0, 3}), 0.0);
    for (int i = 0; i < 50; ++i) {
        const LightDraw draw = lights.draw(kBelowLamps, i / 50.0, {0.4, 0.6}, kColorChannels);
        EXPECT_FALSE(draw.density > 0.0 && draw.distance < 4.0 && draw.to_light.x > 0.2);
    }
    expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
}

TEST(Emitters, SolidsOfConstructiveGeometryAreLeftToChance) {
    SceneMaker maker;
    const MaterialId m = maker.material(lamp_material({1, 1, 1}));
    const ObjectIndex cut = maker.object("cut");
    maker.description().objects[1].combine = Combine::Difference;
    maker.add(Sphere{{0, 0, 3}, 1}, m, {}, cut);
    maker.add(Sphere{{0, 0, 2.5}, 0.8}, m, {}, cut);
    maker.add(cut);
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    EXPECT_TRUE(lights.emits());
    EXPECT_EQ(density_along(scene, lights, kBelowLamps, {0, 0, 1}), 0.0);
    EXPECT_EQ(lights.draw(kBelowLamps, 0.5, {0.5, 0.5}, kColorChannels).density, 0.0);
}

TEST(Emitters, OfNoAreaAreNeverDrawn) {
    SceneMaker maker;
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 3}, {1, 0, 3}, {2, 0, 3}, {0, 0, 3}, {0, 1, 3}, {1e-200, 0, 3}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {0, 3, 4}, {0, 5, 4}};
    const MaterialId m = maker.material(lamp_material({1, 1, 1}));
    maker.add(maker.mesh(mesh), m);
    const Scene scene = maker.compile();
    for (const LightChoice choice : {LightChoice::Uniform, LightChoice::Power, LightChoice::Tree}) {
        const Illumination lights(scene, {.choice = choice});
        for (int i = 0; i < 100; ++i) {
            const LightDraw draw =
                lights.draw(kBelowLamps, i / 100.0, {0.3, i / 100.0}, kColorChannels);
            EXPECT_TRUE(std::isfinite(draw.density) && draw.radiance.is_finite());
            EXPECT_FALSE(std::isnan(draw.to_light.x));
        }
        (void)lights.emit(0.5, {0.5, 0.5}, {0.5, 0.5}, kColorChannels);
    }
}

TEST(Emitters, AreFoundByEachWayOfChoosing) {
    SceneMaker maker;
    const MaterialId m = maker.material(lamp_material({1, 2, 3}, false));
    RandomStream random(12);
    for (int i = 0; i < 12; ++i) {
        Rectangle r = rectangle_lamp();
        r.corner = {random.uniform(-4, 3), random.uniform(-4, 3), random.uniform(2, 5)};
        maker.add(r, m);
        maker.add(Sphere{{random.uniform(-4, 4), random.uniform(-4, 4), 6}, 0.3}, m);
    }
    maker.description().picture.background = Rgb{0.05, 0.05, 0.05};
    const Scene scene = maker.compile();
    for (const LightChoice choice : {LightChoice::Uniform, LightChoice::Power, LightChoice::Tree}) {
        const Illumination lights(scene, {.choice = choice});
        expect_equal_densities(scene, lights, kBelowLamps, 1e-5);
        EXPECT_LT(std::abs(irradiance_z(scene, lights, kBelowLamps, 40000, 21)), 4.0)
            << int(choice);
    }
}

TEST(Emitters, WhatDoesNotFaceThePointGivesNothing) {
    Rectangle up = rectangle_lamp();
    std::swap(up.edge_u, up.edge_v);
    const Scene scene = lamp_of(up, {}, false);
    const Illumination lights(scene);
    EXPECT_EQ(lights.draw(kBelowLamps, 0.5, {0.5, 0.5}, kColorChannels).density, 0.0);
}

TEST(Emitters, TheBackgroundLightsEvenly) {
    SceneMaker maker;
    maker.description().picture.background = Rgb{0.5, 0.25, 1};
    maker.add(Sphere{{0, 0, -9}, 0.1});
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    const Spectrum found = mean_irradiance(scene, lights, {{0, 0, 0}, {0, 0, 1}}, 100);
    EXPECT_NEAR(found.a, 0.5 * kPi, 1e-9);
    EXPECT_NEAR(lights.environment({1, 0, 0}, kColorChannels).c, 1.0, 1e-12);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
