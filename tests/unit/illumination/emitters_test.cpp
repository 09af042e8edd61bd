#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/sampling/random.h"
#include "support/light_checks.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

Material shining(const Rgb& radiance, bool two_sided = true) {
    Material m;
    m.emission.color = radiance;
    m.double_sided = two_sided;
    return m;
}

/// A scene of one emitter at about (0, 0, 3), with lit points below.
template <class Shape>
Scene lamp_of(Shape shape, const Affine& placement = {}, bool two_sided = true) {
    SceneMaker maker;
    maker.add(shape, maker.material(shining({2, 3, 4}, two_sided)), placement);
    return maker.compile();
}

Scene mesh_lamp(const Affine& placement, bool two_sided) {
    SceneMaker maker;
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 3}, {1, -1, 3.5}, {0.2, 1.5, 2.5}, {2, 1, 4}};
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    const MaterialId m = maker.material(shining({2, 3, 4}, two_sided));
    maker.add(maker.mesh(mesh), m, placement);
    return maker.compile();
}

const Affine kSkew{{{1.2, 0.1, 0}, {-0.3, 0.7, 0.2}, {0.1, 0, 1.1}}, {0.2, -0.1, 0.3}};
const Affine kMirror{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};

Rectangle rectangle_lamp() {
    Rectangle r;
    r.corner = {-1, -0.5, 3};
    r.edge_u = {0, 1.5, 0};
    r.edge_v = {2, 0, 0};
    return r;
}
Cylinder cylinder_lamp(bool capped) {
    Cylinder c;
    c.base = {-1, 0, 3};
    c.top = {1, 0.4, 3.2};
    c.radius = 0.3;
    c.capped = capped;
    return c;
}
Polygon polygon_lamp() {
    Polygon p;
    p.vertices = {{-1, -1, 3}, {-1, 1, 3}, {0, 0.2, 3}, {1, 1, 3}, {1, -1, 3}};
    return p;
}
BezierPatch patch_lamp() {
    BezierPatch p;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            p.points.push_back({-1 + 0.6 * i, -1 + 0.7 * j, 3 + 0.4 * std::sin(1.0 * i + 2 * j)});
        }
    }
    return p;
}

/// All kinds, with the lit point below them.
std::vector<Scene> lamps() {
    std::vector<Scene> all;
    for (const Affine& placement : {Affine{}, kSkew, kMirror}) {
        all.push_back(lamp_of(Sphere{{0.3, 0, 3}, 0.8}, placement));
        all.push_back(lamp_of(rectangle_lamp(), placement));
        all.push_back(lamp_of(rectangle_lamp(), placement, false));
        all.push_back(lamp_of(Disc{{0, 0.2, 3}, {0.2, 0.1, -1}, 1.1, 0.4}, placement));
        all.push_back(lamp_of(cylinder_lamp(false), placement));
        all.push_back(lamp_of(cylinder_lamp(true), placement, false));
        all.push_back(lamp_of(polygon_lamp(), placement));
        all.push_back(lamp_of(BoxShape{{-0.7, -0.5, 2.5}, {0.8, 0.5, 3}}, placement));
        all.push_back(lamp_of(patch_lamp(), placement));
        all.push_back(mesh_lamp(placement, true));
    }
    all.push_back(mesh_lamp({}, false));
    return all;
}

const LitPoint kAt{{0.1, 0.2, 0}, {0, 0, 1}, false};

TEST(Emitters, ARayAlongADrawFindsItsDensity) {
    int index = 0;
    for (const Scene& scene : lamps()) {
        SCOPED_TRACE(index++);
        const Illumination lights(scene);
        ASSERT_TRUE(lights.emits());
        expect_equal_densities(scene, lights, kAt, 1e-5);
    }
}

