#include <gtest/gtest.h>

#include "alhazen/shading/bsdf/bsdf_of.h"
#include "alhazen/shading/optics/fresnel.h"
#include "support/bsdf_checks.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

Bsdf of(const Material& m, const BsdfPlace& place = {}) {
    return bsdf_of(m, {}, {}, place);
}
Material glass(double index, double thickness) {
    Material m;
    m.index.value = index;
    MetallicRoughness p;
    p.metallic.value = p.roughness.value = 0;
    p.transmission.value = 1;
    p.thickness.value = thickness;
    m.metallic_roughness = p;
    return m;
}

TEST(BsdfOf, AMattMaterialOfWhittedIsLambert) {
    Material m;
    m.diffuse.color = {0.6, 0.4, 0.2};
    const Bsdf bsdf = of(m);
    EXPECT_NEAR(bsdf.value(view_at(0.5), view_at(0.2), Transport::Radiance).a, 0.6 / kPi, 1e-15);
    EXPECT_EQ(bsdf.albedo(view_at(0.5)), (Spectrum{0.6, 0.4, 0.2, 0.2}));
    EXPECT_TRUE(bsdf.has_density());
    EXPECT_FALSE(bsdf.transmits());
}

TEST(BsdfOf, TheMiddleOfAHighlightIsAsBrightAsWhitteds) {
    Material m;
    m.specular.color = {0.4, 0.4, 0.4};
    m.shininess.value = 50;
    // A light of intensity 1 gives the irradiance pi, and Whitted's equation ks (N.H)^ns = ks.
    EXPECT_NEAR(kPi * of(m).value({0, 0, 1}, {0, 0, 1}, Transport::Radiance).a, 0.4, 0.004);
}

TEST(BsdfOf, CoefficientsAboveOneTogetherAreScaledDown) {
    Material m;
    m.diffuse.color = {0.9, 0.1, 0.1};
    m.reflective.color = {0.9, 0.9, 0.9};
    m.transmissive.color = {0.2, 0.2, 0.2};
    m.index.value = 1.0;
    const Spectrum sum = furnace(of(m), view_at(0.6));
    EXPECT_NEAR(sum.a, 1.0, 1e-3);
    EXPECT_NEAR(sum.b, 1.2 / 2.0, 1e-3);
}

TEST(BsdfOf, GlassReflectsFourPercentAndBendsTheRest) {
    const auto s = of(glass(1.5, 1)).sample({0, 0, 1}, 0.01, {}, Transport::Radiance);
    ASSERT_TRUE(s && s->direction.z > 0.0);
    EXPECT_NEAR(s->density, 0.04, 1e-12);
    const auto t = of(glass(1.5, 1)).sample(view_at(0.6), 0.99, {}, Transport::Radiance);
    EXPECT_NEAR(t->eta, 1.5, 1e-12);
    const auto inside = of(glass(1.5, 1), {.from_inside = true})
                            .sample(view_at(0.9), 0.99, {}, Transport::Radiance);
    EXPECT_NEAR(inside->eta, 1 / 1.5, 1e-12);
}

TEST(BsdfOf, TheIndexOfAWallIsThatOfItsPlace) {
    const auto s =
        of(glass(1.5, 1), {.eta = 1.33 / 1.5}).sample(view_at(0.6), 0.999, {}, Transport::Radiance);
    EXPECT_NEAR(s->eta, 1.5 / 1.33, 1e-12);
}

TEST(BsdfOf, AThinSheetOfGlassDoesNotBend) {
    const Vec3 view = view_at(0.6);
    const auto s = of(glass(1.5, 0)).sample(view, 0.99, {}, Transport::Radiance);
    ASSERT_TRUE(s && s->singular);
    EXPECT_EQ(s->direction, -view);
}

TEST(BsdfOf, GroovesOfAThinSheetTurnWhatItTransmits) {
    Material m = glass(1.5, 0);
    m.metallic_roughness->roughness.value = 0.4;
    m.metallic_roughness->anisotropy.strength = 0.9;
    const Bsdf along = of(m);
    m.metallic_roughness->anisotropy.rotation = kPi / 2;
    const Bsdf turned = of(m);
    const Vec3 view = view_at(0.9), behind = normalize(Vec3{0.5, 0.1, -1});
    const auto quarter = [](const Vec3& v) { return Vec3{-v.y, v.x, v.z}; };
    const double value = along.value(view, behind, Transport::Radiance).a;
    EXPECT_GT(value, 0.01);
    EXPECT_NEAR(turned.value(quarter(view), quarter(behind), Transport::Radiance).a, value,
                1e-12 * value);
    EXPECT_GT(std::abs(turned.value(view, behind, Transport::Radiance).a - value), 0.01 * value);
}

TEST(BsdfOf, AnIndexOfZeroReflectsAll) {
    Material m = glass(0, 1);
    const Bsdf bsdf = of(m);
    for (const double choice : {0.0, 0.5, 0.99}) {
        const auto s = bsdf.sample(view_at(0.6), choice, {}, Transport::Radiance);
        ASSERT_TRUE(s);
        EXPECT_GT(s->direction.z, 0.0);
    }
}

