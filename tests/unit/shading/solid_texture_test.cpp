#include "alhazen/shading/textures/solid_texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// The mean of point lookups over the aperture, on a fine grid.
double by_points(const SolidTexture& t, const SolidAperture& at, int side = 700) {
    double sum = 0;
    int count = 0;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const double u = 2 * (i + 0.5) / side - 1, v = 2 * (j + 0.5) / side - 1;
            if (u * u + v * v >= 1) continue;
            sum += evaluate(t, {at.point + u * at.a + v * at.b, {}, {}}).r;
            ++count;
        }
    }
    return sum / count;
}

SolidTexture pattern(SolidTexture::Kind kind) {
    SolidTexture t;
    t.kind = kind;
    return t;
}

TEST(SolidTexture, ChecksAreCubesFromTheOrigin) {
    SolidTexture t = pattern(SolidTexture::Kind::Checks);
    t.origin = {0.1, 0, 0};
    t.size = 2;
    EXPECT_EQ(evaluate(t, {{1, 1, 1}, {}, {}}), t.color);
    EXPECT_EQ(evaluate(t, {{2.2, 1, 1}, {}, {}}), t.other);
    EXPECT_EQ(evaluate(t, {{2.2, 2.2, 1}, {}, {}}), t.color);
    EXPECT_EQ(evaluate(t, {{-0.5, 1, 1}, {}, {}}), t.other);
}

TEST(SolidTexture, ChecksOverAnApertureAreTheMeanOfTheirPoints) {
    const SolidTexture t = pattern(SolidTexture::Kind::Checks);
    RandomStream random(3);
    const auto vector = [&](double size) {
        return Vec3{random.uniform(-size, size), random.uniform(-size, size),
                    random.uniform(-size, size)};
    };
    for (int k = 0; k < 30; ++k) {
        // On a floor, then tilted in space; few cells are exact, many by chords.
        const double size = k % 3 == 0 ? 0.3 : k % 3 == 1 ? 1.2 : 4.0;
        SolidAperture at{vector(5), vector(size), vector(size)};
        const bool floor = k % 2 == 0;
        if (floor) at.a.z = at.b.z = 0, at.point.z = 0.5;
        const double exact = floor && k % 3 == 0 ? 2e-3 : 0.02;
        EXPECT_NEAR(evaluate(t, at).r, by_points(t, at), exact) << k;
    }
}

TEST(SolidTexture, StripesOverAnApertureAreTheirIntegral) {
    SolidTexture t = pattern(SolidTexture::Kind::Stripes);
    t.direction = {1, 2, 0.5};
    t.size = 0.7;
    RandomStream random(4);
    for (int k = 0; k < 12; ++k) {
        const double size = random.uniform(0.05, 3);
        const SolidAperture at{{random.uniform(-9, 9), 0, 0}, {size, 0.2, 0}, {0, 0.5 * size, 1}};
        EXPECT_NEAR(evaluate(t, at).r, by_points(t, at), 2e-3) << k;
    }
}

TEST(SolidTexture, WavesFadeByTheTransformOfTheDisc) {
    SolidTexture t = pattern(SolidTexture::Kind::Marble);
    t.turbulence = 0;
    t.direction = {1, 0, 0};
    for (const double size : {0.2, 0.7, 1.5}) {
        const SolidAperture at{{0.4, 0, 0}, {size, 0, 0}, {0, size, 0}};
        EXPECT_NEAR(evaluate(t, at).r, by_points(t, at), 1e-3) << size;
    }
}

TEST(SolidTexture, LargeAperturesSeeTheMean) {
    using Kind = SolidTexture::Kind;
    for (const Kind kind : {Kind::Checks, Kind::Stripes, Kind::Noise, Kind::Marble, Kind::Wood}) {
        const SolidAperture far{{0.3, 40.2, 0.4}, {900.3, 31, 7}, {-20, 411, 0.7}};
        EXPECT_NEAR(evaluate(pattern(kind), far).r, 0.5, 0.02) << int(kind);
    }
}

TEST(SolidTexture, NoiseIsSmoothAndItsOctavesFadeWithTheAperture) {
    EXPECT_EQ(gradient_noise({3, -7, 12}), 0.0);
    RandomStream random(8);
    double largest = 0, jump = 0;
    for (int k = 0; k < 20000; ++k) {
        const Vec3 p{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
        largest = std::max(largest, std::abs(gradient_noise(p)));
        jump = std::max(jump, std::abs(gradient_noise(p + Vec3{1e-6, 0, 0}) - gradient_noise(p)));
    }
    EXPECT_LT(largest, 1.1);
    EXPECT_GT(largest, 0.5);
    EXPECT_LT(jump, 1e-5);
    const SolidTexture t = pattern(SolidTexture::Kind::Noise);
    double sharp = 0, blurred = 0;
    for (int k = 0; k < 2000; ++k) {
        const Vec3 p{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
        sharp += std::abs(evaluate(t, {p, {}, {}}).r - 0.5);
        blurred += std::abs(evaluate(t, {p, {0.3, 0, 0}, {0, 0.3, 0}}).r - 0.5);
    }
    EXPECT_LT(blurred, 0.6 * sharp);
    EXPECT_GT(blurred, 0.05 * sharp);
}

TEST(SolidTexture, AnApertureOfMillionsOfChecksIsGreyAndTakesNoTime) {
    for (const double wide : {30.0, 1e3, 1e6, 1e8}) {
        for (const double narrow : {0.3, wide}) {
            const Rgba seen = evaluate(pattern(SolidTexture::Kind::Checks),
                                       {{0.3, 0.4, 0.5}, {wide, 0.1 * wide, 0}, {0, narrow, 0}});
            const Rgba one = pattern(SolidTexture::Kind::Checks).color;
            const Rgba other = pattern(SolidTexture::Kind::Checks).other;
            EXPECT_NEAR(seen.r, 0.5 * (one.r + other.r), 0.05) << wide << " " << narrow;
        }
    }
}

TEST(SolidTexture, WhatIsNoNumberIsHarmless) {
    using Kind = SolidTexture::Kind;
    const double nan = std::nan("");
    for (const Kind kind : {Kind::Checks, Kind::Stripes, Kind::Noise, Kind::Marble, Kind::Wood}) {
        for (const Vec3& p : {Vec3{nan, 0, 0}, Vec3{1e300, 0, 0}, Vec3{0, -HUGE_VAL, 0}}) {
            EXPECT_TRUE(evaluate(pattern(kind), {p, {}, {}}).is_finite()) << int(kind);
            EXPECT_TRUE(evaluate(pattern(kind), {{}, p, {0, 1, 0}}).is_finite()) << int(kind);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
