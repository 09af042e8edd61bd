#include <gtest/gtest.h>

#include <limits>

#include "alhazen/shading/bsdf/bsdf_of.h"
#include "support/bsdf_checks.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Lobes alone, and mixed as materials mix them.
std::vector<NamedBsdf> bsdfs() {
    auto list = lobes_with_density({0.3, 0.7});
    for (const double r : {0.3, 0.8}) {
        list.push_back({"sheen", bsdf_of_lobe(Sheen{{1, 1, 1, 1}, r})});
        list.push_back(
            {"grooves", bsdf_of_lobe(RoughReflection({0.6, 0.1}, SchlickTerm{}, {0.6, 0.8}))});
        MetallicRoughness p;
        p.roughness.value = r;
        p.metallic.value = 0.3;
        p.base_color.color = {0.8, 0.4, 0.2};
        p.coat.strength.value = 0.6;
        p.coat.roughness.value = 0.3;
        p.sheen.color.color = {0.3, 0.2, 0.5};
        p.sheen.roughness.value = 0.4;
        p.transmission.value = 0.5;
        p.thickness.value = 1;
        Material m;
        m.index.value = 1.4;
        m.metallic_roughness = p;
        list.push_back({"many layers", bsdf_of(m, {}, {}, {})});
        m.metallic_roughness->thickness.value = 0;
        m.metallic_roughness->film.strength.value = 0.5;
        list.push_back({"thin, with a film", bsdf_of(m, {}, {}, {})});
        Material whitted;
        whitted.diffuse.color = {0.5, 0.3, 0.2};
        whitted.specular.color = {0.4, 0.4, 0.4};
        whitted.shininess.value = 30;
        whitted.reflective.color = {0.2, 0.2, 0.2};
        list.push_back({"Whitted", bsdf_of(whitted, {}, {}, {})});
        Material copper;
        copper.conductor = Conductor{{0.362, 1.015, 1.247}, {3.127, 2.579, 2.453}, "copper"};
        copper.roughness.value = r;
        list.push_back({"copper", bsdf_of(copper, {}, {}, {})});
    }
    return list;
}

TEST(Bsdf, SamplesAreDistributedByTheDensity) {
    const auto list = bsdfs();
    const double views[] = {0.95, 0.5, 0.15};
    // Every day one view of each.
    const std::size_t tried = list.size() * (thorough() ? std::size(views) : 1);
    const double level = sidak_level(0.01, static_cast<int>(tried));
    std::uint64_t seed = 1;
    for (std::size_t i = 0; i < list.size(); ++i) {
        for (std::size_t v = 0; v < std::size(views); ++v, ++seed) {
            if (!is_tried(v, std::size(views), i)) continue;
            EXPECT_GT(sample_probability(list[i].bsdf, view_at(views[v]), seed, 50000), level)
                << list[i].name << ", view " << views[v];
        }
    }
}

TEST(Bsdf, TheDensityIntegratesToTheShareThatIsSampled) {
    for (const NamedBsdf& b : bsdfs()) {
        for (const double cosine : {0.6}) {
            const Vec3 view = view_at(cosine);
            double integral = 0;
            for (const double part :
                 integrate_cells([&](const Vec3& d) { return b.bsdf.density(view, d); })) {
                integral += part;
            }
            RandomStream random(5);
            int drawn = 0;
            constexpr int kSamples = 40000;
            for (int i = 0; i < kSamples; ++i) {
                const double choice = random.uniform();
                const Vec2 u{random.uniform(), random.uniform()};
                const auto sample = b.bsdf.sample(view, choice, u, Transport::Importance);
                drawn += sample && !sample->singular ? 1 : 0;
            }
            const double share = static_cast<double>(drawn) / kSamples;
            EXPECT_NEAR(integral, share, 4.5 * std::sqrt(0.25 / kSamples)) << b.name << cosine;
            EXPECT_LT(integral, 1.0 + 1e-3) << b.name;
        }
    }
}

