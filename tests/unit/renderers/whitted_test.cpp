#include "alhazen/renderers/whitted/whitted.h"
#include "alhazen/renderers/core/local_shading.h"

#include <gtest/gtest.h>

#include <numbers>

#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "support/expect_near.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;
using testing::SceneMaker;

/// Colour of the middle of the picture; the only sample goes exactly along the camera's axis.
Rgb center(const Scene& scene, RayCounters& counters, const TiledRenderer& renderer = Whitted{}) {
    Film film(1, 1, {0, 0, 1, 1});
    const RenderJob job{scene, scene.cameras[0].camera, 1, 0, true};
    renderer.render_tile(job, {0, 0, 1, 1}, film, counters);
    return film.at(0, 0);
}
Rgb center(const Scene& scene, const TiledRenderer& renderer = Whitted{}) {
    RayCounters counters;
    return center(scene, counters, renderer);
}

Material plain(double kd) {
    Material m;
    m.diffuse.color = {kd, kd, kd};
    return m;
}
Material glass(const Rgb& kt, double index = 1.0) {
    Material m;
    m.transmissive.color = kt;
    m.index.value = index;
    return m;
}

/// A sphere in front of the camera, lit by two lights: every term by hand.
TEST(Whitted, OneSphereAndTwoLightsAreTheEquation) {
    SceneMaker maker;
    Material m;
    m.emission.color = {0.01, 0.02, 0.03};
    m.ambient.color = {0.5, 0.5, 0.5};
    m.diffuse.color = {0.4, 0.3, 0.2};
    m.specular.color = {0.6, 0.6, 0.6};
    m.shininess.value = 20;
    maker.add(Sphere{}, maker.material(m));
    maker.light(AmbientLight{{0.1, 0.2, 0.3}});
    maker.light(DirectionalLight{.to_light = {0, 3, 4}, .color = {1, 0.5, 0.25}});
    // The point is (0, 0, 1), its normal +z; this light stands 2 away, at 30 degrees from the
    // normal.
    const double a = std::numbers::pi / 6;
    maker.light(PointLight{.position = {2 * std::sin(a), 0, 1 + 2 * std::cos(a)},
                           .color = {1, 1, 1},
                           .attenuation = {0.5, 0.25, 0.25}});
    const Scene scene = maker.compile();
    const auto blinn = [](double cos_l) { return std::pow(std::sqrt((1 + cos_l) / 2), 20); };
    const auto term = [&](double intensity, double kd, double cos_l) {
        return intensity * (kd * cos_l + 0.6 * blinn(cos_l));
    };
    const double distant = 1.0 / (0.5 + 0.5 + 1.0);
    const double c = std::cos(a);
    expect_near(center(scene), {0.01 + 0.05 + term(1, 0.4, 0.8) + term(distant, 0.4, c),
                                0.02 + 0.1 + term(0.5, 0.3, 0.8) + term(distant, 0.3, c),
                                0.03 + 0.15 + term(0.25, 0.2, 0.8) + term(distant, 0.2, c)});
    expect_near(center(scene, RayCasting{}), center(scene));
}

TEST(Whitted, PhongMeasuresTheMirroredLightInsteadOfTheHalfVector) {
    SceneMaker maker;
    Material m;
    m.specular.color = {1, 1, 1};
    m.shininess.value = 3;
    maker.add(Sphere{}, maker.material(m));
    maker.light(DirectionalLight{.to_light = {0, 3, 4}});
    maker.description().conventions.shading.highlight = ShadingConventions::Highlight::Phong;
    expect_near(center(maker.compile()), std::pow(0.8, 3) * Rgb{1, 1, 1});
}

/// Slabs of glass between the point and the light: each is entered and left, so each counts twice.
TEST(Whitted, ASlabOfGlassAttenuatesShadowRaysByKtSquaredAndTwoByItsFourthPower) {
    for (int slabs = 0; slabs <= 3; ++slabs) {
        SceneMaker maker;
        const MaterialId white = maker.material(plain(1));
        const MaterialId pane = maker.material(glass({0.9, 0.8, 0.5}, 1.5));
        maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  white);
        for (int i = 0; i < slabs; ++i) {
            maker.add(BoxShape{.lo = {1 + 2.0 * i, -9, 0.5}, .hi = {2 + 2.0 * i, 9, 40}}, pane);
        }
        maker.light(DirectionalLight{.to_light = {4, 0, 3}});
        RayCounters counters;
        const Rgb color = center(maker.compile(), counters);
        const double n = 2.0 * slabs;
        expect_near(color, 0.6 * Rgb{std::pow(0.9, n), std::pow(0.8, n), std::pow(0.5, n)});
        EXPECT_EQ(counters[RayKind::Shadow].cast, 1u);
        EXPECT_EQ(counters[RayKind::Shadow].hit, slabs > 0 ? 1u : 0u);
    }
}

