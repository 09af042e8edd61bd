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

TEST(ToneMapping, TheLightOfATemperatureBecomesWhite) {
    for (const double kelvin : {1700.0, 2856.0, 4000.0, 5003.0, 6504.0, 12000.0}) {
        const Rgb light = color_of_temperature(kelvin);
        const Rgb shown = ToneMapper{ToneMapping{.kelvin = kelvin}}(light);
        EXPECT_NEAR(shown.r, 1.0, 1e-4) << kelvin;
        EXPECT_NEAR(shown.g, 1.0, 1e-4) << kelvin;
        EXPECT_NEAR(shown.b, 1.0, 1e-4) << kelvin;
    }
    // D65 is the white of sRGB.
    EXPECT_NEAR(color_of_temperature(6504).r, 1.0, 2e-3);
    EXPECT_NEAR(color_of_temperature(6504).b, 1.0, 2e-3);
    EXPECT_GT(color_of_temperature(2856).r, 2 * color_of_temperature(2856).b);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