TEST(Emitters, DrawsAreDistributedByTheirDensity) {
    const std::vector<Scene> all = lamps();
    for (std::size_t i = 0; i < all.size(); ++i) {
        // Where a tube or a face is seen edge on, the density has no bound: bins cannot count it.
        if (i % 10 == 4 || i % 10 == 5 || i % 10 == 7) continue;
        const Illumination lights(all[i]);
        const double p = draw_p_value(all[i], lights, kAt, {{0, 0, 1}, 0.6}, 11 + i);
        EXPECT_GT(p, sidak_level(static_cast<int>(all.size()))) << i;
    }
}

TEST(Emitters, DrawsGiveTheLightThatRaysFindByChance) {
    const std::vector<Scene> all = lamps();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Illumination lights(all[i]);
        const LitPoint beside{{0.9, -0.7, 1}, normalize(Vec3{-0.4, 0.3, 1}), false};
        EXPECT_LT(std::abs(irradiance_z(all[i], lights, kAt, 20000, i)), 4.5) << i;
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
            EXPECT_GT(mean_irradiance(scene, lights, kAt, 1000).a, 0.0);
            expect_equal_densities(scene, lights, kAt, 1e-5);
            EXPECT_LT(std::abs(irradiance_z(scene, lights, kAt, 20000, 7)), 4.5);
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
    const MaterialId m = maker.material(shining({1, 1, 1}));
    const ObjectIndex inner = maker.object("inner"), outer = maker.object("outer");
    maker.add(Sphere{{0, 0, 0}, 0.2}, m, {}, inner);
    maker.add(cylinder_lamp(true), m, Affine::scale({0.3, 0.3, 0.3}), inner);
    maker.add(inner, {}, Affine::translate({1, 0, 3}), outer);
    maker.add(inner, {}, Affine::translate({-1, 0, 3}) * Affine::rotate({1, 2, 3}, 1), outer);
    maker.add(outer);
    maker.add(outer, {}, Affine::translate({0, 2, 1}));
    const Scene scene = maker.compile();
    const Illumination lights(scene, {.choice = LightChoice::Uniform});
    expect_equal_densities(scene, lights, kAt, 1e-5);
    EXPECT_LT(std::abs(irradiance_z(scene, lights, kAt, 40000, 5)), 3.5);
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
            for (const LitPoint& at : {kAt, above}) {
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
        const MaterialId m = maker.material(shining({2, 3, 4}, false));
        maker.add(maker.mesh(mesh), m, placement);
        return maker.compile();
    };
    for (const Affine& placement : {Affine{}, kMirror, Affine::translate({0.5, 0.25, 1})}) {
        const Scene whole = lamp_of(alike, placement, false);
        const LightDraw by_shape = Illumination(whole).draw(kAt, 0.5, {0.25, 0.75}, kColorChannels);
        for (const auto& triangles :
             {std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}},
              {{1, 2, 3}, {1, 3, 0}},
              {{2, 0, 1}, {2, 3, 0}}}) {
            const Scene scene = lamp({a, b, c, d}, triangles, placement);
            const Illumination lights(scene);
            EXPECT_EQ(emitters_drawn(lights, kAt), 1u);
            const LightDraw drawn = lights.draw(kAt, 0.5, {0.25, 0.75}, kColorChannels);
            EXPECT_NEAR(drawn.density, by_shape.density, 1e-12 * by_shape.density);
            expect_equal_densities(scene, lights, kAt, 1e-5);
            EXPECT_LT(std::abs(irradiance_z(scene, lights, kAt, 20000, 5)), 4.0);
        }
    }
    // Pairs of triangles that are no rectangle: slanted, folded, of two sizes, overlapping.
    const Vec3 aside{0.3, 0, 0}, up{0, 0, 0.1};
    const std::vector<std::array<std::uint32_t, 3>> usual{{0, 1, 2}, {0, 2, 3}};
    for (const Scene& scene :
         {lamp({a, b + aside, c + aside, d}, usual, {}), lamp({a, b, c, d + up}, usual, {}),
          lamp({a, b, c, d + 0.01 * alike.edge_u}, usual, {})}) {
        const Illumination lights(scene);
        EXPECT_EQ(emitters_drawn(lights, kAt), 2u);
        expect_equal_densities(scene, lights, kAt, 1e-5);
    }
    const Scene doubled = lamp({a, b, c, d}, {{0, 1, 2}, {0, 1, 3}}, {});
    EXPECT_EQ(emitters_drawn(Illumination(doubled), kAt), 2u);
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
    Material m = shining({1, 1, 1});
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
        expect_equal_densities(scene, lights, kAt, 1e-5);
        EXPECT_LT(std::abs(irradiance_z(scene, lights, kAt, 40000, 17)), 4.0) << kind;
    }
}