TEST(Whitted, WhatIsNearerThanTheLeastDistanceIsNotMet) {
    const auto color_with = [](double lo, double hi, double min_distance, bool seen_through) {
        SceneMaker maker;
        const MaterialId white = maker.material(plain(1));
        const MaterialId pane = maker.material(glass({0.5, 0.5, 0.5}));
        maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  white);
        const Vec3 a = seen_through ? Vec3{-1, -1, lo} : Vec3{0.8 * lo, -1, -1};
        const Vec3 b = seen_through ? Vec3{1, 1, hi} : Vec3{0.8 * hi, 1, 30};
        maker.add(BoxShape{.lo = a, .hi = b}, pane);
        maker.light(DirectionalLight{.to_light = {4, 0, 3}});
        ShadingConventions& shading = maker.description().conventions.shading;
        shading.min_distance = min_distance;
        shading.air_index = 1.0;
        return center(maker.compile()).r;
    };
    // Shadows: both faces of the pane; only the first one of a thin pane; the second one if the
    // first is too near.
    EXPECT_NEAR(color_with(1, 1.0005, 0, false), 0.6 * 0.25, 1e-12);
    EXPECT_NEAR(color_with(1, 1.0005, 1e-3, false), 0.6 * 0.5, 1e-12);
    EXPECT_NEAR(color_with(1, 1.0015, 1e-3, false), 0.6 * 0.25, 1e-12);
    EXPECT_NEAR(color_with(0.0005, 1, 1e-3, false), 0.6 * 0.5, 1e-12);
    // The view through the pane; its shadow does not reach the point.
    const double thick = color_with(1, 1.0015, 1e-3, true);
    EXPECT_NEAR(color_with(1, 1.0005, 1e-3, true), 2 * thick, 1e-12);
    EXPECT_NEAR(color_with(1, 1.0005, 0, true), thick, 1e-12);
}

TEST(Whitted, BeerShadowsDependOnTheDistanceInside) {
    SceneMaker maker;
    const MaterialId white = maker.material(plain(1));
    const MaterialId pane = maker.material(glass({0.9, 0.8, 0.5}));
    maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}}, white);
    maker.add(BoxShape{.lo = {1, -9, 0.5}, .hi = {2, 9, 40}}, pane);
    maker.light(DirectionalLight{.to_light = {4, 0, 3}});
    maker.description().conventions.shading.shadow_tint =
        ShadingConventions::ShadowTint::PerDistance;
    const double d = 1.0 / 0.8;
    expect_near(center(maker.compile()),
                0.6 * Rgb{std::pow(0.9, d), std::pow(0.8, d), std::pow(0.5, d)});
}

TEST(Whitted, LightBehindAnOpaqueObjectIsBlockedButNotBeyondTheLight) {
    SceneMaker maker;
    const MaterialId white = maker.material(plain(1));
    maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}}, white);
    maker.add(Sphere{.center = {2, 0, 2}, .radius = 0.5}, white);
    maker.light(PointLight{.position = {1, 0, 1}});
    const double lit = 1.0 / std::sqrt(2.0);
    expect_near(center(maker.compile()), {lit, lit, lit});
    maker.description().lights.clear();
    maker.light(PointLight{.position = {4, 0, 4}});
    expect_near(center(maker.compile()), {0, 0, 0});
}

TEST(Whitted, AMirrorShowsWhatIsBehindTheCameraTimesKr) {
    SceneMaker maker;
    Material m;
    m.reflective.color = {0.5, 0.25, 1};
    maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
              maker.material(m));
    Material glow;
    glow.emission.color = {1, 1, 1};
    maker.add(Sphere{.center = {0, 0, 20}}, maker.material(glow));
    RayCounters counters;
    expect_near(center(maker.compile(), counters), {0.5, 0.25, 1});
    EXPECT_EQ(counters[RayKind::Reflection].cast, 1u);
    EXPECT_EQ(counters[RayKind::Reflection].hit, 1u);
}

