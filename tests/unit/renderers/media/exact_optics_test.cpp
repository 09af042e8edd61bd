#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "alhazen/shading/optics/fresnel.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::center;
using testing::expect_near;
using testing::glowing;
using testing::SceneMaker;

const Rgb kWhite{1, 1, 1};
constexpr double kFar = 1000.0;

Material glass(double index, const Rgb& kt = kWhite) {
    Material m;
    m.transmissive.color = kt;
    m.index.value = index;
    return m;
}

BoxShape layer(double bottom, double top) {
    return {{-kFar, -kFar, bottom}, {kFar, kFar, top}};
}

/// A scene in white surroundings with exact optics, seen from above the origin.
SceneMaker room(bool fresnel, bool beer, int depth) {
    SceneMaker maker;
    maker.description().picture.background = kWhite;
    ShadingConventions& c = maker.description().conventions.shading;
    c.optics = {fresnel, beer};
    c.max_depth = depth;
    return maker;
}

/// Towards `at`, at an angle from the vertical; `up`: from below.
void look(SceneMaker& maker, double angle, const Vec3& at = {0, 0, 0}, double distance = 5.0,
          bool up = false) {
    const Vec3 d{std::sin(angle), 0, (up ? 1.0 : -1.0) * std::cos(angle)};
    maker.description().cameras[0].camera = look_along(at - distance * d, d, {0, 1, 0}, 1e-9, 1.0);
}

/// What the top of a body of glass below z = 0 reflects of white surroundings.
double reflected(double angle, double index) {
    SceneMaker maker = room(true, false, 1);
    look(maker, angle);
    maker.add(layer(-1, 0), maker.material(glass(index)));
    return center(maker.compile()).g;
}

TEST(ExactOptics, AtNormalIncidenceTheRatioOfDifferenceAndSumIsReflected) {
    for (const double n : {1.1, 1.33, 1.5, 2.42}) {
        EXPECT_NEAR(reflected(0.0, n), std::pow((n - 1.0) / (n + 1.0), 2.0), 1e-12) << n;
    }
}

TEST(ExactOptics, AtBrewstersAngleOnlyLightThatSwingsAcrossIsReflected) {
    for (const double n : {1.33, 1.5, 2.42}) {
        // There rs = (n^2 - 1) / (n^2 + 1) and rp = 0.
        const double rs = (n * n - 1.0) / (n * n + 1.0);
        EXPECT_NEAR(reflected(std::atan(n), n), 0.5 * rs * rs, 1e-12) << n;
    }
}

TEST(ExactOptics, BeyondTheCriticalAngleAllIsReflected) {
    const double n = 1.52, critical = std::asin(1.0 / n);
    const Rgb glow{0.2, 0.5, 3.0};
    for (const double angle : {critical - 0.05, critical + 1e-6, critical + 0.3}) {
        SceneMaker maker = room(true, false, 1);
        maker.add(layer(-9, 0), maker.material(glass(n)));
        // What the reflected ray meets inside of the glass.
        maker.add(Rectangle{{1e-3, -kFar, -0.5}, {kFar, 0, 0}, {0, 2 * kFar, 0}},
                  maker.material(glowing(glow)));
        look(maker, angle, {0, 0, 0}, 2.0, true);
        const double f = dielectric_reflectance(std::cos(angle), n);
        EXPECT_EQ(f == 1.0, angle > critical);
        expect_near(center(maker.compile()), f * glow + (1.0 - f) * kWhite, 1e-12);
    }
}

TEST(ExactOptics, AChannelWithoutTransmittanceIsBlackHoweverThinTheLayer) {
    for (const double thick : {1e-9, 1e-2, 1.0}) {
        SceneMaker maker = room(false, true, 4);
        maker.add(layer(-thick, 0), maker.material(glass(1.0, {1.0, 0.0, 0.5})));
        look(maker, 0.3);
        const double way = thick / std::cos(0.3);
        expect_near(center(maker.compile()), {1.0, 0.0, std::pow(0.5, way)}, 1e-11);
    }
}

