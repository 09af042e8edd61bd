#include "alhazen/shading/optics/polarization.h"

#include <gtest/gtest.h>

#include "alhazen/math/constants.h"
#include "alhazen/shading/bsdf/polarization.h"
#include "alhazen/shading/optics/fresnel.h"
#include "alhazen/shading/optics/metals.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr double kDegree = kPi / 180.0;

TEST(Polarization, AmplitudesHaveTheReflectancesOfUnpolarisedLight) {
    const Metal& gold = *find_metal("gold");
    for (int i = 0; i <= 90; ++i) {
        const double c = std::cos(i * kDegree);
        for (const double eta : {1.0 / 2.42, 1.0 / 1.5, 0.9, 1.1, 1.5, 2.42}) {
            const FresnelAmplitudes r = dielectric_reflection(c, eta);
            EXPECT_NEAR(0.5 * (std::norm(r.across) + std::norm(r.along)),
                        dielectric_reflectance(c, eta), 1e-13);
        }
        const FresnelAmplitudes r = conductor_reflection(c, gold.index.r, gold.extinction.r);
        EXPECT_NEAR(0.5 * (std::norm(r.across) + std::norm(r.along)),
                    conductor_reflectance(c, gold.index.r, gold.extinction.r), 1e-12);
    }
}

TEST(Polarization, WhatIsNotReflectedIsRefractedOfBothPlanes) {
    for (const double eta : {1.0 / 1.5, 1.0 / 1.1, 1.2}) {
        for (const double c : {1.0, 0.9, 0.75, 0.6}) {
            double behind = 0;
            (void)dielectric_reflectance(c, eta, behind);
            const FresnelAmplitudes r = dielectric_reflection(c, eta);
            const FresnelAmplitudes t = dielectric_refraction(c, eta);
            const double beam = behind / (eta * c);
            EXPECT_NEAR(std::norm(r.across) + beam * std::norm(t.across), 1.0, 1e-14);
            EXPECT_NEAR(std::norm(r.along) + beam * std::norm(t.along), 1.0, 1e-14);
        }
    }
}

TEST(Polarization, AtBrewstersAngleReflectedLightIsWhollyPolarised) {
    for (const double n : {1.2, 1.5, 2.42}) {
        const BoundaryMueller m = mueller_of(dielectric_reflection(std::cos(std::atan(n)), 1 / n));
        EXPECT_NEAR(m.q, 1.0, 1e-14);
        EXPECT_NEAR(m.c, 0.0, 1e-7);
        EXPECT_NEAR(m.e, 0.0, 1e-7);
    }
}

TEST(Polarization, TotalReflectionShiftsThePhaseAsInClosedForm) {
    const double n = 1.51;
    for (const double degrees : {42.0, 48.6, 54.6, 70.0, 89.0}) {
        const double s = std::sin(degrees * kDegree), c = std::cos(degrees * kDegree);
        const FresnelAmplitudes r = dielectric_reflection(c, n);
        EXPECT_NEAR(std::norm(r.across), 1.0, 1e-14);
        EXPECT_NEAR(std::norm(r.along), 1.0, 1e-14);
        // Born and Wolf, section 1.5, equation 60.
        const double expected = 2.0 * std::atan(c * std::sqrt(s * s - 1.0 / (n * n)) / (s * s));
        EXPECT_NEAR(std::arg(r.across * std::conj(r.along)), expected, 1e-12) << degrees;
        if (degrees == 54.6) {
            EXPECT_NEAR(expected / kDegree, 45.0, 0.03);
        }
    }
}

TEST(Polarization, AMetalShiftsThePhaseAsItsEllipsometricRatioSays) {
    for (const char* name : {"gold", "silver", "iron"}) {
        const Metal& metal = *find_metal(name);
        for (int i = 0; i < 3; ++i) {
            const std::complex<double> index(metal.index[i], metal.extinction[i]);
            for (const double degrees : {0.0, 20.0, 45.0, 70.0, 88.0}) {
                const double s = std::sin(degrees * kDegree), c = std::cos(degrees * kDegree);
                const FresnelAmplitudes r =
                    conductor_reflection(c, metal.index[i], metal.extinction[i]);
                const std::complex<double> w = std::sqrt(index * index - s * s);
                const double st = s * s / c;
                EXPECT_LT(std::abs(r.along / r.across + (w - st) / (w + st)), 1e-12) << name;
            }
        }
    }
}

TEST(Polarization, MatricesKeepDegreesAtMostOne) {
    const auto largest = [](const BoundaryMueller& m) {
        // Light that is wholly polarised along the axes and between them, and circular light.
        return std::max({std::abs(m.q + m.d) / (1.0 + m.q), std::hypot(m.q, m.c, m.e)});
    };
    for (int i = 0; i <= 90; ++i) {
        const double c = std::cos(i * kDegree);
        for (const double eta : {0.4, 1.0 / 1.5, 1.0, 1.5}) {
            EXPECT_LE(largest(mueller_of(dielectric_reflection(c, eta))), 1.0 + 1e-12);
            EXPECT_LE(largest(mueller_of(dielectric_refraction(c, eta))), 1.0 + 1e-12);
        }
        EXPECT_LE(largest(mueller_of(conductor_reflection(c, 0.2, 3.0))), 1.0 + 1e-12);
    }
}

TEST(Polarization, ASingleFacetOfARoughMetalIsAMirrorAcrossTheHalfVector) {
    const ConductorTerm metal{{0.2, 0.4, 1.4, 1.4}, {3.0, 2.4, 1.6, 1.6}};
    const Lobe lobe = RoughReflection({0.01, 0.01}, metal);
    const Vec3 view = normalize(Vec3{0.8, 0.1, 0.6}), direction = normalize(Vec3{-0.8, -0.1, 0.61});
    const PolarizedValue value = polarized_value(lobe, view, direction);
    const double cosine = dot(view, normalize(view + direction));
    for (int i = 0; i < Spectrum::kCount; ++i) {
        EXPECT_NEAR(value.part[i] / value.all[i], 1.0, 1e-3);
        const BoundaryMueller m =
            mueller_of(conductor_reflection(cosine, metal.index[i], metal.extinction[i]));
        EXPECT_NEAR(value.matrix.q[i], m.q, 1e-12);
        EXPECT_NEAR(value.matrix.e[i], m.e, 1e-12);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
