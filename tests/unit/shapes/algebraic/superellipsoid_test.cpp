#include "alhazen/shapes/algebraic/superellipsoid.h"

#include "unit/shapes/line_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::crossings;
using testing::prepared;

/// Jaklic, Leonardis and Solina, "Segmentation and Recovery of Superquadrics", 2000, eq. 2.60.
double volume(double east, double north) {
    const auto beta = [](double a, double b) {
        return std::exp(std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b));
    };
    return 2 * north * east * beta(north / 2 + 1, north) * beta(east / 2, east / 2);
}

TEST(Superellipsoid, OfExponentOneIsAnEllipsoid) {
    const Superellipsoid s = prepared(Superellipsoid{.axis_a = {2, 0, 0}, .axis_c = {0, 0, 3}});
    testing::expect_near(crossings(s, {0, 0, 0}, {1, 0, 0}), {-2, 2});
    testing::expect_near(crossings(s, {0, 0, 1.5}, {0, 1, 0}), {-std::sqrt(0.75), std::sqrt(0.75)},
                         1e-9);
    EXPECT_NEAR(volume(1, 1), 4 * kPi / 3, 1e-12);
}

TEST(Superellipsoid, OfExponentTwoIsAnOctahedron) {
    const Superellipsoid s = prepared(Superellipsoid{.east = 2, .north = 2});
    testing::expect_near(crossings(s, {0.25, 0.25, -4}, {0, 0, 1}), {3.5, 4.5}, 1e-9);
    testing::expect_near(crossings(s, {0, 0, 0}, {1, 1, 1}), {-1.0 / 3, 1.0 / 3}, 1e-9);
    EXPECT_NEAR(volume(2, 2), 4.0 / 3, 1e-12);
}

TEST(Superellipsoid, HasTheVolumeOfTheFormula) {
    for (const auto& [east, north] : {std::pair{0.5, 0.5}, {0.3, 1.0}, {1.5, 0.7}, {3.0, 2.5}}) {
        const Superellipsoid s = prepared(Superellipsoid{.east = east, .north = north});
        EXPECT_NEAR(testing::volume_by_rays(s, 120), volume(east, north),
                    1e-2 * volume(east, north))
            << east << " " << north;
    }
}

TEST(Superellipsoid, SectionsAreThoseOfItsFunction) {
    const Superellipsoid s = prepared(Superellipsoid{.east = 0.4, .north = 0.8});
    for (const double z : {0.0, 0.3, 0.9}) {
        // |x|^p with p = 2 / e, to the power e / n, is 1 - |z|^(2 / n).
        const double x = std::pow(1 - std::pow(z, 2.5), 0.4);
        testing::expect_near(crossings(s, {0, 0, z}, {1, 0, 0}), {-x, x}, 1e-9);
    }
    EXPECT_EQ(testing::errors_of(Superellipsoid{.east = 0.0}), 1u);
    EXPECT_EQ(testing::errors_of(Superellipsoid{.north = 1000.0}), 1u);
}

/// Where an exponent is 2 sides are flat in one direction. The ray is 2.5e-8 inside at most, for a
/// length of 0.237; both ends by 50 digits.
TEST(Superellipsoid, RaysAlongAFlatSideCrossIt) {
    const Superellipsoid s = prepared(Superellipsoid{.east = 2, .north = 0.2});
    const Vec3 from{0.7304351182358412, -0.26956482214818867, 0.2385262881671824};
    const Vec3 along{0.6497120736591199, 0.6497123234534157, 0.394649360945386};
    testing::expect_near(crossings(s, from, along), {-0.23702, -2.3e-11}, 1e-5);
    // From the middle of the chord, a hundredth of its depth farther in and out.
    EXPECT_EQ(crossings(s, (1 - 1e-9) * from, along).size(), 2u);
    EXPECT_TRUE(crossings(s, (1 + 1e-7) * from, along).empty());
    // The other exponent: by 113 bits.
    testing::expect_near(crossings(prepared(Superellipsoid{.east = 0.2, .north = 2}),
                                   {-103.34479617834282, 172.55024775013786, 102.34487596653756},
                                   {0.4549300087615857, -0.7655566940883286, -0.45493036309388357}),
                         {225.15115114522547, 225.15314334034041}, 1e-6);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