TEST(BsdfOf, ATextureOfTheIndexIsItsNumber) {
    const std::vector<Texture> half{
        SolidTexture{.color = {0.5, 0.5, 0.5}, .other = {0.5, 0.5, 0.5}}};
    Material dielectric, coefficients, plastic = glass(1, 0);
    dielectric.dielectric.emplace();
    coefficients.transmissive.color = {1, 1, 1};
    plastic.metallic_roughness->transmission.value = 0;
    for (Material m : {glass(1, 0), glass(1, 1), plastic, dielectric, coefficients}) {
        m.index = {1.5, kNoTexture};
        const Bsdf number = of(m);
        m.index = {3.0, TextureId{0}};
        const Bsdf texture = bsdf_of(m, half, {}, {});
        for (const double choice : {0.01, 0.5, 0.99}) {
            const auto a = number.sample(view_at(0.6), choice, {0.3, 0.7}, Transport::Radiance);
            const auto b = texture.sample(view_at(0.6), choice, {0.3, 0.7}, Transport::Radiance);
            ASSERT_TRUE(a && b);
            EXPECT_EQ(a->direction, b->direction);
            EXPECT_EQ(a->weight, b->weight);
            EXPECT_EQ(a->density, b->density);
        }
    }
}

TEST(BsdfOf, SpecularTintsAndWeakensTheFace) {
    Material m = glass(1.5, 0);
    m.metallic_roughness->transmission.value = 0;
    m.metallic_roughness->base_color.color = {0, 0, 0};
    m.metallic_roughness->specular.value = 0.5;
    m.metallic_roughness->specular_color.color = {1, 0.5, 0};
    const auto s = of(m).sample({0, 0, 1}, 0.5, {}, Transport::Radiance);
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->weight.a, 0.02, 1e-12);
    EXPECT_NEAR(s->weight.b, 0.01, 1e-12);
    EXPECT_EQ(s->weight.c, 0.0);
}

TEST(BsdfOf, ACoatAddsAHighlightAndDarkensWhatLiesBelow) {
    Material m;
    MetallicRoughness p;
    p.metallic.value = 0;
    p.roughness.value = 1;
    p.specular.value = 0;
    p.base_color.color = {0.5, 0.5, 0.5};
    m.metallic_roughness = p;
    m.index.value = 1.5;
    const Bsdf bare = of(m);
    m.metallic_roughness->coat.strength.value = 1;
    const Bsdf coated = of(m);
    const Vec3 v = view_at(0.5), l = view_at(0.9);
    const double left = 1.0 - (0.04 + 0.96 * schlick_weight(0.5));
    EXPECT_NEAR(coated.value(v, l, Transport::Radiance).a,
                left * bare.value(v, l, Transport::Radiance).a, 1e-12);
    EXPECT_NEAR(furnace(coated, v).a, 1.0 - left + left * 0.5, 1e-3);
}

TEST(BsdfOf, GroovesStretchTheHighlightAcrossThem) {
    Material m;
    MetallicRoughness p;
    p.roughness.value = 0.3;
    p.anisotropy.strength = 0.9;
    m.metallic_roughness = p;
    const Vec3 v{0, 0, 1}, along = normalize(Vec3{0.4, 0, 1}), across = normalize(Vec3{0, 0.4, 1});
    const auto value = [&](const Vec3& l) { return of(m).value(v, l, Transport::Radiance).a; };
    EXPECT_GT(value(along), 3.0 * value(across));
    m.metallic_roughness->anisotropy.rotation = kPi / 2;
    EXPECT_GT(value(across), 3.0 * value(along));
}

TEST(BsdfOf, DiffuseTransmissionSharesTheBodyBetweenTheTwoSides) {
    Material m;
    MetallicRoughness p;
    p.metallic.value = p.specular.value = 0;
    p.base_color.color = {0.8, 0.4, 0.2};
    p.diffuse_transmission.share.value = 0.25;
    p.diffuse_transmission.color.color = {0.1, 0.5, 0.9};
    m.metallic_roughness = p;
    const Vec3 v = view_at(0.5), front = view_at(0.7), behind{0.6, 0, -0.8};
    const Spectrum back = of(m).value(v, front, Transport::Radiance);
    EXPECT_NEAR(back.a, 0.75 * 0.8 / kPi, 1e-12);
    const Spectrum through = of(m).value(v, behind, Transport::Radiance);
    EXPECT_NEAR(through.a, 0.25 * 0.1 / kPi, 1e-12);
    EXPECT_NEAR(through.b, 0.25 * 0.5 / kPi, 1e-12);
    EXPECT_TRUE(of(m).transmits());
    m.metallic_roughness->metallic.value = 1;
    EXPECT_FALSE(of(m).transmits());
}

TEST(BsdfOf, UnlitScattersNothing) {
    Material m;
    m.metallic_roughness = MetallicRoughness{};
    m.metallic_roughness->unlit = true;
    EXPECT_EQ(of(m).lobe_count(), 0u);
    EXPECT_FALSE(of(m).sample(view_at(0.5), 0.5, {0.5, 0.5}, Transport::Radiance));
}

TEST(BsdfOf, ARoughConductorHasTheColourOfItsMetal) {
    Material m;
    m.conductor = Conductor{{0.222, 0.428, 1.334}, {3.208, 2.461, 1.872}, "gold"};
    m.roughness.value = 0.3;
    const Spectrum c = furnace(of(m), view_at(0.9));
    EXPECT_NEAR(c.a, 0.92, 0.02);
    EXPECT_NEAR(c.c, 0.40, 0.02);
}

TEST(BsdfOf, AClearBodyGivesBackAllLightHoweverRough) {
    Material m;
    m.dielectric = Dielectric{};
    m.index.value = 1.5;
    for (const double r : {0.0, 0.4, 1.0}) {
        m.roughness.value = r;
        EXPECT_NEAR(furnace(of(m), view_at(0.4)).a, 1.0, 1e-3);
        EXPECT_NEAR(furnace(of(m, {.from_inside = true}), view_at(0.4)).a, 1.0, 5e-3);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