TEST(ExactOptics, ASlabReflectsAndPassesAllOrdersOfItsInnerReflections) {
    const Rgb kt{0.9, 0.5, 0.2};
    const double n = 1.5, thick = 2.5;
    for (const double angle : {0.0, 0.4, 1.2}) {
        SceneMaker maker = room(true, true, 60);
        maker.add(layer(-thick, 0), maker.material(glass(n, kt)));
        // Black below: the reflected light alone; then white, with what passes.
        look(maker, angle);
        const double behind = std::sqrt(1.0 - std::pow(std::sin(angle) / n, 2.0));
        const double f = dielectric_reflectance(std::cos(angle), 1.0 / n);
        Rgb all, above;
        for (int i = 0; i < 3; ++i) {
            const double a = std::pow(kt[i], thick / behind);
            const double orders = (1.0 - f) * (1.0 - f) / (1.0 - f * f * a * a);
            above[i] = f + orders * f * a * a;
            all[i] = above[i] + orders * a;
        }
        expect_near(center(maker.compile()), all, 1e-11);
        maker.add(Rectangle{{-kFar, -kFar, -thick - 1}, {2 * kFar, 0, 0}, {0, 2 * kFar, 0}},
                  maker.material(glowing({})));
        expect_near(center(maker.compile()), above, 1e-11);
    }
}

TEST(ExactOptics, AClearSphereIsInvisibleInWhiteSurroundings) {
    for (const double offset : {0.0, 0.5, 0.9, 0.99}) {
        SceneMaker maker = room(true, true, 80);
        maker.add(Sphere{{0, 0, 0}, 1}, maker.material(glass(1.5)));
        look(maker, 0.0, {offset, 0, 0});
        expect_near(center(maker.compile()), kWhite, 1e-9);
    }
}

TEST(ExactOptics, NestedVolumesAbsorbByTheLengthInEach) {
    const Rgb outer{0.9, 0.8, 0.7}, inner{0.5, 0.99, 0.3};
    const auto left = [&](double a, double b) {
        Rgb c;
        for (int i = 0; i < 3; ++i) c[i] = std::pow(outer[i], a) * std::pow(inner[i], b);
        return c;
    };
    SceneMaker maker = room(false, true, 20);
    const MaterialId a = maker.material(glass(1.0, outer)), b = maker.material(glass(1.0, inner));
    maker.add(layer(-4, 0), a);
    maker.add(layer(-2, -1), b);      // inside
    maker.add(layer(-4.5, -3.5), b);  // half outside: left after what it overlaps
    look(maker, 0.0);
    expect_near(center(maker.compile()), left(2.5, 2.0), 1e-12);
    look(maker, std::acos(0.5));
    expect_near(center(maker.compile()), left(5.0, 4.0), 1e-12);
}

TEST(ExactOptics, GlassInWaterReflectsByTheRatioOfBoth) {
    const double water = 1.33, crown = 1.52, angle = 0.5, deep = 1.0;
    const Rgb glow{2, 3, 4};
    SceneMaker maker = room(true, false, 2);
    maker.description().picture.background = Rgb{};
    maker.add(layer(-9, 0), maker.material(glass(water)));
    maker.add(layer(-5, -deep), maker.material(glass(crown)));
    const double sine = std::sin(angle) / water, cosine = std::sqrt(1.0 - sine * sine);
    maker.add(Rectangle{{deep * sine / cosine, -kFar, -0.5}, {kFar, 0, 0}, {0, 2 * kFar, 0}},
              maker.material(glowing(glow)));
    look(maker, angle);
    const double in = dielectric_reflectance(std::cos(angle), 1.0 / water);
    const double f = dielectric_reflectance(cosine, water / crown);
    expect_near(center(maker.compile()), ((1.0 - in) * f) * glow, 1e-12);
}

TEST(ExactOptics, ShadowRaysLoseWhatBothFacesReflectAndTheLengthAbsorbs) {
    const Rgb outer{0.9, 0.8, 0.7}, inner{0.5, 0.99, 0.3};
    Material matt;
    matt.diffuse.color = kWhite;
    for (const double angle : {0.0, 0.7}) {
        SceneMaker maker = room(true, true, 0);
        const double c = std::cos(angle);
        maker.light(DirectionalLight{.to_light = {std::sin(angle), 0, c}, .color = kWhite});
        maker.add(layer(-1, 0), maker.material(matt));
        maker.add(layer(10, 12), maker.material(glass(1.5, outer)));  // above the eye
        maker.add(layer(10.5, 11), maker.material(glass(1.8, inner)));
        look(maker, 0.0);
        const double once = (1.0 - dielectric_reflectance(c, 1.0 / 1.5)) *
                            (1.0 - dielectric_reflectance(c, 1.5 / 1.8));
        Rgb left;
        for (int i = 0; i < 3; ++i) {
            left[i] = c * once * once * std::pow(outer[i], 1.5 / c) * std::pow(inner[i], 0.5 / c);
        }
        expect_near(center(maker.compile()), left, 1e-12);
    }
}