TEST(Emitters, WhatMovesIsLeftToChanceAndWhatRestsBesideItIsNot) {
    SceneMaker maker;
    const MaterialId m = maker.material(shining({1, 1, 1}));
    maker.add(Sphere{{-1, 0, 3}, 0.4}, m);
    maker.add(Sphere{{1, 0, 3}, 0.4}, m);
    maker.add(rectangle_lamp(), m, Affine::translate({0, 0, 2}));
    maker.description().objects[0].parts[1].motion = std::make_shared<const PartMotion>(
        PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({1, 0, 0})}}, {}});
    const Scene scene = maker.compile();
    ASSERT_TRUE(scene.has_motion);
    const Illumination lights(scene);
    const auto density = [&](const Vec3& to) {
        return density_along(scene, lights, kAt, normalize(to - kAt.point));
    };
    EXPECT_GT(density({-1, 0, 3}), 0.0);
    for (int i = 0; i < 50; ++i) {
        const LightDraw draw = lights.draw(kAt, i / 50.0, {0.4, 0.6}, kColorChannels);
        EXPECT_FALSE(draw.density > 0.0 && draw.distance < 4.0 && draw.to_light.x > 0.2);
    }
    expect_equal_densities(scene, lights, kAt, 1e-5);
}

TEST(Emitters, SolidsOfConstructiveGeometryAreLeftToChance) {
    SceneMaker maker;
    const MaterialId m = maker.material(shining({1, 1, 1}));
    const ObjectIndex cut = maker.object("cut");
    maker.description().objects[1].combine = Combine::Difference;
    maker.add(Sphere{{0, 0, 3}, 1}, m, {}, cut);
    maker.add(Sphere{{0, 0, 2.5}, 0.8}, m, {}, cut);
    maker.add(cut);
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    EXPECT_TRUE(lights.emits());
    EXPECT_EQ(density_along(scene, lights, kAt, {0, 0, 1}), 0.0);
    EXPECT_EQ(lights.draw(kAt, 0.5, {0.5, 0.5}, kColorChannels).density, 0.0);
}

TEST(Emitters, OfNoAreaAreNeverDrawn) {
    SceneMaker maker;
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 3}, {1, 0, 3}, {2, 0, 3}, {0, 0, 3}, {0, 1, 3}, {1e-200, 0, 3}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {0, 3, 4}, {0, 5, 4}};
    const MaterialId m = maker.material(shining({1, 1, 1}));
    maker.add(maker.mesh(mesh), m);
    const Scene scene = maker.compile();
    for (const LightChoice choice : {LightChoice::Uniform, LightChoice::Power, LightChoice::Tree}) {
        const Illumination lights(scene, {.choice = choice});
        for (int i = 0; i < 100; ++i) {
            const LightDraw draw = lights.draw(kAt, i / 100.0, {0.3, i / 100.0}, kColorChannels);
            EXPECT_TRUE(std::isfinite(draw.density) && draw.radiance.is_finite());
            EXPECT_FALSE(std::isnan(draw.to_light.x));
        }
        (void)lights.emit(0.5, {0.5, 0.5}, {0.5, 0.5}, kColorChannels);
    }
}

TEST(Emitters, AreFoundByEachWayOfChoosing) {
    SceneMaker maker;
    const MaterialId m = maker.material(shining({1, 2, 3}, false));
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
        expect_equal_densities(scene, lights, kAt, 1e-5);
        EXPECT_LT(std::abs(irradiance_z(scene, lights, kAt, 40000, 21)), 4.0) << int(choice);
    }
}

