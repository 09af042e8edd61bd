#include "alhazen/shading/microfacets/anisotropic_albedo.h"

#include <gtest/gtest.h>

#include "alhazen/shading/microfacets/ggx_albedo.h"
#include "support/bsdf_checks.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

constexpr double kRoughnesses[] = {0.05, 0.1, 0.21, 0.34, 0.47, 0.62, 0.79, 1.0};
constexpr double kStrengths[] = {0.0, 0.03, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0};
constexpr double kCosines[] = {0.01, 0.03, 0.1, 0.33, 0.52, 0.71, 0.88, 0.97, 0.999, 1.0};
constexpr double kTurns[] = {0.0, 0.02, 0.3, 0.8, 1.2, 1.55, 0.5 * kPi};

/// The alphas of glTF's model.
Ggx grooves(double roughness, double strength) {
    const double alpha = roughness * roughness;
    return {alpha + (1.0 - alpha) * strength * strength, alpha};
}

TEST(AnisotropicAlbedo, IsItsIntegral) {
    for (const double r : kRoughnesses) {
        for (const double strength : kStrengths) {
            for (const double mu : kCosines) {
                for (const double turn : kTurns) {
                    const Vec3 view = view_at(mu, turn);
                    const Ggx ggx = grooves(r, strength);
                    ASSERT_NEAR(anisotropic_albedo(view, ggx),
                                integrate_anisotropic_albedo(view, ggx), 5e-4)
                        << r << " " << strength << " " << mu << " " << turn;
                }
            }
        }
    }
}

TEST(AnisotropicAlbedo, OfEqualAlphasIsThatOfTheIsotropicSurface) {
    for (const double r : kRoughnesses) {
        for (const double mu : kCosines) {
            for (const double turn : kTurns) {
                const double alpha = r * r;
                EXPECT_NEAR(integrate_anisotropic_albedo(view_at(mu, turn), {alpha, alpha}),
                            integrate_ggx_albedo(mu, alpha).sum(), 3e-4)
                    << r << " " << mu << " " << turn;
            }
            EXPECT_NEAR(mean_anisotropic_albedo({r * r, r * r}), ggx_mean_albedo(r * r).sum(), 3e-4)
                << r;
        }
    }
}

TEST(AnisotropicAlbedo, IsTheShareThatSamplesOfVisibleNormalsReflect) {
    constexpr int kSamples = 1 << 16;
    for (const Ggx& ggx : {Ggx{0.0025, 1}, Ggx{0.6, 0.05}, Ggx{1, 0.3}}) {
        for (const double mu : {0.05, 0.4, 1.0}) {
            const Vec3 view = view_at(mu, 1.1);
            double sum = 0;
            for (int i = 0; i < kSamples; ++i) {
                const auto u = [&](int d) {
                    return scrambled_sobol(7, static_cast<std::uint32_t>(i), d);
                };
                const Vec3 l = mirrored(view, ggx.sample_visible(view, {u(0), u(1)}));
                if (l.z > 0.0) sum += ggx.shadowing(view, l) / kSamples;
            }
            EXPECT_NEAR(integrate_anisotropic_albedo(view, ggx), sum, 3e-4) << ggx.x << " " << mu;
        }
    }
}

TEST(AnisotropicAlbedo, IsSymmetric) {
    for (const double turn : kTurns) {
        const Vec3 v = view_at(0.3, turn);
        const double there = anisotropic_albedo(v, {0.7, 0.1});
        for (const double x : {-1.0, 1.0}) {
            for (const double y : {-1.0, 1.0}) {
                EXPECT_NEAR(anisotropic_albedo({x * v.x, y * v.y, v.z}, {0.7, 0.1}), there, 1e-12);
                EXPECT_NEAR(anisotropic_albedo({y * v.y, x * v.x, v.z}, {0.1, 0.7}), there, 1e-12);
                EXPECT_NEAR(integrate_anisotropic_albedo({x * v.x, y * v.y, v.z}, {0.7, 0.1}),
                            integrate_anisotropic_albedo(v, {0.7, 0.1}), 1e-12);
            }
        }
    }
    EXPECT_EQ(mean_anisotropic_albedo({0.7, 0.1}), mean_anisotropic_albedo({0.1, 0.7}));
}

TEST(AnisotropicAlbedo, GivesTheSameBitsHoweverOftenItIsAsked) {
    for (int round = 0; round < 2; ++round) {
        for (const double mu : kCosines) {
            for (const double r : kRoughnesses) {
                for (const double strength : {0.2, 0.5, 0.9}) {
                    const Ggx ggx = grooves(r, strength);
                    const AnisotropicAlbedo alone(ggx);
                    for (int time = 0; time < 3; ++time) {
                        const Vec3 view = view_at(mu, 0.7);
                        EXPECT_EQ(anisotropic_albedo(view, ggx), alone.at(view));
                        // Takes the place of the last answers.
                        const Vec3 others[] = {view_at(0.5 * mu), view_at(0.7 * mu)};
                        for (const Vec3& other : others) {
                            EXPECT_EQ(anisotropic_albedo(other, ggx), alone.at(other));
                        }
                    }
                }
            }
        }
    }
}

TEST(AnisotropicAlbedo, MeanIsThatOfTheViews) {
    for (const double r : {0.0224, 0.035, 0.05, 0.08, 0.13, 0.21, 0.34, 0.62, 1.0}) {
        for (const double strength : {0.02, 0.06, 0.1, 0.3, 0.6, 1.0}) {
            const Ggx ggx = grooves(r, strength);
            constexpr int kSide = 120;
            double lost = 0;
            for (int i = 0; i < kSide * kSide; ++i) {
                const double x = (i % kSide + 0.5) / kSide;
                const double turn = 0.5 * kPi * (i / kSide + 0.5) / kSide;
                lost += 6.0 * x * x * x * x * x / (kSide * kSide) *
                        (1.0 - anisotropic_albedo(view_at(x * x * x, turn), ggx));
            }
            // A relative error: the matt lobe is scaled by it.
            EXPECT_NEAR((1.0 - mean_anisotropic_albedo(ggx)) / lost, 1.0, 6e-3)
                << r << " " << strength;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