TEST(Bsdf, TheWeightIsValueTimesCosineOverDensity) {
    RandomStream random(3);
    for (const NamedBsdf& b : bsdfs()) {
        for (int i = 0; i < 500; ++i) {
            const Vec3 view = view_at(random.uniform(0.001, 1), random.uniform(0, 6));
            const double choice = random.uniform();
            const Vec2 u{random.uniform(), random.uniform()};
            const auto transport = i % 2 == 0 ? Transport::Radiance : Transport::Importance;
            const auto s = b.bsdf.sample(view, choice, u, transport);
            if (!s || s->singular) continue;
            const double p = b.bsdf.density(view, s->direction);
            ASSERT_GT(p, 0.0) << b.name;
            EXPECT_EQ(s->density, p) << b.name;
            const Spectrum expected =
                (std::abs(s->direction.z) / p) * b.bsdf.value(view, s->direction, transport);
            EXPECT_NEAR(s->weight.b, expected.b, 1e-12 * (1.0 + expected.b)) << b.name;
            EXPECT_NEAR(length(s->direction), 1.0, 1e-9) << b.name;
        }
    }
}

TEST(Bsdf, ThereIsADensityWhereThereIsAValue) {
    RandomStream random(4);
    for (const NamedBsdf& b : bsdfs()) {
        for (int i = 0; i < 3000; ++i) {
            const double grazing = i % 3 == 0 ? 1e-3 : 1.0;
            const Vec3 view = view_at(grazing * random.uniform(1e-6, 1), random.uniform(0, 6));
            Vec3 d = any_direction(random);
            if (i % 5 == 0) d = normalize(Vec3{d.x, d.y, 1e-7 * d.z});
            for (const auto transport : {Transport::Radiance, Transport::Importance}) {
                const Spectrum value = b.bsdf.value(view, d, transport);
                ASSERT_TRUE(value.is_finite()) << b.name;
                ASSERT_GE(std::min({value.a, value.b, value.c}), 0.0) << b.name;
                ASSERT_TRUE(value.is_black() || b.bsdf.density(view, d) > 0.0) << b.name;
            }
        }
    }
}

TEST(Bsdf, LobesAreReciprocal) {
    RandomStream random(6);
    auto list = lobes_with_density({0.25, 0.5, 1.0});
    list.push_back({"sheen", bsdf_of_lobe(Sheen{{1, 1, 1, 1}, 0.4})});
    list.push_back({"grooves", bsdf_of_lobe(RoughReflection({0.6, 0.1}, SchlickTerm{}))});
    list.push_back({"matt under a face",
                    bsdf_of_lobe(CoveredMatt({0.8, 0.5, 0.3}, Cover::face(0.2, 0.04, 1.0)))});
    for (const NamedBsdf& b : list) {
        for (int i = 0; i < 500; ++i) {
            const Vec3 v = view_at(random.uniform(0.01, 1), random.uniform(0, 6));
            const Vec3 l = view_at(random.uniform(0.01, 1), random.uniform(0, 6));
            const double there = b.bsdf.value(v, l, Transport::Radiance).b;
            const double back = b.bsdf.value(l, v, Transport::Radiance).b;
            EXPECT_NEAR(there, back, 1e-9 * (1.0 + there)) << b.name;
        }
    }
}

TEST(Bsdf, RefractedRadianceIsReciprocalOverTheSquareOfTheIndex) {
    RandomStream random(7);
    for (const double r : {0.2, 0.5, 1.0}) {
        for (const double index : {1.2, 1.5, 2.4}) {
            const Bsdf above =
                bsdf_of_lobe(RoughDielectric(r * r, 1.0 / index, {1, 1, 1, 1}, {1, 1, 1, 1}));
            const Bsdf below =
                bsdf_of_lobe(RoughDielectric(r * r, index, {1, 1, 1, 1}, {1, 1, 1, 1}));
            for (int i = 0; i < 500; ++i) {
                const Vec3 v = view_at(random.uniform(0.02, 1), random.uniform(0, 6));
                const Vec3 l = -view_at(random.uniform(0.02, 1), random.uniform(0, 6));
                // Seen from below, the frame turned over: x stays, y and z change signs.
                const auto over = [](const Vec3& d) { return Vec3{d.x, -d.y, -d.z}; };
                const double there = above.value(v, l, Transport::Radiance).a;
                const double back = below.value(over(l), over(v), Transport::Radiance).a;
                // f(v <- l) / index_l^2 = f(l <- v) / index_v^2.
                EXPECT_NEAR(there * index * index, back / 1.0, 1e-6 * (1e-3 + back));
                const double adjoint = below.value(over(l), over(v), Transport::Importance).a;
                EXPECT_NEAR(there, adjoint, 1e-6 * (1e-3 + there));
            }
        }
    }
}