/// Two facing mirrors: the depth ends the recursion, or the product of the coefficients does.
TEST(Whitted, RecursionEndsByDepthAndByContribution) {
    SceneMaker maker;
    Material m;
    m.reflective.color = {0.5, 0.5, 0.5};
    const MaterialId mirror_material = maker.material(m);
    for (const double z : {0.0, 10.0}) {
        maker.add(Rectangle{.corner = {-9, -9, z}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  mirror_material);
    }
    SceneDescription& d = maker.description();
    const auto reflections = [&] {
        RayCounters counters;
        (void)center(maker.compile(), counters);
        return counters[RayKind::Reflection].cast;
    };
    d.conventions.shading.max_depth = 0;
    EXPECT_EQ(reflections(), 0u);
    d.conventions.shading.max_depth = 7;
    EXPECT_EQ(reflections(), 7u);
    d.conventions.shading.min_contribution = 0.1;  // 0.5, 0.25, 0.125 go on, 0.0625 does not
    EXPECT_EQ(reflections(), 3u);
}

TEST(Whitted, APaneOfGlassLetsTheBackgroundThroughTimesKtTwice) {
    SceneMaker maker;
    maker.add(BoxShape{.lo = {-9, -9, 0}, .hi = {9, 9, 1}},
              maker.material(glass({0.5, 1, 0.2}, 1.5)));
    maker.description().picture.background = Rgb{1, 1, 1};
    RayCounters counters;
    expect_near(center(maker.compile(), counters), {0.25, 1, 0.04});
    EXPECT_EQ(counters[RayKind::Refraction].cast, 2u);
    EXPECT_EQ(counters[RayKind::Refraction].hit, 1u);
}

TEST(Whitted, InsideAmbientLightIsMultipliedByKtWhereTheConventionSaysSo) {
    SceneMaker maker;
    Material m = glass({0.5, 0.5, 0.5});
    m.ambient.color = {1, 1, 1};
    maker.add(BoxShape{.lo = {-9, -9, 0}, .hi = {9, 9, 1}}, maker.material(m));
    maker.light(AmbientLight{{0.8, 0.8, 0.8}});
    // Front face: 0.8; back face, seen through one crossing: 0.5 * 0.8 (times kt once more inside).
    expect_near(center(maker.compile()), Rgb{1.2, 1.2, 1.2});
    maker.description().conventions.shading.ambient_inside_times_kt = true;
    expect_near(center(maker.compile()), Rgb{1.0, 1.0, 1.0});
}

TEST(Whitted, TheBackOfAnOpenSurfaceIsNotTheInsideOfAnything) {
    for (const bool per_distance : {false, true}) {
        SceneMaker maker;
        Material m = plain(1);
        m.ambient.color = {1, 1, 1};
        // The normal points away from the camera.
        maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {0, 18, 0}, .edge_v = {18, 0, 0}},
                  maker.material(m));
        maker.light(AmbientLight{{0.25, 0.25, 0.25}});
        maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {0.5, 0.5, 0.5}});
        Conventions& conventions = maker.description().conventions;
        conventions.shading.ambient_inside_times_kt = true;
        if (per_distance)
            conventions.shading.refraction_tint = ShadingConventions::RefractionTint::PerDistance;
        expect_near(center(maker.compile()), {0.75, 0.75, 0.75});
    }
}

TEST(Whitted, GlassThatAbsorbsByDistanceTintsWhatIsSeenThroughIt) {
    SceneMaker maker;
    maker.add(BoxShape{.lo = {-9, -9, 0}, .hi = {9, 9, 2}},
              maker.material(glass({0.5, 1, 0.2}, 1.5)));
    maker.description().picture.background = Rgb{1, 1, 1};
    maker.description().conventions.shading.refraction_tint =
        ShadingConventions::RefractionTint::PerDistance;
    expect_near(center(maker.compile()), {0.25, 1, 0.04});
}

TEST(Whitted, TotalInternalReflectionIsCountedAndCarriesNoLight) {
    SceneMaker maker;
    // A prism whose second face is met at 45 degrees from inside glass of index 1.52.
    TriangleMesh prism;
    prism.positions = {{-1, -9, 0}, {1, -9, 0}, {-1, -9, -2}, {-1, 9, 0}, {1, 9, 0}, {-1, 9, -2}};
    prism.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4},
                       {2, 0, 3}, {2, 3, 5}, {0, 2, 1}, {3, 4, 5}};
    maker.add(maker.mesh(prism), maker.material(glass({1, 1, 1}, 1.52)));
    maker.description().picture.background = Rgb{1, 1, 1};
    RayCounters counters;
    expect_near(center(maker.compile(), counters), {0, 0, 0});
    EXPECT_EQ(counters.total_internal, 1u);
    EXPECT_EQ(counters[RayKind::Refraction].cast, 1u);
}