TEST(Emitters, WhatDoesNotFaceThePointGivesNothing) {
    Rectangle up = rectangle_lamp();
    std::swap(up.edge_u, up.edge_v);
    const Scene scene = lamp_of(up, {}, false);
    const Illumination lights(scene);
    EXPECT_EQ(lights.draw(kAt, 0.5, {0.5, 0.5}, kColorChannels).density, 0.0);
}

TEST(Emitters, HiddenAreaLightsGiveTheIrradianceOfTheirDirection) {
    SceneMaker maker;
    AreaLight lamp;
    lamp.extent = SphereExtent{{0, 0, 3}, 1};
    lamp.seen = false;
    lamp.radiance = {2, 2, 2};
    maker.light(lamp);
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    RandomStream random(1);
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double u = random.uniform(), v = random.uniform();
        const LightDraw draw = lights.draw(kAt, 0.5, {u, v}, kColorChannels);
        ASSERT_TRUE(draw.singular);
        sum += draw.radiance.a / draw.density;
    }
    const double sine2 = 1.0 / (0.1 * 0.1 + 0.2 * 0.2 + 9.0);
    EXPECT_NEAR(sum / 1000 / (2.0 * 2.0 * kPi * (1.0 - std::sqrt(1.0 - sine2))), 1.0, 1e-9);
}

/// No ray meets the light: that of the inner side passes through the rest of the surface.
TEST(Emitters, HiddenSpheresOfTwoSidesShineFromBoth) {
    SceneMaker maker;
    AreaLight lamp;
    lamp.extent = SphereExtent{{0, 0, 3}, 1};
    lamp.seen = false;
    lamp.two_sided = true;
    lamp.radiance = {2, 2, 2};
    maker.light(lamp);
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    RandomStream random(1);
    double sum = 0.0, inner = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const Vec2 u{(i + random.uniform()) / 1000, random.uniform()};
        const LightDraw draw = lights.draw(kAt, 0.5, u, kColorChannels);
        sum += draw.radiance.a / draw.density;
        const Vec3 place = kAt.point + draw.distance * draw.to_light;
        const Vec3 normal = place - Vec3{0, 0, 3};
        EXPECT_NEAR(length(normal), 1.0, 1e-9);
        inner += dot(normal, draw.to_light) > 0.0 ? 1 : 0;
        // What another strategy finds for the same place.
        const Illumination::LightPoint point = lights.point_of_light(draw.place, place);
        const double density = lights.density(kAt, point, draw.to_light, draw.distance);
        const double sine2 = 1.0 / length_squared(kAt.point - Vec3{0, 0, 3});
        const double cone = 2.0 * kPi * (1.0 - std::sqrt(1.0 - sine2));
        EXPECT_NEAR(density * cone, 0.5, 1e-9);
    }
    EXPECT_EQ(inner, 500);
    const double sine2 = 1.0 / (0.1 * 0.1 + 0.2 * 0.2 + 9.0);
    EXPECT_NEAR(sum / 1000 / (2.0 * 2.0 * 2.0 * kPi * (1.0 - std::sqrt(1.0 - sine2))), 1.0, 1e-9);
}