TEST(Bsdf, ImportanceIsTheAdjointOfRadianceBelowCovers) {
    RandomStream random(8);
    MetallicRoughness p;
    p.roughness.value = 0.4;
    p.coat.strength.value = 1;
    p.sheen.color.color = {0.5, 0.5, 0.5};
    p.sheen.roughness.value = 0.5;
    Material m;
    m.index.value = 1.5;
    m.metallic_roughness = p;
    const Bsdf bsdf = bsdf_of(m, {}, {}, {});
    for (int i = 0; i < 1000; ++i) {
        const Vec3 v = view_at(random.uniform(0.01, 1), random.uniform(0, 6));
        const Vec3 l = view_at(random.uniform(0.01, 1), random.uniform(0, 6));
        const double there = bsdf.value(v, l, Transport::Radiance).b;
        EXPECT_NEAR(there, bsdf.value(l, v, Transport::Importance).b, 1e-9 * (1.0 + there));
    }
}

TEST(Bsdf, BlendedMaterialsHaveTheMeanOfTheirValues) {
    Material matt, shiny;
    matt.diffuse.color = {0.8, 0.2, 0.2};
    shiny.metallic_roughness = MetallicRoughness{};
    shiny.metallic_roughness->coat.strength.value = 1;
    shiny.metallic_roughness->roughness.value = 0.5;
    const Bsdf a = bsdf_of(matt, {}, {}, {}), b = bsdf_of(shiny, {}, {}, {});
    Bsdf blend;
    blend.add(a, 0.25);
    blend.add(b, 0.5);
    blend.add(b, 0.25);
    EXPECT_EQ(blend.lobe_count(), a.lobe_count() + 2 * b.lobe_count());
    const Vec3 v = view_at(0.7), l = view_at(0.4, 2.0);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(blend.value(v, l, Transport::Radiance)[i],
                    0.25 * a.value(v, l, Transport::Radiance)[i] +
                        0.75 * b.value(v, l, Transport::Radiance)[i],
                    1e-12);
    }
}

/// Queries of a single lobe without its variant give the lobe's own values.
template <class L>
void expect_lobe_alone(const L& lobe, const Spectrum& weight) {
    Bsdf bsdf;
    bsdf.add(weight, lobe);
    RandomStream random(5);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 view = view_at(i == 0 ? 1.0 : random.uniform(0.001, 1));
        const Vec3 direction = any_direction(random);
        const Vec2 u{random.uniform(), random.uniform()};
        const double choice = random.uniform();
        EXPECT_EQ(bsdf.value(view, direction, Transport::Radiance),
                  weight * lobe.value(view, direction, Transport::Radiance));
        EXPECT_EQ(bsdf.density(view, direction), lobe.density(view, direction));
        const auto drawn = bsdf.sample(view, choice, u, Transport::Radiance);
        const auto own = lobe.sample(view, choice, u, Transport::Radiance);
        ASSERT_EQ(drawn.has_value(), own.has_value());
        if (!drawn) continue;
        EXPECT_EQ(drawn->direction, own->direction);
        EXPECT_EQ(drawn->density, lobe.density(view, drawn->direction));
        const Spectrum expected = (std::abs(drawn->direction.z) / drawn->density) *
                                  bsdf.value(view, drawn->direction, Transport::Radiance);
        EXPECT_EQ(drawn->weight, expected);
    }
}