/// The interpolated normal leans so far that the mirrored ray would enter the surface.
TEST(Whitted, AReflectionThatWouldEnterTheSurfaceUsesTheGeometricNormal) {
    TriangleMesh mesh;
    mesh.positions = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    mesh.triangles = {{0, 1, 2}};
    const Vec3 leaning = normalize(Vec3{1, 0, 0.5});
    mesh.normals = {leaning, leaning, leaning};
    SceneMaker maker;
    Material m;
    m.reflective.color = {1, 1, 1};
    maker.add(maker.mesh(mesh), maker.material(m));
    Material glow;
    glow.emission.color = {0.3, 0.6, 0.9};
    maker.add(Sphere{.center = {0, 0, 20}}, maker.material(glow));
    expect_near(center(maker.compile()), {0.3, 0.6, 0.9});
}

/// A triangle across the view whose interpolated normals have this direction.
TriangleMesh leaning_triangle(const Vec3& normal) {
    TriangleMesh mesh;
    mesh.positions = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.normals = {normal, normal, normal};
    return mesh;
}

TEST(Whitted, WithoutCorrectionTheInterpolatedNormalDecidesAlone) {
    for (const bool correct : {true, false}) {
        SceneMaker mirror;
        mirror.description().conventions.shading.correct_interpolated_normals = correct;
        mirror.description().picture.background = Rgb{0.3, 0.6, 0.9};
        Material m;
        m.reflective.color = {1, 1, 1};
        mirror.add(mirror.mesh(leaning_triangle(normalize(Vec3{1, 0, 0.5}))), mirror.material(m));
        Material glow;
        glow.emission.color = {1, 0.5, 0.25};
        mirror.add(Plane{.point = {0, 0, -1}, .normal = {0, 0, 1}}, mirror.material(glow));
        const Rgb below{1, 0.5, 0.25}, above{0.3, 0.6, 0.9};
        expect_near(center(mirror.compile()), correct ? above : below);

        // The normal looks away from the eye: the ray is refracted as out of the body, by total
        // reflection.
        SceneMaker lens;
        lens.description().conventions.shading.correct_interpolated_normals = correct;
        lens.add(lens.mesh(leaning_triangle(normalize(Vec3{1, 0, -0.2}))),
                 lens.material(glass({1, 1, 1}, 1.5)));
        RayCounters counters;
        center(lens.compile(), counters);
        EXPECT_EQ(counters.total_internal, correct ? 0u : 1u);
    }
}

TEST(Whitted, EyeRaysThatStartInsideASolidShowTheColourOfInsides) {
    const Rgb inside{0.1, 0.2, 0.3}, own{0.5, 0.25, 1};
    Material glow;
    glow.emission.color = own;
    for (const bool set : {false, true}) {
        const auto shown = [&](const auto& shape) {
            SceneMaker maker;
            if (set) maker.description().conventions.shading.inside_color = inside;
            maker.add(shape, maker.material(glow));
            return center(maker.compile());
        };
        expect_near(shown(Sphere{.radius = 100}), set ? inside : own);
        expect_near(shown(Sphere{.radius = 1}), own);          // in front of the eye
        expect_near(shown(Plane{.normal = {0, 0, -1}}), own);  // not closed
    }
    // A ray that enters by alpha starts outside.
    SceneMaker veil;
    veil.description().conventions.shading.inside_color = inside;
    Material half = glow;
    half.alpha_mode = AlphaMode::Blend;
    half.alpha.value = 0.5;
    veil.add(Sphere{.radius = 1}, veil.material(half));
    expect_near(center(veil.compile()), 0.75 * own);
    // Seen in a mirror, the same solid has its own colour.
    SceneMaker maker;
    maker.description().conventions.shading.inside_color = inside;
    Material mirror;
    mirror.reflective.color = {1, 1, 1};
    maker.add(Plane{.point = {0, 0, -1}, .normal = {0, 0, 1}}, maker.material(mirror));
    maker.add(Sphere{.center = {0, 0, 50}, .radius = 10}, maker.material(glow));
    expect_near(center(maker.compile()), own);
}

