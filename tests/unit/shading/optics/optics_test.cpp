#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/math/constants.h"
#include "alhazen/shading/optics/fresnel.h"
#include "alhazen/shading/optics/metals.h"
#include "alhazen/shading/optics/thin_film.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Fresnel, OfGlassAtNormalIncidenceIsFourPercentBothWays) {
    EXPECT_NEAR(dielectric_reflectance(1.0, 1.0 / 1.5), 0.04, 1e-15);
    EXPECT_NEAR(dielectric_reflectance(1.0, 1.5), 0.04, 1e-15);
    EXPECT_NEAR(normal_reflectance_of(1.5), 0.04, 1e-15);
}

TEST(Fresnel, AtBrewstersAngleOnlyLightAcrossThePlaneIsReflected) {
    for (const double n : {1.2, 1.5, 2.42}) {
        const double cosine = std::cos(std::atan(n));
        // rs = cos(2 angle) there: half of its square, as rp is 0.
        const double across = std::cos(2.0 * std::atan(n));
        EXPECT_NEAR(dielectric_reflectance(cosine, 1.0 / n), 0.5 * across * across, 1e-14);
    }
}

TEST(Fresnel, ReflectsAllBeyondTheCriticalAngleAndIsContinuousThere) {
    const double n = 1.52, critical = std::asin(1.0 / n);
    EXPECT_EQ(dielectric_reflectance(std::cos(critical + 1e-9), n), 1.0);
    EXPECT_LT(dielectric_reflectance(std::cos(critical - 1e-9), n), 1.0);
    EXPECT_NEAR(dielectric_reflectance(std::cos(critical - 1e-9), n), 1.0, 1e-3);
}

TEST(Fresnel, IsTheSameFromBothSidesOfTheBoundary) {
    for (double angle = 0.0; angle < 1.57; angle += 0.05) {
        double behind = 0;
        const double r = dielectric_reflectance(std::cos(angle), 1.0 / 1.5, behind);
        EXPECT_NEAR(r, dielectric_reflectance(behind, 1.5), 1e-12);
    }
}

TEST(Fresnel, AConductorWithoutExtinctionIsADielectric) {
    for (double cosine = 0.0; cosine <= 1.0; cosine += 0.05) {
        EXPECT_NEAR(conductor_reflectance(cosine, 1.5, 0.0),
                    dielectric_reflectance(cosine, 1 / 1.5), 1e-12);
    }
}

TEST(Fresnel, OfAConductorAtNormalIncidenceHasItsClosedForm) {
    const double n = 0.4, k = 2.5;
    EXPECT_NEAR(conductor_reflectance(1.0, n, k),
                ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 1e-12);
    EXPECT_NEAR(conductor_reflectance(0.0, n, k), 1.0, 1e-12);
}

TEST(Fresnel, NonsenseStaysBetweenNoneAndAll) {
    for (const double cosine : {-1.0, 0.0, 2.0}) {
        for (const double eta : {1e-6, 1.0, 1e6}) {
            const double r = dielectric_reflectance(cosine, eta);
            EXPECT_TRUE(r >= 0.0 && r <= 1.0);
            const double c = conductor_reflectance(cosine, eta, 1.0);
            EXPECT_TRUE(c >= 0.0 && c <= 1.0);
        }
    }
}

TEST(Metals, HaveTheirColours) {
    const auto at_normal = [](const Metal& m) {
        Rgb c;
        for (int i = 0; i < 3; ++i) c[i] = conductor_reflectance(1.0, m.index[i], m.extinction[i]);
        return c;
    };
    const Rgb gold = at_normal(*find_metal("gold")), silver = at_normal(*find_metal("silver"));
    EXPECT_TRUE(gold.r > gold.g && gold.g > 1.5 * gold.b);
    EXPECT_GT(std::min({silver.r, silver.g, silver.b}), 0.95);
    const Rgb copper = at_normal(*find_metal("copper"));
    EXPECT_TRUE(copper.r > copper.g && copper.g > copper.b);
    EXPECT_EQ(find_metal("unobtainium"), nullptr);
    EXPECT_TRUE(std::ranges::is_sorted(metals(), {}, &Metal::name));
}

