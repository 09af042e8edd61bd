#include "alhazen/shading/lights/ies_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/illumination/illumination.h"
#include "support/light_checks.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

std::string file(const std::string& horizontals, const std::string& candela,
                 const std::string& counts = "3 1") {
    return "IESNA:LM-63-2002\r\n[TEST] made up\r\n[MANUFAC] none\r\nTILT=NONE\r\n1 1000 2.0 " +
           counts + " 1 2 0 0 0\r\n1.0 1.0 100\r\n0 90 180\r\n" + horizontals + "\r\n" + candela +
           "\r\n";
}

TEST(IesProfile, CandelaAreInterpolatedInBothAngles) {
    const IesProfile p(file("0 90", "10 20 30\n50 60 70", "3 2"), "test");
    EXPECT_DOUBLE_EQ(p.candela(0, 0), 20.0);  // times the multiplier of 2
    EXPECT_NEAR(p.candela(kPi / 4, 0), 30.0, 1e-12);
    EXPECT_NEAR(p.candela(kPi / 2, kPi / 4), 80.0, 1e-12);
    // By quadrants: 0, 180 and 90, 270 are alike.
    EXPECT_NEAR(p.candela(kPi / 2, kPi), 40.0, 1e-12);
    EXPECT_NEAR(p.candela(kPi / 2, 1.5 * kPi), 120.0, 1e-12);
    EXPECT_NEAR(p.candela(kPi / 2, -kPi / 4), 80.0, 1e-12);
    EXPECT_EQ(p.largest_candela(), 140.0);
}

TEST(IesProfile, AnEvenLampHasTheLumensOfItsCandela) {
    const IesProfile p(file("0", "50 50 50"), "test");
    EXPECT_NEAR(p.lumens(), 4.0 * kPi * 100.0, 1e-6 * p.lumens());
}

TEST(IesProfile, WhatIsWrongIsSaid) {
    const auto message = [](const std::string& text) {
        try {
            const IesProfile p(text, "lamp.ies");
            return std::string("read");
        } catch (const Error& error) {
            return std::string(error.what());
        }
    };
    EXPECT_NE(message("").find("TILT="), std::string::npos);
    EXPECT_NE(message("hello\nworld\n").find("TILT="), std::string::npos);
    EXPECT_NE(message(file("0", "50 50")).find("candela"), std::string::npos);
    EXPECT_NE(message(file("0", "50 50 -1")).find("candela"), std::string::npos);
    EXPECT_NE(message(file("0", "1 1 1", "99999999 1")).find("vertical"), std::string::npos);
    EXPECT_NE(message(file("90 0", "1 1 1 1 1 1", "3 2")).find("ascend"), std::string::npos);
    EXPECT_NE(message("TILT=NONE\n1 1 1 4096 4096 1 1 0 0 0").find("hold"), std::string::npos);
    EXPECT_NE(message("TILT=NONE\n1 1 1 2 1 2 1 0 0 0").find("type C"), std::string::npos);
    EXPECT_NE(message("TILT=NONE\n1 x").find("lumens"), std::string::npos);
}

TEST(IesProfile, ALightWithOneSendsItsLumens) {
    SceneMaker maker;
    PointLight light;
    light.position = {0, 0, 2};
    light.attenuation = {0, 0, 1};
    light.profile.profile = std::make_shared<const IesProfile>(file("0", "300 200 0"), "test");
    maker.light(light);
    maker.add(Sphere{{0, 0, -5}, 1});
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    // Below: straight down.
    const LightDraw draw =
        lights.draw({{0, 0, 0}, {0, 0, 1}, false}, 0.3, {0.5, 0.5}, kColorChannels);
    EXPECT_NEAR(draw.radiance.b / draw.density, 600.0 / kLumensPerWatt / 4.0, 1e-12);
    RandomStream random(1);
    double watts = 0.0;
    constexpr int kRays = 40000;
    for (int i = 0; i < kRays; ++i) {
        const double u = (i + 0.5) / kRays, v = random.uniform();
        const LightRay out = lights.emit(random.uniform(), {0.5, 0.5}, {u, v}, kColorChannels);
        ASSERT_TRUE(out.singular_place);
        watts += out.radiance.b / (out.place_density * out.direction_density) / kRays;
    }
    const double lumens = light.profile.profile->lumens();
    EXPECT_NEAR(watts * kLumensPerWatt / lumens, 1.0, 1e-3);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