TEST(ExactOptics, PhysicalMaterialsReflectByTheSameLaws) {
    const double angle = 1.1, c = std::cos(angle);
    Material dielectric = glass(1.5), metal;
    dielectric.dielectric = Dielectric{};
    metal.conductor = Conductor{{0.2, 0.4, 1.3}, {3.4, 2.4, 1.8}, ""};
    Material plastic;
    plastic.index.value = 1.5;
    plastic.metallic_roughness = MetallicRoughness{};
    plastic.metallic_roughness->metallic.value = 0;
    plastic.metallic_roughness->roughness.value = 0;
    const Rgb gold{conductor_reflectance(c, 0.2, 3.4), conductor_reflectance(c, 0.4, 2.4),
                   conductor_reflectance(c, 1.3, 1.8)};
    const double f = dielectric_reflectance(c, 1.0 / 1.5);
    const std::vector<std::pair<Material, Rgb>> cases{
        {dielectric, {f, f, f}}, {plastic, {f, f, f}}, {metal, gold}};
    for (const auto& [material, expected] : cases) {
        SceneMaker maker = room(true, true, 1);
        maker.add(layer(-1, 0), maker.material(material));
        look(maker, angle);
        expect_near(center(maker.compile()), expected, 1e-12);
    }
}

/// Smooth, of index 1.5.
Material plastic_or_metal(const ScalarInput& metallic) {
    Material m;
    m.index.value = 1.5;
    m.metallic_roughness.emplace();
    m.metallic_roughness->base_color.color = {0.5, 0.25, 0.125};
    m.metallic_roughness->metallic = metallic;
    m.metallic_roughness->roughness.value = 0;
    return m;
}

TEST(ExactOptics, ASolidTextureOfMetallicIsThatOfTheirPlace) {
    const SolidTexture checks{.color = {1, 1, 1}, .other = {0, 0, 0}, .origin = {0, 0, -9.5}};
    const auto seen = [&](const ScalarInput& metallic, const Vec3& at) {
        SceneMaker maker = room(true, false, 1);
        maker.description().textures.push_back({"checks", checks, {}});
        maker.add(layer(-1, 0), maker.material(plastic_or_metal(metallic)));
        look(maker, 1.1, at);
        return center(maker.compile());
    };
    for (int i = -3; i < 3; ++i) {
        const Vec3 at{i + 0.5, 0.5, 0};
        // The cube around z = 0 is the tenth.
        const double metallic = (i + 9) % 2 == 0 ? 1.0 : 0.0;
        expect_near(seen({1, TextureId{0}}, at), seen({metallic, kNoTexture}, at), 1e-12);
    }
}

TEST(ExactOptics, ShadowRaysFindASolidTextureOfMetallicAtItsPlace) {
    // Plastic everywhere but around the origin of the world.
    const SolidTexture slabs{.kind = SolidTexture::Kind::Stripes,
                             .color = {1, 1, 1},
                             .other = {0, 0, 0},
                             .origin = {0, 0, -1},
                             .size = 2};
    const auto seen = [&](const ScalarInput& metallic) {
        SceneMaker maker = room(true, true, 1);
        maker.description().picture.background = Rgb{};
        maker.description().textures.push_back({"slabs", slabs, {}});
        Material pane = plastic_or_metal(metallic), matt;
        pane.metallic_roughness->transmission.value = 1;
        pane.metallic_roughness->thickness.value = 1;
        matt.diffuse.color = kWhite;
        maker.add(layer(1.5, 2.5), maker.material(pane));
        maker.add(layer(-9, -8), maker.material(matt));
        maker.light(DirectionalLight{.to_light = normalize(Vec3{1, 0, 0.5}), .color = kWhite});
        look(maker, 0.0, {0, 0, -8}, 1.0);
        return center(maker.compile());
    };
    expect_near(seen({1, TextureId{0}}), seen({0, kNoTexture}), 1e-12);
}

