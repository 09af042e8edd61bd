#include <gtest/gtest.h>

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/dielectric_albedo.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/ggx_albedo.h"
#include "alhazen/shading/microfacets/lobe_albedo.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr double kRoughnesses[] = {0.05, 0.13, 0.21, 0.34, 0.47, 0.55, 0.68, 0.79, 0.91, 1.0};
constexpr double kCosines[] = {0.01, 0.03, 0.07, 0.15, 0.33, 0.52, 0.71, 0.88, 1.0};

TEST(AlbedoTables, GgxIsItsIntegral) {
    for (const double r : kRoughnesses) {
        for (const double mu : kCosines) {
            const SplitAlbedo table = ggx_albedo(mu, r * r),
                              exact = integrate_ggx_albedo(mu, r * r);
            EXPECT_NEAR(table.sum(), exact.sum(), 5e-4) << r << " " << mu;
            EXPECT_NEAR(table.at_f90, exact.at_f90, 2e-3) << r << " " << mu;
        }
    }
}

TEST(AlbedoTables, GiveTheSameBitsHoweverOftenTheyAreAsked) {
    // Two tables, whose slices alternate: each alpha is looked up once, then repeatedly.
    const auto albedo = [](double mu, double alpha) { return 0.2 + 0.7 * mu * (1.0 - alpha); };
    const auto other = [](double mu, double alpha) { return 0.9 - 0.5 * mu * alpha; };
    const AlbedoTable first(albedo), second(other, AlbedoTable::Axis::Angle);
    for (const AlbedoTable* table : {&first, &second}) {
        for (const double mu : kCosines) {
            for (const double r : kRoughnesses) {
                // The same values by an unused table.
                const AlbedoTable fresh = table == &first
                                              ? AlbedoTable(albedo)
                                              : AlbedoTable(other, AlbedoTable::Axis::Angle);
                const double once = fresh.at(mu, r);
                for (int time = 0; time < 3; ++time) {
                    EXPECT_EQ(fresh.at(mu, r), once) << mu << " " << r;
                    EXPECT_EQ(table->at(mu, r), once) << mu << " " << r;
                    // Takes the place of the last answers.
                    if (r < 1.0) {
                        EXPECT_NE(table->at(0.5 * mu, r), once);
                        EXPECT_NE(table->at(0.7 * mu, r), once);
                    }
                }
            }
        }
    }
}

TEST(AlbedoTables, SlicesGiveTheBitsOfTheirTable) {
    const auto albedo = [](double mu, double alpha) { return 0.2 + 0.7 * mu * (1.0 - alpha); };
    for (const auto axis : {AlbedoTable::Axis::Shadow, AlbedoTable::Axis::Angle}) {
        const AlbedoTable table(albedo, axis);
        for (const double r : kRoughnesses) {
            const AlbedoTable::Slice slice(table, r);
            // All cells, the ends and beyond.
            for (int i = -2; i <= 1002; ++i) {
                const double mu = 0.001 * i;
                ASSERT_EQ(slice.at(mu), table.at(mu, r)) << mu << " " << r;
            }
        }
    }
}

TEST(AlbedoTables, DielectricsAreTheirIntegrals) {
    for (const double r : {0.05, 0.21, 0.47, 0.79, 1.0}) {
        for (const double mu : {0.05, 0.15, 0.52, 0.88}) {
            for (const double eta : {0.45, 0.667, 0.9, 1.1, 1.33, 1.5, 2.4}) {
                EXPECT_NEAR(dielectric_albedo(mu, r * r, eta).sum,
                            integrate_dielectric_albedo(mu, r * r, eta).sum,
                            eta < 1.0 ? 2e-3 : 1.1e-2)
                    << r << " " << mu << " " << eta;
            }
        }
    }
}

TEST(AlbedoTables, SmoothSurfacesLoseNothing) {
    EXPECT_NEAR(ggx_albedo(0.5, 1e-5).sum(), 1.0, 1e-4);
    EXPECT_NEAR(ggx_mean_albedo(1e-5).sum(), 1.0, 1e-3);
    EXPECT_NEAR(dielectric_albedo(0.5, 1e-5, 0.667).sum, 1.0, 1e-3);
    EXPECT_NEAR(phong_albedo(0.5, 0.002), 1.0, 1e-3);
    EXPECT_NEAR(blinn_albedo(0.5, 0.002), 1.0, 1e-3);
}

TEST(AlbedoTables, NormalIncidenceOnTheRoughestSurfaceHasAClosedForm) {
    // alpha 1: microfacets are a hemisphere, G2 / G1 = 2 l / (1 + l), of l even in 0..1.
    EXPECT_NEAR(integrate_ggx_albedo(1.0, 1.0).sum(), 1.0 - std::log(2.0), 1e-6);
}

TEST(AlbedoTables, GaussAndLegendreIntegratePolynomials) {
    const GaussLegendre<6> rule;
    double sum = 0;
    for (std::size_t i = 0; i < 6; ++i) sum += rule.weights[i] * std::pow(rule.points[i], 11);
    EXPECT_NEAR(sum, 1.0 / 12, 1e-15);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