TEST(Whitted, TheSamePixelsComeOutOfAnyTiling) {
    SceneMaker maker;
    Material m = plain(0.5);
    m.reflective.color = {0.5, 0.5, 0.5};
    maker.add(Sphere{}, maker.material(m));
    maker.add(Plane{.point = {0, -1, 0}, .normal = {0, 1, 0}}, maker.material(plain(0.8)));
    maker.light(PointLight{.position = {3, 4, 5}});
    const Scene scene = maker.compile();
    const RenderJob job{scene, scene.cameras[0].camera, 4, 11, false};
    const auto picture = [&](int tile_size) {
        Film film(40, 30, {0, 0, 40, 30});
        RayCounters counters;
        for (const PixelBox& tile : tiles_of(film.crop(), tile_size)) {
            Whitted{}.render_tile(job, tile, film, counters);
        }
        return film;
    };
    const Film a = picture(40);
    const Film b = picture(7);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) ASSERT_EQ(a.at(x, y), b.at(x, y)) << x << ',' << y;
    }
}

TEST(Whitted, RadianceThatIsNotFiniteIsCountedAndLeftOut) {
    SceneMaker maker;
    Material m = plain(1);
    m.emission.color = {1e308, 0, 0};
    maker.add(Sphere{}, maker.material(m));
    maker.light(AmbientLight{{1e308, 0, 0}});
    maker.description().conventions.shading.ambient_factor =
        ShadingConventions::AmbientFactor::Diffuse;
    maker.light(AmbientLight{{1e308, 0, 0}});
    RayCounters counters;
    expect_near(center(maker.compile(), counters), {0, 0, 0});
    EXPECT_EQ(counters.non_finite, 1u);
}

TEST(LocalShading, ALightWithoutGlintsHasNoHighlightOnGlass) {
    MaterialSample sample;
    sample.diffuse = {0.25, 0.25, 0.25};
    sample.specular = {1, 1, 1};
    sample.shininess = 10;
    ShadingPoint point;
    point.material = &sample;
    point.normal = point.view = {0, 0, 1};
    LightSample light{.to_light = {0, 0, 1}, .distance = 1, .intensity = {1, 1, 1}};
    const ShadingConventions conventions;
    for (const bool glass : {false, true}) {
        sample.transmissive = glass ? Rgb{0.5, 0.5, 0.5} : Rgb{};
        light.glints = true;
        EXPECT_EQ(reflected_fraction(conventions, point, light, 1.0), (Rgb{1.25, 1.25, 1.25}));
        light.glints = false;
        EXPECT_EQ(reflected_fraction(conventions, point, light, 1.0).r, glass ? 0.25 : 1.25);
    }
}

/// With few shapes in a tree shadow rays are cast immediately; with the list they are gathered.
TEST(Whitted, ShadowRaysCastAtOnceShowThePictureOfBatches) {
    for (const bool tinted : {false, true}) {
        SceneMaker maker;
        Material floor = plain(0.7), mirror;
        floor.specular.color = {0.2, 0.2, 0.2};
        floor.shininess.value = 10;
        mirror.reflective.color = {0.8, 0.8, 0.8};
        const MaterialId matt = maker.material(floor);
        const MaterialId ball = maker.material(tinted ? glass({0.9, 0.5, 0.2}, 1.2) : plain(0.4));
        maker.add(BoxShape{{-3, -1.2, -3}, {3, -1, 3}}, matt);
        maker.add(Sphere{{-0.8, -0.4, 0}, 0.5}, ball);
        maker.add(Sphere{{0.3, -0.5, 0.4}, 0.4}, maker.material(mirror));
        maker.add(Sphere{{-0.2, 0.6, -0.4}, 0.3}, ball);
        for (int i = 0; i < 4; ++i) maker.add(Sphere{{-1.2 + 0.8 * i, 0.1, -1}, 0.2}, matt);
        maker.light(AmbientLight{{0.1, 0.1, 0.1}});
        maker.light(PointLight{{1, 2, 2}, {0.6, 0.6, 0.6}});
        maker.light(
            DirectionalLight{.to_light = normalize(Vec3{-1, 2, 1}), .color = {0.4, 0.3, 0.2}});
        const Scene scenes[] = {maker.compile("list"), maker.compile("wide_bvh")};
        Film films[] = {{48, 48, {0, 0, 48, 48}}, {48, 48, {0, 0, 48, 48}}};
        RayCount counts[2];
        for (int k = 0; k < 2; ++k) {
            EXPECT_EQ(scenes[k].aggregate->gains_by_batches(Coherence::Any), k == 0);
            const RenderJob job{.scene = scenes[k], .camera = scenes[k].cameras[0].camera};
            counts[k] = Whitted{}.render(job, films[k]).counters[RayKind::Shadow];
        }
        EXPECT_EQ(counts[0].cast, counts[1].cast);
        EXPECT_EQ(counts[0].hit, counts[1].hit);
        EXPECT_GT(counts[1].hit, 100U);
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 48; ++x) ASSERT_EQ(films[0].at(x, y), films[1].at(x, y));
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
