#include "alhazen/shading/microfacets/anisotropic_split.h"

#include <gtest/gtest.h>

#include "alhazen/shading/microfacets/anisotropic_albedo.h"
#include "alhazen/shading/microfacets/ggx_albedo.h"
#include "alhazen/shading/optics/fresnel.h"
#include "support/bsdf_checks.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

constexpr double kCosines[] = {0.01, 0.03, 0.1, 0.33, 0.52, 0.71, 0.88, 0.97, 0.999, 1.0};
constexpr double kTurns[] = {0.0, 0.02, 0.3, 0.8, 1.2, 1.55, 0.5 * kPi};
constexpr Ggx kPairs[] = {{0.0025, 1},   {0.81, 0.01}, {0.6, 0.05},     {0.05, 0.3}, {1, 0.3},
                          {0.04, 0.035}, {0.9, 0.9},   {0.0055, 0.006}, {0.2, 0.01}, {0.01, 0.5}};

TEST(AnisotropicSplit, IsItsIntegral) {
    double squares = 0;
    int count = 0;
    for (const Ggx& ggx : kPairs) {
        for (const double mu : kCosines) {
            for (const double turn : kTurns) {
                const Vec3 view = view_at(mu, turn);
                const SplitAlbedo found = anisotropic_split_albedo(view, ggx);
                const SplitAlbedo exact = integrate_anisotropic_split_albedo(view, ggx);
                const double error = found.at_f90 - exact.at_f90;
                ASSERT_NEAR(error, 0.0, 3e-3) << ggx.x << " " << ggx.y << " " << mu << " " << turn;
                EXPECT_DOUBLE_EQ(found.sum(), anisotropic_albedo(view, ggx));
                squares += error * error;
                ++count;
            }
        }
    }
    EXPECT_LT(std::sqrt(squares / count), 3e-4);
}

TEST(AnisotropicSplit, OfEqualAlphasIsThatOfTheIsotropicSurface) {
    for (const double alpha : {0.0025, 0.01, 0.05, 0.2, 0.5, 1.0}) {
        for (const double mu : kCosines) {
            for (const double turn : kTurns) {
                EXPECT_NEAR(
                    integrate_anisotropic_split_albedo(view_at(mu, turn), {alpha, alpha}).at_f90,
                    integrate_ggx_albedo(mu, alpha).at_f90, 3e-4)
                    << alpha << " " << mu << " " << turn;
            }
        }
        EXPECT_NEAR(mean_anisotropic_split_albedo({alpha, alpha}).at_f90,
                    ggx_mean_albedo(alpha).at_f90, 1e-4)
            << alpha;
    }
}

TEST(AnisotropicSplit, IsTheShareThatSamplesOfVisibleNormalsReflect) {
    constexpr int kSamples = 1 << 16;
    for (const Ggx& ggx : {Ggx{0.0025, 1}, Ggx{0.6, 0.05}, Ggx{1, 0.3}}) {
        for (const double mu : {0.05, 0.4, 1.0}) {
            const Vec3 view = view_at(mu, 1.1);
            double sum = 0;
            for (int i = 0; i < kSamples; ++i) {
                const auto u = [&](int d) {
                    return scrambled_sobol(7, static_cast<std::uint32_t>(i), d);
                };
                const Vec3 m = ggx.sample_visible(view, {u(0), u(1)});
                const Vec3 l = mirrored(view, m);
                if (!(l.z > 0.0)) continue;
                sum += schlick_weight(dot(view, m)) * ggx.shadowing(view, l) / kSamples;
            }
            EXPECT_NEAR(integrate_anisotropic_split_albedo(view, ggx).at_f90, sum, 3e-4)
                << ggx.x << " " << mu;
        }
    }
}

TEST(AnisotropicSplit, IsSymmetric) {
    for (const double turn : kTurns) {
        const Vec3 v = view_at(0.3, turn);
        const double there = anisotropic_split_albedo(v, {0.7, 0.1}).at_f90;
        for (const double x : {-1.0, 1.0}) {
            for (const double y : {-1.0, 1.0}) {
                EXPECT_EQ(anisotropic_split_albedo({x * v.x, y * v.y, v.z}, {0.7, 0.1}).at_f90,
                          there);
                EXPECT_EQ(anisotropic_split_albedo({y * v.y, x * v.x, v.z}, {0.1, 0.7}).at_f90,
                          there);
            }
        }
    }
}

TEST(AnisotropicSplit, MeanIsThatOfTheViews) {
    for (const Ggx& ggx : kPairs) {
        constexpr int kSide = 60;
        double sum = 0;
        for (int i = 0; i < kSide * kSide; ++i) {
            const double x = (i % kSide + 0.5) / kSide;
            const double turn = 0.5 * kPi * (i / kSide + 0.5) / kSide;
            sum += 4.0 * x * x * x / (kSide * kSide) *
                   anisotropic_split_albedo(view_at(x * x, turn), ggx).at_f90;
        }
        EXPECT_NEAR(mean_anisotropic_split_albedo(ggx).at_f90, sum, 1e-4) << ggx.x << " " << ggx.y;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