TEST(ExactOptics, BlendedMaterialsReflectEachByItsOwnLawInAnyOrder) {
    Material gold;
    gold.conductor = Conductor{{0.2, 0.4, 1.3}, {3.4, 2.4, 1.8}, ""};
    const std::array<Material, 3> materials{plastic_or_metal({0, kNoTexture}),
                                            plastic_or_metal({1, kNoTexture}), gold};
    const auto seen = [&](std::array<std::uint32_t, 3> kinds, std::array<std::uint32_t, 3> order) {
        SceneMaker maker = room(true, false, 1);
        for (const Material& m : materials) maker.material(m);
        TriangleMesh mesh;
        // The weights at the origin are 1/2, 1/4 and 1/4.
        mesh.positions = {{-1, 0, 0}, {1, -2, 0}, {1, 2, 0}};
        mesh.vertex_materials.assign(kinds.begin(), kinds.end());
        mesh.triangles = {order};
        maker.add(maker.mesh(std::move(mesh)), MaterialId{0});
        look(maker, 1.3);
        return center(maker.compile());
    };
    const std::array<std::uint32_t, 3> turns[] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};
    std::array<Rgb, 3> alone;
    for (std::uint32_t k = 0; k < 3; ++k) alone[k] = seen({k, k, k}, turns[0]);
    for (const auto& kinds : turns) {
        const Rgb mean = 0.5 * alone[kinds[0]] + 0.25 * alone[kinds[1]] + 0.25 * alone[kinds[2]];
        for (const auto& order : turns) expect_near(seen(kinds, order), mean, 1e-12);
    }
}

TEST(ExactOptics, ASolidOfSeveralMediaAbsorbsByTheLengthInEach) {
    SceneMaker maker = room(false, true, 20);
    const Rgb outer{0.9, 0.8, 0.7}, inner{0.5, 0.99, 0.3};
    const MaterialId a = maker.material(glass(1.0, outer)), b = maker.material(glass(1.0, inner));
    const ObjectIndex tank = maker.object("tank");
    maker.description().objects.back().combine = Combine::Union;
    maker.add(BoxShape{{-4, -4, 0}, {4, 4, 1}}, a, {}, tank);
    maker.add(BoxShape{{-4, -4, 1}, {4, 4, 3}}, b, {}, tank);
    maker.add(tank, MaterialId{0});
    look(maker, 0.0, {0, 0, 5});
    Rgb left;
    for (int i = 0; i < 3; ++i) left[i] = outer[i] * inner[i] * inner[i];
    expect_near(center(maker.compile()), left, 1e-9);

    Material matt;
    matt.diffuse.color = kWhite;
    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = kWhite});
    maker.add(layer(-2, -1), maker.material(matt));
    look(maker, 0.0, {0, 0, -1}, 0.5);  // from between the floor and the tank
    expect_near(center(maker.compile()), left, 1e-9);
}

TEST(ExactOptics, AWallIsOneBoundaryWhateverTheLeastDistance) {
    const Rgb first{0.9, 0.8, 0.7}, second{0.5, 0.99, 0.3}, third{0.8, 0.4, 0.6};
    for (const double least : {0.0, 1e-6, 0.1}) {
        SceneMaker maker = room(false, true, 20);
        maker.description().conventions.shading.min_distance = least;
        const MaterialId a = maker.material(glass(1.0, first));
        const MaterialId b = maker.material(glass(1.0, second));
        const MaterialId c = maker.material(glass(1.0, third));
        const ObjectIndex tank = maker.object("tank");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(BoxShape{{-4, -4, 0}, {4, 4, 1}}, a, {}, tank);
        maker.add(BoxShape{{-4, -4, 1}, {4, 4, 3}}, b, {}, tank);
        maker.add(BoxShape{{-4, -4, 3}, {4, 4, 3.5}}, c, {}, tank);
        maker.add(BoxShape{{-4, -4, 3.5}, {4, 4, 4}}, a, {}, tank);
        maker.add(tank, MaterialId{0});
        Material matt;
        matt.diffuse.color = kWhite;
        maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = kWhite});
        maker.add(layer(-2, -1), maker.material(matt));
        look(maker, 0.0, {0, 0, -1}, 0.5);  // from between the floor and the tank
        Rgb left;
        for (int i = 0; i < 3; ++i) {
            left[i] = std::pow(first[i], 1.5) * std::pow(second[i], 2.0) * std::sqrt(third[i]);
        }
        expect_near(center(maker.compile()), left, 1e-9);
    }
}

TEST(ExactOptics, SettingsOfTheRendererPrevailOverTheScene) {
    ShadingConventions c;
    c.optics = {false, true};
    make_renderer("whitted")->adjust(c);
    EXPECT_TRUE(!c.optics.fresnel && c.optics.beer);
    make_renderer("distributed:fresnel=on,beer=off")->adjust(c);
    EXPECT_TRUE(c.optics.fresnel && !c.optics.beer);
    make_renderer("whitted:fresnel=scene")->adjust(c);
    EXPECT_TRUE(c.optics.fresnel && !c.optics.beer);
    EXPECT_THROW((void)make_renderer("whitted:fresnel=yes"), Error);
    EXPECT_THROW((void)make_renderer("ray_casting:beer=on"), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
