#include "alhazen/shading/lights/ies_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

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

TEST(IesProfile, AnglesAllRoundAreInterpolatedAcrossZero) {
    const IesProfile p(file("20 140 340", "10 10 10\n50 50 50\n30 30 30", "3 3"), "test");
    const auto at = [&](double degrees) { return p.candela(1.0, degrees * kRadiansPerDegree); };
    EXPECT_NEAR(at(340), 60.0, 1e-12);
    EXPECT_NEAR(at(350), 50.0, 1e-9);
    EXPECT_NEAR(at(0), 40.0, 1e-9);
    EXPECT_NEAR(at(10), 30.0, 1e-9);
    EXPECT_NEAR(at(-10), 50.0, 1e-9);
    EXPECT_NEAR(at(20), 20.0, 1e-12);
    EXPECT_NEAR(at(80), 60.0, 1e-12);
    // Measured from within 90 to 270: the outermost values hold beyond, by symmetry.
    const IesProfile half(file("100 260", "10 10 10\n50 50 50", "3 2"), "test");
    EXPECT_NEAR(half.candela(1.0, kPi / 2), 20.0, 1e-12);
    EXPECT_NEAR(half.candela(1.0, 1.5 * kPi), 100.0, 1e-12);
}

TEST(IesProfile, AnEvenLampHasTheLumensOfItsCandela) {
    const IesProfile p(file("0", "50 50 50"), "test");
    EXPECT_NEAR(p.lumens(), 4.0 * kPi * 100.0, 1e-6 * p.lumens());
}

/// The integral of the profile's candela over all directions, interval by interval.
double summed_lumens(const IesProfile& p, std::vector<double> angles, int columns) {
    constexpr int kSteps = 400;
    double sum = 0.0;
    for (double& angle : angles) angle *= kRadiansPerDegree;
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
        const double width = (angles[i + 1] - angles[i]) / kSteps;
        for (int step = 0; step < kSteps; ++step) {
            const double vertical = angles[i] + (step + 0.5) * width;
            double around = 0.0;
            for (int j = 0; j < columns; ++j) {
                around += p.candela(vertical, 2.0 * kPi * (j + 0.5) / columns);
            }
            sum += 2.0 * kPi * around / columns * width * std::sin(vertical);
        }
    }
    return sum;
}

TEST(IesProfile, LumensOfNarrowLobesAreWhole) {
    for (const double w : {1e-5, 0.01, 0.05, 0.1, 1.0, 10.0, 40.0}) {
        const std::string text = "IESNA:LM-63-2002\nTILT=NONE\n1 1 1 4 1 1 2 0 0 0 1 1 1\n0 " +
                                 std::to_string(w) + " " + std::to_string(2 * w) +
                                 " 90\n0\n1e5 1e5 0 0\n";
        const IesProfile p(text, "test");
        const double expected = summed_lumens(p, {0, w, 2 * w, 90}, 1);
        EXPECT_NEAR(p.lumens() / expected, 1.0, 1e-5) << w;
    }
}

TEST(IesProfile, LumensAreThoseOfTheCandelaInEverySymmetry) {
    for (const char* horizontals :
         {"0 10 90", "0 40 180", "0 100 360", "90 130 270", "0 100 300", "20 100 300"}) {
        const IesProfile p(file(horizontals, "10 20 30\n50 90 70\n20 0 5", "3 3"), "test");
        const double expected = summed_lumens(p, {0, 90, 180}, 36);
        EXPECT_NEAR(p.lumens() / expected, 1.0, 1e-5) << horizontals;
    }
    // Angles beyond the sphere have no part in it.
    const IesProfile beyond(
        "IESNA:LM-63-2002\nTILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n-90 270\n0\n10 10\n", "test");
    EXPECT_NEAR(beyond.lumens(), 40.0 * kPi, 1e-12);
}

TEST(IesProfile, ThePhotometricFactorCountsBefore1995) {
    const auto candela = [](const std::string& head) {
        return IesProfile(head + "TILT=NONE\n1 1 1 2 1 1 2 0 0 0\n0.5 0.25 100\n0 90\n0\n80 80\n",
                          "test")
            .candela(0, 0);
    };
    EXPECT_EQ(candela(""), 10.0);
    EXPECT_EQ(candela("a luminaire of 1986\n"), 10.0);
    EXPECT_EQ(candela("IESNA91\n[TEST] x\n"), 10.0);
    EXPECT_EQ(candela("IESNA:LM-63-1995\n[TEST] x\n"), 40.0);
    EXPECT_EQ(candela("IESNA:LM-63-2002\n[TEST] x\n"), 40.0);
    EXPECT_EQ(candela("IES:LM-63-2019\n[TEST] x\n"), 40.0);
    EXPECT_EQ(candela("\nIESNA LM-63-1995\n[TEST] x\n"), 40.0);
    EXPECT_EQ(candela("IESNA:LM-63-1986\n[TEST] x\n"), candela("IESNA91\n[TEST] x\n"));
}

TEST(IesProfile, TheLineOfTheTiltMayHaveBlanks) {
    const auto read = [](const std::string& tilt) {
        return IesProfile("IESNA91\n" + tilt + "\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n80 80\n",
                          "test");
    };
    const std::string factors = "\n1\n3\n0 45 90\n1 .9 .5";
    EXPECT_EQ(read("TILT = NONE \t").ignored_tilt(), "");
    EXPECT_EQ(read("TILT=none").ignored_tilt(), "");
    EXPECT_EQ(read("TILT=Include\n" + factors).ignored_tilt(), "Include");
    EXPECT_EQ(read("TILT=INCLUDE\t" + factors).ignored_tilt(), "INCLUDE");
    EXPECT_EQ(read(" TILT\t=  INCLUDE\r" + factors).candela(0, 0), 80.0);
    EXPECT_EQ(read("TILT=INCLUDE\n1\n2\n0 90\n1 1").ignored_tilt(), "");
    EXPECT_EQ(read("TILTED LAMP = 5\nTILT=lamp.tlt").ignored_tilt(), "lamp.tlt");
}

TEST(IesProfile, FaultsNameTheirLine) {
    const auto line_of = [](const std::string& text) {
        try {
            (void)IesProfile(text, "lamp.ies");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string head = "IESNA91\nTILT=NONE\n";
    EXPECT_EQ(line_of("IESNA91\n").find("lamp.ies:1: "), 0u);
    EXPECT_EQ(line_of(head + "1 1 x\n").find("lamp.ies:3: "), 0u);
    EXPECT_EQ(line_of(head + "1 1 1\n2 1 1 2 0 0 0 1 1 1\n\n0 90\n0 0\n").find("lamp.ies:8: "), 0u);
    EXPECT_EQ(line_of(head + "1 1 1 2 1 1 2 0 0 0 1 1 1\n90 0").find("lamp.ies:4: "), 0u);
}

TEST(IesProfile, TellsOfTextBehindTheLastValue) {
    const auto read = [](const std::string& rest) {
        return IesProfile("IESNA91\nTILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n80 80" + rest,
                          "lamp.ies");
    };
    EXPECT_EQ(read("").line_of_surplus(), 0);
    EXPECT_EQ(read(" \r\n\n").line_of_surplus(), 0);
    EXPECT_EQ(read("\n\x1a").line_of_surplus(), 0);
    EXPECT_EQ(read(" 70").line_of_surplus(), 6);
    EXPECT_EQ(read("\n\n70 70\n").line_of_surplus(), 8);
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