TEST(Bsdf, ALobeAloneIsThatLobe) {
    expect_lobe_alone(Lambert{{0.2, 0.5, 0.7, 0.7}}, {0.9, 0.8, 0.7, 0.7});
    for (const double f0 : {0.04, 0.9, 1.0}) {
        expect_lobe_alone(RoughReflection({0.2, 0.2}, SchlickTerm{{f0, 0.5, 0.1, 0.1}}),
                          {0.9, 0.8, 0.7, 0.7});
    }
    expect_lobe_alone(RoughReflection({0.6, 0.1}, SchlickTerm{}, {0.6, 0.8}), Spectrum::all(1));
    expect_lobe_alone(LambertTransmission{}, Spectrum::all(0.5));
}

TEST(Bsdf, ALobeThatTakesAllLightIsNeverDrawn) {
    for (const Spectrum& color : {Spectrum{}, Spectrum::all(kNan)}) {
        Bsdf bsdf;
        bsdf.add(Spectrum::all(1), Lambert{color});
        EXPECT_FALSE(bsdf.sample(view_at(0.5), 0.5, {0.5, 0.5}, Transport::Radiance));
        EXPECT_EQ(bsdf.density(view_at(0.5), {0, 0, 1}), 0.0);
        EXPECT_EQ(bsdf.value(view_at(0.5), {0, 0, 1}, Transport::Radiance), Spectrum{});
    }
}

TEST(Bsdf, MoreLobesThanItHoldsLeaveOutTheLeast) {
    Bsdf bsdf;
    for (int i = 0; i < 30; ++i) bsdf.add(Spectrum::all(1) * (i == 3 ? 0.001 : 0.03), Lambert{});
    EXPECT_EQ(bsdf.lobe_count(), kMaxLobes);
    EXPECT_NEAR(bsdf.albedo({0, 0, 1}).a, 0.03 * kMaxLobes, 1e-12);
}

TEST(Bsdf, WhatIsNoNumberIsHarmless) {
    MetallicRoughness p;
    p.base_color.color = {kNan, 2.0, -1.0};
    p.roughness.value = kNan;
    p.metallic.value = kNan;
    p.transmission.value = -3;
    p.coat.strength.value = kNan;
    p.sheen.color.color = {kNan, kNan, kNan};
    p.film.strength.value = 1;
    p.film.thickest_nm = kNan;
    p.anisotropy.strength = kNan;
    Material m, whitted;
    m.metallic_roughness = p;
    whitted.diffuse.color = {kNan, 0.5, 7};
    whitted.reflective.color = {-1, kNan, 3};
    whitted.shininess.value = kNan;
    whitted.specular.color = {1, 1, 1};
    RandomStream random(9);
    for (const Material& material : {m, whitted}) {
        const Bsdf bsdf = bsdf_of(material, {}, {}, {});
        for (int i = 0; i < 300; ++i) {
            const Vec3 view = i % 7 == 0 ? Vec3{1, 0, 0} : view_at(random.uniform(0, 1));
            const auto s =
                bsdf.sample(view, random.uniform(), {random.uniform(), 0.5}, Transport::Radiance);
            EXPECT_TRUE(!s || (s->weight.is_finite() && std::isfinite(s->density)));
            EXPECT_TRUE(bsdf.value(view, any_direction(random), Transport::Radiance).is_finite());
            EXPECT_TRUE(bsdf.albedo(view).is_finite());
        }
    }
}

TEST(Bsdf, ChoicesNextToOneStillFindALobe) {
    Bsdf bsdf;
    bsdf.add({0.3, 0.3, 0.3}, Lambert{});
    bsdf.add({0.1, 0.1, 0.1}, Mirror{});
    const double last = std::nextafter(1.0, 0.0);
    ASSERT_TRUE(bsdf.sample(view_at(0.5), last, {last, last}, Transport::Radiance));
    ASSERT_TRUE(bsdf.sample(view_at(0.5), 0.0, {0.0, 0.0}, Transport::Radiance));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
