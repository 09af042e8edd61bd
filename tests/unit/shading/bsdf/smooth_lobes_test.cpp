#include <gtest/gtest.h>

#include "alhazen/shading/bsdf/bsdf.h"
#include "alhazen/shading/optics/fresnel.h"
#include "support/bsdf_checks.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

TEST(SmoothLobes, AMirrorSendsLightBackAtTheSameAngle) {
    const Bsdf bsdf = bsdf_of_lobe(Mirror{}, {0.9, 0.8, 0.7, 0.7});
    const Vec3 view = view_at(0.3);
    const auto s = bsdf.sample(view, 0.4, {0.1, 0.9}, Transport::Radiance);
    ASSERT_TRUE(s && s->singular);
    EXPECT_EQ(s->direction, (Vec3{-view.x, -view.y, view.z}));
    EXPECT_EQ(s->weight, (Spectrum{0.9, 0.8, 0.7, 0.7}));
    EXPECT_EQ(s->density, 1.0);
    EXPECT_FALSE(bsdf.has_density());
    EXPECT_TRUE(bsdf.value(view, s->direction, Transport::Radiance).is_black());
    EXPECT_EQ(bsdf.density(view, s->direction), 0.0);
}

TEST(SmoothLobes, RefractionObeysSnellAndRadianceGrowsByTheSquareOfTheIndex) {
    const double index = 1.5;
    const Vec3 view = view_at(std::cos(0.7));
    const Bsdf bsdf = bsdf_of_lobe(SmoothDielectric{.eta = 1.0 / index});
    const double r = dielectric_reflectance(view.z, 1.0 / index);
    const auto s = bsdf.sample(view, 0.999, {}, Transport::Radiance);
    ASSERT_TRUE(s && s->singular && s->direction.z < 0.0);
    EXPECT_NEAR(std::hypot(s->direction.x, s->direction.y), std::sin(0.7) / index, 1e-14);
    EXPECT_NEAR(length(s->direction), 1.0, 1e-14);
    EXPECT_EQ(s->eta, index);
    EXPECT_NEAR(s->density, 1.0 - r, 1e-14);
    // Radiance from glass is seen in air over the square of the index.
    EXPECT_NEAR(s->weight.a, 1.0 / (index * index), 1e-14);
    const auto light = bsdf.sample(view, 0.999, {}, Transport::Importance);
    EXPECT_NEAR(light->weight.a, 1.0, 1e-14);
    const auto back = bsdf_of_lobe(SmoothDielectric{.eta = index})
                          .sample(view_at(-s->direction.z), 0.999, {}, Transport::Radiance);
    EXPECT_NEAR(back->direction.z, -view.z, 1e-14);
    EXPECT_NEAR(back->weight.a, index * index, 1e-13);
}

TEST(SmoothLobes, ReflectedAndRefractedLightAreAll) {
    for (const double eta : {1 / 2.4, 1 / 1.33, 1.0, 1.33, 2.4}) {
        const Bsdf bsdf = bsdf_of_lobe(SmoothDielectric{.eta = eta});
        for (double cosine = 0.01; cosine < 1.0; cosine += 0.07) {
            EXPECT_NEAR(furnace(bsdf, view_at(cosine), 4096).a, 1.0, 1e-12) << eta << cosine;
        }
    }
}

TEST(SmoothLobes, SingularLightIsWhatSamplesGiveWithoutAChoice) {
    Bsdf bsdf;
    bsdf.add({0.2, 0.3, 0.4, 0.4}, Lambert{});
    bsdf.add({0.5, 0.4, 0.3, 0.3}, Mirror{});
    bsdf.add({0.9, 0.8, 0.7, 0.7}, SmoothDielectric{.eta = 1 / 1.5});
    for (const Transport transport : {Transport::Radiance, Transport::Importance}) {
        const Vec3 view = view_at(0.4);
        const SingularLight light = bsdf.singular(view, transport);
        EXPECT_EQ(light.eta, 1 / 1.5);
        Spectrum reflected, transmitted;
        constexpr int kChoices = 20000;
        for (int i = 0; i < kChoices; ++i) {
            const auto s = bsdf.sample(view, (i + 0.5) / kChoices, {0.5, 0.5}, transport);
            if (!s || !s->singular) continue;
            (s->direction.z < 0.0 ? transmitted : reflected) += (1.0 / kChoices) * s->weight;
        }
        for (int k = 0; k < Spectrum::kCount; ++k) {
            EXPECT_NEAR(reflected[k], light.reflected[k], 1e-3);
            EXPECT_NEAR(transmitted[k], light.transmitted[k], 1e-3);
        }
    }
}

TEST(SmoothLobes, BeyondTheCriticalAngleNothingPasses) {
    const double index = 1.52;
    const Vec3 view = view_at(std::cos(std::asin(1.0 / index) + 1e-6));
    for (const bool fresnel : {true, false}) {
        const Bsdf bsdf = bsdf_of_lobe(SmoothDielectric{.eta = index, .fresnel = fresnel});
        for (const double choice : {0.0, 0.5, 0.999}) {
            const auto s = bsdf.sample(view, choice, {}, Transport::Radiance);
            ASSERT_TRUE(s);
            EXPECT_GT(s->direction.z, 0.0);
            EXPECT_NEAR(s->weight.b, 1.0, 1e-14);
        }
    }
}

TEST(SmoothLobes, WhittedsRefractionReflectsNothingBelowTheCriticalAngle) {
    const Bsdf bsdf = bsdf_of_lobe(SmoothDielectric{.eta = 1 / 1.5, .fresnel = false});
    for (const double choice : {0.0, 0.999}) {
        const auto s = bsdf.sample(view_at(0.2), choice, {}, Transport::Importance);
        ASSERT_TRUE(s);
        EXPECT_LT(s->direction.z, 0.0);
        EXPECT_NEAR(s->weight.a, 1.0, 1e-14);
    }
}

TEST(SmoothLobes, AThinSheetLetsLightGoStraightOn) {
    const Bsdf bsdf = bsdf_of_lobe(ThinSheet{{0.5, 0.6, 0.7, 0.7}});
    const Vec3 view = view_at(0.3);
    const auto s = bsdf.sample(view, 0.2, {}, Transport::Radiance);
    ASSERT_TRUE(s && s->singular);
    EXPECT_EQ(s->direction, -view);
    EXPECT_EQ(s->weight, (Spectrum{0.5, 0.6, 0.7, 0.7}));
    EXPECT_FALSE(bsdf.transmits());
}

TEST(SmoothLobes, AConductorReflectsByItsIndices) {
    const ConductorTerm gold{{0.222, 0.428, 1.334}, {3.208, 2.461, 1.872}};
    const Bsdf bsdf = bsdf_of_lobe(Mirror{gold});
    const auto s = bsdf.sample(view_at(0.4), 0.5, {}, Transport::Radiance);
    ASSERT_TRUE(s);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(s->weight[i], conductor_reflectance(0.4, gold.index[i], gold.extinction[i]),
                    1e-14);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
