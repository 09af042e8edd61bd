#include "alhazen/imaging/image/tone_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(ToneMapping, NothingAskedChangesNothing) {
    const ToneMapper map{ToneMapping{}};
    const Rgb c{0.1, 2.5, -0.3};
    EXPECT_EQ(map(c), c);
    EXPECT_TRUE(ToneMapping{}.changes_nothing());
    EXPECT_FALSE((ToneMapping{.stops = 1}.changes_nothing()));
}

TEST(ToneMapping, AStopDoubles) {
    const ToneMapper map{ToneMapping{.stops = 3}};
    EXPECT_EQ(map({0.125, 0.25, 0.5}), (Rgb{1, 2, 4}));
}

TEST(ToneMapping, CurvesRiseFromBlackToWhite) {
    for (const ToneCurve curve : {ToneCurve::Reinhard, ToneCurve::Aces, ToneCurve::Agx}) {
        const ToneMapper map{ToneMapping{.curve = curve}};
        double last = map({0, 0, 0}).g;
        EXPECT_NEAR(last, 0.0, 1e-3);
        for (double v = 1e-3; v < 4.0; v *= 1.3) {
            const Rgb shown = map({v, v, v});
            EXPECT_GT(shown.g, last) << v;
            EXPECT_LE(shown.g, 1.0 + 1e-12) << v;
            // Grey stays grey.
            EXPECT_NEAR(shown.r, shown.g, 2e-3) << v;
            EXPECT_NEAR(shown.b, shown.g, 2e-3) << v;
            last = shown.g;
        }
        EXPECT_LE(map({1e6, 1e6, 1e6}).g, curve == ToneCurve::Reinhard ? 1e6 : 1.0);
        EXPECT_TRUE(std::isnan(map({std::nan(""), 0, 0}).r));
    }
    EXPECT_NEAR(ToneMapper{ToneMapping{.curve = ToneCurve::Reinhard}}({4, 4, 4}).r, 1.0, 1e-9);
    EXPECT_NEAR(ToneMapper{ToneMapping{.curve = ToneCurve::Aces}}({0.18, 0.18, 0.18}).r, 0.2671,
                1e-3);
}

/// The linear colour, of luminance 1, of a chromaticity.
Rgb color_of(double x, double y) {
    const double r = x / y, b = (1 - x - y) / y;
    return {3.2409699 * r - 1.5373832 - 0.4986108 * b, -0.9692436 * r + 1.8759675 + 0.0415551 * b,
            0.0556301 * r - 0.2039770 + 1.0569715 * b};
}

/// The standard illuminants of CIE 15:2004, and the black body of 2000 K (Wyszecki and Stiles,
/// "Color Science", 1982, table 1(3.11)).
TEST(ToneMapping, TheLightOfATemperatureBecomesWhite) {
    struct Light {
        double kelvin, x, y, within;
    };
    for (const Light& light : {Light{2000, 0.52669, 0.41331, 5e-3},
                               {2856, 0.44757, 0.40745, 5e-3},
                               {5003, 0.34567, 0.35850, 1e-3},
                               {5503, 0.33242, 0.34743, 1e-3},
                               {6504, 0.31271, 0.32902, 1e-3},
                               {7504, 0.29902, 0.31485, 1e-3}}) {
        const ToneMapper map{ToneMapping{.kelvin = light.kelvin}};
        const Rgb shown = map(color_of(light.x, light.y));
        EXPECT_NEAR(shown.r, 1.0, light.within) << light.kelvin;
        EXPECT_NEAR(shown.g, 1.0, light.within) << light.kelvin;
        EXPECT_NEAR(shown.b, 1.0, light.within) << light.kelvin;
    }
}

/// D65 is the white of sRGB.
TEST(ToneMapping, TheWhiteBalanceOfDaylightChangesLittle) {
    const Rgb shown = ToneMapper{ToneMapping{.kelvin = 6504}}({1, 1, 1});
    EXPECT_NEAR(shown.r, 1.0, 2e-3);
    EXPECT_NEAR(shown.g, 1.0, 2e-3);
    EXPECT_NEAR(shown.b, 1.0, 2e-3);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