TEST(ThinFilm, OfNoThicknessIsTheBase) {
    const Rgb base{0.04, 0.3, 0.9};
    for (double cosine = 0.05; cosine <= 1.0; cosine += 0.05) {
        const Rgb film = thin_film_reflectance(cosine, 1.3, 0.0, base);
        for (int i = 0; i < 3; ++i) {
            const double schlick = base[i] + (1.0 - base[i]) * schlick_weight(cosine);
            EXPECT_NEAR(film[i], schlick, 1e-9) << cosine;
        }
    }
}

TEST(ThinFilm, AnIndexBetweenThoseOfAirAndGlassCancelsAtAQuarterOfTheWave) {
    // 550 nm, index sqrt(1.5): green is least reflected at 550 / (4 n).
    const double n = std::sqrt(1.5), quarter = 550.0 / (4.0 * n);
    const Rgb base{0.04, 0.04, 0.04};
    EXPECT_LT(thin_film_reflectance(1.0, n, quarter, base).g, 0.005);
    EXPECT_GT(thin_film_reflectance(1.0, n, 2.0 * quarter, base).g, 0.02);
}

/// Airy's reflectance of a film on a dielectric, the mean of both polarisations.
double airy_reflectance(double nm, double cosine, double film, double thickness, double body) {
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const double in_film = std::sqrt(1.0 - sine * sine / (film * film));
    const double in_body = std::sqrt(1.0 - sine * sine / (body * body));
    const double phase = 4.0 * kPi * film * thickness * in_film / nm;
    double sum = 0.0;
    for (const bool parallel : {false, true}) {
        const auto face = [&](double n, double c, double other, double other_c) {
            const double a = parallel ? other * c : n * c;
            const double b = parallel ? n * other_c : other * other_c;
            return (a - b) / (a + b);
        };
        const double above = face(1.0, cosine, film, in_film);
        const double below = face(film, in_film, body, in_body);
        const double cross = 2.0 * above * below * std::cos(phase);
        const double product = above * below;
        sum += (above * above + below * below + cross) / (1.0 + product * product + cross);
    }
    return sum / 2.0;
}

TEST(ThinFilm, AtOneWavelengthItIsAirysAtNormalIncidenceAndNearItObliquely) {
    constexpr double kBody = 1.5;
    double largest = 0.0;
    for (const auto& [index, thickness] :
         {std::pair{1.8, 300.0}, {1.3, 400.0}, {1.38, 100.0}, {2.2, 700.0}}) {
        for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
            const auto film = [&](double cosine) {
                return thin_film_reflectance_at(nm, cosine, index, thickness,
                                                normal_reflectance_of(kBody));
            };
            EXPECT_NEAR(film(1.0), airy_reflectance(nm, 1.0, index, thickness, kBody), 1e-12);
            const double off = film(0.5) - airy_reflectance(nm, 0.5, index, thickness, kBody);
            largest = std::max(largest, std::abs(off));
        }
    }
    EXPECT_LT(largest, 0.033);
    EXPECT_GT(largest, 0.03);  // the figure of docs/design/spectral.md
}

TEST(ThinFilm, AtOneWavelengthAFilmOfFewNanometersIsAirysToo) {
    constexpr double kBody = 1.5;
    const double base = normal_reflectance_of(kBody);
    for (const double thickness : {0.0, 1.0, 10.0, 20.0, 29.0}) {
        for (double nm = 380.0; nm <= 780.0; nm += 20.0) {
            EXPECT_NEAR(thin_film_reflectance_at(nm, 1.0, 2.0, thickness, base),
                        airy_reflectance(nm, 1.0, 2.0, thickness, kBody), 1e-12)
                << thickness << " nm at " << nm;
        }
    }
}

TEST(ThinFilm, ColoursChangeWithThicknessAndStayBetweenNoneAndAll) {
    const Rgb base{0.04, 0.04, 0.04};
    for (double nm = 0.0; nm < 1200.0; nm += 20.0) {
        for (const double cosine : {0.0, 0.1, 0.5, 1.0}) {
            const Rgb c = thin_film_reflectance(cosine, 1.3, nm, base);
            EXPECT_TRUE(c.is_finite() && c.max() <= 1.0 && std::min({c.r, c.g, c.b}) >= 0.0);
        }
    }
    const Rgb a = thin_film_reflectance(1.0, 1.33, 300.0, base);
    const Rgb b = thin_film_reflectance(1.0, 1.33, 420.0, base);
    EXPECT_GT(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), 0.02);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