TEST(Emitters, PunctualLightsAreTimesPi) {
    SceneMaker maker;
    maker.light(PointLight{.position = {0, 0, 2}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    const LightDraw draw = lights.draw({{0, 0, 0}, {0, 0, 1}}, 0.3, {0.5, 0.5}, kColorChannels);
    EXPECT_TRUE(draw.singular);
    EXPECT_DOUBLE_EQ(draw.radiance.a / draw.density, kPi / 4);
    EXPECT_EQ(draw.distance, 2.0);
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
            maker.add(shape, maker.material(shining({2, 3, 4}, false)), {}, lamp);
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
                maker.add(lamp, maker.material(shining({1, 1, 1}, false)));
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

// Where the solid angle is certain to be small it is not computed; the bits are the same.
TEST(Emitters, FarOnesAreSampledAsTheirSolidAngleSays) {
    RandomStream random(11);
    int far = 0, near = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto vector = [&](double size) {
            return size * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        };
        Emitter e;
        e.form = i % 2 == 0 ? EmitterForm::Triangle : EmitterForm::Rectangle;
        e.two_sided = i % 3 == 0;
        e.radiance = {1, 1, 1};
        const double size = std::exp(random.uniform(-7, 3));
        const Vec3 x = vector(size);
        Vec3 y = vector(size);
        if (e.form == EmitterForm::Rectangle) y = cross(x, y) / length(x);
        e.world_from_own.linear = {x, y, normalize(cross(x, y))};
        e.world_from_own.translation = vector(2.0);
        if (!make_ready(e)) continue;
        Emitter unknown = e;
        unknown.far_squared = std::numeric_limits<double>::infinity();
        const double distance = std::sqrt(e.far_squared) * std::exp(random.uniform(-1, 1));
        const Vec3 from = e.world_from_own.translation + distance * normalize(vector(1.0));
        const Vec2 u{random.uniform(0, 1), random.uniform(0, 1)};
        const EmitterSample a = sample(e, from, u), b = sample(unknown, from, u);
        ASSERT_EQ(a.density, b.density) << i;
        ASSERT_EQ(a.to_light, b.to_light) << i;
        ASSERT_EQ(a.distance, b.distance) << i;
        const EmitterHit hit{a.to_light, a.distance, e.world_from_own.linear.z_axis, a.parameters};
        ASSERT_EQ(density(e, from, hit), density(unknown, from, hit)) << i;
        ++(is_sampled_by_area(e, from) ? far : near);
    }
    EXPECT_GT(far, 5000);
    EXPECT_GT(near, 5000);
}

// The mean of 1 / density is the solid angle, whichever way is preferred.
TEST(Emitters, ThoseThatPreferAreaHaveTheSameSolidAngle) {
    RandomStream random(12);
    int by_area = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto vector = [&] {
            return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        };
        Emitter e;
        e.form = i % 2 == 0 ? EmitterForm::Triangle : EmitterForm::Rectangle;
        e.two_sided = true;
        e.radiance = {1, 1, 1};
        const Vec3 x = vector();
        Vec3 y = vector();
        if (e.form == EmitterForm::Rectangle) y = cross(x, y) / length(x);
        e.world_from_own.linear = {x, y, normalize(cross(x, y))};
        ASSERT_TRUE(make_ready(e));
        const double edges = length(x) + length(y);
        const Vec3 away = normalize(vector());
        if (std::abs(dot(away, e.world_from_own.linear.z_axis)) < 0.01) continue;
        const Vec3 from = (edges * random.uniform(4, 16)) * away;
        const double solid_angle =
            e.form == EmitterForm::Triangle
                ? SphericalTriangle(-from, x - from, y - from).solid_angle()
                : SphericalRectangle(-from, RectangleSides::of(x, y)).solid_angle();
        prefer_area(e);
        EXPECT_EQ(is_sampled_by_area(e, from) ||
                  solid_angle<kLeastSolidAngle, length(from)> 8.0 * edges ||
                  solid_angle < kLeastSolidAngle);
        by_area += is_sampled_by_area(e, from) && solid_angle > 1.1 * kLeastSolidAngle;
        constexpr int kGrid = 16;
        double sum = 0.0;
        for (int k = 0; k < kGrid * kGrid; ++k) {
            const Vec2 u{(k % kGrid + 0.5) / kGrid, (k / kGrid + 0.5) / kGrid};
            const EmitterSample s = sample(e, from, u);
            const EmitterHit hit{s.to_light, s.distance, e.world_from_own.linear.z_axis,
                                 s.parameters};
            EXPECT_NEAR(density(e, from, hit), s.density, 1e-9 * s.density) << i;
            sum += 1.0 / s.density;
        }
        EXPECT_NEAR(sum / (kGrid * kGrid), solid_angle, 1e-3 * solid_angle) << i;
    }
    EXPECT_GT(by_area, 200);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
