#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/shading/lights/clear_sky.h"
#include "alhazen/shading/lights/environment.h"
#include "alhazen/shading/lights/studio.h"
#include "alhazen/simd/targets.h"
#include "support/light_checks.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

const Vec3 kUp{0, 1, 0};

/// Mostly dark, with a bright texel, a black part and random ones.
Image test_picture() {
    RandomStream random(3);
    Image picture(16, 8, 3);
    for (float& sample : picture.samples) sample = static_cast<float>(random.uniform());
    for (int x = 4; x < 9; ++x) std::fill_n(picture.pixel(x, 3), 3, 0.0f);
    for (int x = 4; x < 9; ++x) std::fill_n(picture.pixel(x, 4), 3, 0.0f);
    for (int x = 4; x < 9; ++x) std::fill_n(picture.pixel(x, 5), 3, 0.0f);
    std::fill_n(picture.pixel(11, 2), 3, 30.0f);
    return picture;
}

EnvironmentSettings settings_of(EnvironmentKind kind) {
    EnvironmentSettings settings;
    settings.kind = kind;
    settings.rotation = 0.7;
    settings.scale = 1.5;
    if (kind == EnvironmentKind::Picture) {
        settings.picture = std::make_shared<const Image>(test_picture());
    }
    return settings;
}

/// Chi-square test of sampled directions against the density, in bins of equal solid angle.
template <class Sample, class Density>
double p_value_on_sphere(Sample&& sample, Density&& density, std::uint64_t seed) {
    constexpr int kRows = 10, kColumns = 20, kFine = 24, kDraws = 20000;
    const auto direction = [](double row, double column) {
        const double z = 1.0 - 2.0 * row / kRows, a = 2.0 * kPi * column / kColumns - kPi;
        const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
        return Vec3{r * std::cos(a), r * std::sin(a), z};
    };
    std::vector<double> found(kRows * kColumns, 0.0);
    RandomStream random(seed);
    for (int i = 0; i < kDraws; ++i) {
        const double u = random.uniform(), v = random.uniform();
        const Vec3 d = sample(Vec2{u, v});
        const int row = std::clamp(int((1.0 - d.z) / 2.0 * kRows), 0, kRows - 1);
        const double a = std::atan2(d.y, d.x) + kPi;
        const int column = std::clamp(int(a / (2.0 * kPi) * kColumns), 0, kColumns - 1);
        found[std::size_t(row * kColumns + column)] += 1.0;
    }
    double sum = 0.0;
    int freedom = -1;
    for (int b = 0; b < kRows * kColumns; ++b) {
        double mean = 0.0;
        for (int n = 0; n < kFine * kFine; ++n) {
            mean += density(direction(b / kColumns + (n / kFine + 0.5) / kFine,
                                      b % kColumns + (n % kFine + 0.5) / kFine)) /
                    (kFine * kFine);
        }
        const double expected = kDraws * mean * 4.0 * kPi / (kRows * kColumns);
        if (expected < 8.0) continue;
        const double off = found[std::size_t(b)] - expected;
        sum += off * off / expected;
        ++freedom;
    }
    return chi_square_tail(sum, freedom);
}

TEST(Environments, DrawsFollowTheirDensity) {
    const Environment picture(settings_of(EnvironmentKind::Picture), kUp);
    const Environment studio(settings_of(EnvironmentKind::Studio), kUp);
    const Environment constant(settings_of(EnvironmentKind::Constant), kUp);
    for (const Environment* e : {&picture, &studio, &constant}) {
        EXPECT_GT(p_value_on_sphere([&](const Vec2& u) { return e->sample(u); },
                                    [&](const Vec3& d) { return e->density(d); }, 4),
                  sidak_level(5));
    }
    const Vec3 n = normalize(Vec3{1, 2, -1});
    for (const bool both : {false, true}) {
        EXPECT_GT(p_value_on_sphere([&](const Vec2& u) { return constant.sample(n, both, u); },
                                    [&](const Vec3& d) { return constant.density(n, both, d); }, 5),
                  sidak_level(5));
    }
}

TEST(Environments, TheMeanOverDrawsIsThatOfThePicture) {
    for (const EnvironmentKind kind :
         {EnvironmentKind::Picture, EnvironmentKind::Studio, EnvironmentKind::Sky}) {
        const Environment e(settings_of(kind), kUp);
        RandomStream random(6);
        double sum = 0.0, squares = 0.0;
        constexpr int kDraws = 40000;
        for (int i = 0; i < kDraws; ++i) {
            const double u = random.uniform(), v = random.uniform();
            const Vec3 d = e.sample({u, v});
            const double x = e.radiance(d).g / e.density(d) / (4.0 * kPi);
            sum += x / kDraws;
            squares += x * x / kDraws;
        }
        const double error = std::sqrt(std::max(0.0, squares - sum * sum) / kDraws);
        EXPECT_LT(std::abs(sum - e.mean().g), 4.0 * error + 1e-9 * sum) << int(kind);
        EXPECT_LT(error, 0.01 * sum) << int(kind);
    }
}

TEST(Environments, APictureIsSeenTheRightWayRound) {
    Image image(8, 4, 3);
    std::fill_n(image.pixel(5, 1), 3, 1.0f);  // right of the front, above the horizon
    EnvironmentSettings settings;
    settings.kind = EnvironmentKind::Picture;
    settings.picture = std::make_shared<const Image>(image);
    const double a = 2.0 * kPi * (5.5 / 8 - 0.5), p = kPi * 1.5 / 4;
    const Environment y_up(settings, {0, 1, 0}), z_up(settings, {0, 0, 1});
    // y up: the front is -z and the right x; z up: the front is y.
    const Vec3 in_y{std::sin(p) * std::sin(a), std::cos(p), -std::sin(p) * std::cos(a)};
    const Vec3 in_z{std::sin(p) * std::sin(a), std::sin(p) * std::cos(a), std::cos(p)};
    EXPECT_NEAR(y_up.radiance(in_y).r, 1.0, 1e-9);
    EXPECT_NEAR(z_up.radiance(in_z).r, 1.0, 1e-9);
    settings.rotation = kPi / 2;  // anticlockwise from above: x becomes y where z is up
    const Environment turned(settings, {0, 0, 1});
    EXPECT_NEAR(turned.radiance({-in_z.y, in_z.x, in_z.z}).r, 1.0, 1e-9);
}

bool same_bits(const Vec3& a, const Vec3& b) {
    return std::bit_cast<std::array<std::uint64_t, 3>>(a) ==
           std::bit_cast<std::array<std::uint64_t, 3>>(b);
}

TEST(Environments, ManyDirectionsHaveTheBitsOfEach) {
    for (const EnvironmentKind kind : {EnvironmentKind::Picture, EnvironmentKind::Sky}) {
        const Environment sky(settings_of(kind), kUp);
        ASSERT_TRUE(sky.has_picture());
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride forced(target);
            RandomStream random(11);
            for (std::size_t count = 0; count < 40; ++count) {
                std::vector<Environment::Search> searches;
                std::vector<Vec3> expected;
                while (searches.size() < count) {
                    const auto number = [&] {
                        return random.below(5) == 0 ? static_cast<double>(random.below(16)) / 16.0
                                                    : random.uniform();
                    };
                    const double x = number(), y = number();
                    if (!sky.searches({x, y})) continue;
                    searches.push_back(sky.begin({x, y}));
                    sky.find(searches.back());
                    expected.push_back(sky.sample(Vec2{x, y}));
                }
                std::vector<Vec3> found(count);
                sky.find_directions(searches, found.data());
                for (std::size_t i = 0; i < count; ++i) {
                    ASSERT_TRUE(same_bits(found[i], expected[i])) << target << " " << i;
                }
                // Zenith, nadir, front and back are among them, and the sun.
                if (sky.sun()) found.push_back(sky.sun()->direction);
                for (const double one : {1.0, -1.0}) {
                    found.push_back({one, 0, 0});
                    found.push_back({0, one, 0});
                    found.push_back({0, 0, one});
                }
                std::vector<Environment::Sight> sights(found.size());
                sky.find_sights(found, sights.data());
                for (std::size_t i = 0; i < found.size(); ++i) {
                    const Environment::Sight sight = sky.sight(found[i]);
                    ASSERT_EQ(sights[i].radiance, sight.radiance) << target << " " << i;
                    ASSERT_EQ(sights[i].density, sight.density) << target << " " << i;
                }
            }
        }
    }
}

TEST(Environments, TexelsThatAreNoRadiancesAreBlackAndCounted) {
    Image image(8, 4, 3);
    std::fill(image.samples.begin(), image.samples.end(), 1.0f);
    image.pixel(1, 1)[0] = std::numeric_limits<float>::infinity();
    image.pixel(2, 1)[1] = std::numeric_limits<float>::quiet_NaN();
    image.pixel(3, 1)[2] = -1.0f;
    image.pixel(4, 1)[2] = 1e30f;
    const DirectionPicture picture(image);
    EXPECT_EQ(picture.bad_texels(), 4u);
    EXPECT_TRUE(picture.mean().is_finite());
    EXPECT_LT(picture.mean().r, 1.0);
    std::fill(image.samples.begin(), image.samples.end(), std::numeric_limits<float>::infinity());
    EnvironmentSettings settings;
    settings.kind = EnvironmentKind::Picture;
    settings.picture = std::make_shared<const Image>(image);
    const Environment black(settings, kUp);
    EXPECT_EQ(black.bad_texels(), 32u);
    EXPECT_FALSE(black.emits());
    EXPECT_TRUE(black.radiance({0, 0, 1}).is_black());
}

TEST(Environments, DirectionsThatAreNoNumbersAreHarmless) {
    const DirectionPicture picture(test_picture());
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kHuge = 1e300;
    const std::vector<Vec3> directions{{kNan, kNan, kNan}, {kNan, 0, 0},  {0, 0, kNan},
                                       {0, 0, 0},          {0, 0, kHuge}, {kHuge, kHuge, kHuge}};
    std::vector<DirectionPicture::Sight> sights(directions.size());
    picture.find_sights(directions, sights.data());
    for (const Vec3& direction : directions) {
        EXPECT_GE(picture.density(direction), 0.0);
        const Rgb seen = picture.radiance(direction);
        EXPECT_FALSE(seen.r < 0.0 || seen.g < 0.0 || seen.b < 0.0);
    }
}

TEST(Environments, AClearSkyIsBlueAndHazeIsGrey) {
    const Vec3 to_sun = normalize(Vec3{0.3, -0.7, 0.6});
    const ClearSky clear = clear_sky(to_sun, 2, {0.2, 0.2, 0.2});
    const ClearSky hazy = clear_sky(to_sun, 8, {0.2, 0.2, 0.2});
    const Rgb zenith = clear.picture.rgb(10, 2), haze = hazy.picture.rgb(10, 2);
    EXPECT_GT(zenith.b, 2.0 * zenith.r);
    EXPECT_LT(haze.b / haze.r, 0.7 * zenith.b / zenith.r);
    EXPECT_LT(hazy.sun_radiance.b, clear.sun_radiance.b);
    for (const float sample : clear.picture.samples) EXPECT_TRUE(sample >= 0.0f && sample < 1e4f);
    // A low sun is red.
    const ClearSky evening = clear_sky(normalize(Vec3{1, 0, 0.05}), 3, {0.2, 0.2, 0.2});
    EXPECT_GT(evening.sun_radiance.r, 2.0 * evening.sun_radiance.b);
    EXPECT_TRUE(clear_sky(normalize(Vec3{1, 0, -0.1}), 3, {}).sun_radiance.is_black());
}

TEST(Environments, TheSkyGivesAThirdOfTheLightOfTheSunOrLess) {
    const Environment e(settings_of(EnvironmentKind::Sky), kUp);
    ASSERT_TRUE(e.sun().has_value());
    const double sun =
        2.0 * kPi * (1.0 - e.sun()->cosine) * e.sun()->radiance.g * 1.5 * e.sun()->direction.y;
    double all = 0.0;
    constexpr int kDraws = 20000;
    RandomStream random(2);
    for (int i = 0; i < kDraws; ++i) {
        const double u = random.uniform(), v = random.uniform();
        const Vec3 d = e.sample({u, v});
        all += std::max(0.0, d.y) * e.radiance(d).g / e.density(d) / kDraws;
    }
    std::printf("sun %g of %g on the ground\n", sun, all);
    EXPECT_GT(all - sun, 0.05 * sun);
    EXPECT_LT(all - sun, 0.5 * sun);
}

TEST(Environments, TheStudioIsNeutralAndOfUsefulBrightness) {
    const Environment e(settings_of(EnvironmentKind::Studio), kUp);
    const Rgb mean = (1.0 / 1.5) * e.mean();
    EXPECT_EQ(mean.r, mean.b);
    EXPECT_GT(mean.r, 0.5);
    EXPECT_LT(mean.r, 1.2);
}

TEST(Environments, IlluminationDrawsThem) {
    for (const EnvironmentKind kind : {EnvironmentKind::Constant, EnvironmentKind::Picture,
                                       EnvironmentKind::Sky, EnvironmentKind::Studio}) {
        SceneMaker maker;
        maker.description().environment = EnvironmentDescription{settings_of(kind), {}};
        maker.add(Sphere{{0, 2, 0}, 0.5});
        const Scene scene = maker.compile();
        const Illumination lights(scene);
        const LitPoint at{{0, 0, 0}, {0, 1, 0}, true};
        RandomStream random(4);
        int other_texel = 0;  // rounding at the edge of one
        const LitPoint in_volume = LitPoint::inside_volume(at.point);
        for (int i = 0; i < 500; ++i) {
            const LightDraw around =
                lights.draw(in_volume, 0.5, {random.uniform(), random.uniform()}, kColorChannels);
            ASSERT_GT(around.density, 0.0);
            if (kind == EnvironmentKind::Constant) {
                EXPECT_NEAR(around.density, 1.0 / (4.0 * kPi), 1e-12);
            }
            if (lights.environment_density(in_volume, around.to_light) != around.density) {
                ++other_texel;
            }
            const double c = random.uniform(), u = random.uniform(), v = random.uniform();
            const LightDraw draw = lights.draw(at, c, {u, v}, kColorChannels);
            ASSERT_GT(draw.density, 0.0);
            EXPECT_TRUE(std::isinf(draw.distance));
            if (lights.environment_density(at, draw.to_light) != draw.density) ++other_texel;
            EXPECT_EQ(lights.environment(draw.to_light, kColorChannels), draw.radiance);
        }
        EXPECT_EQ(other_texel, 0);
        // Power emitted into the bounding sphere of the scene.
        double power = 0.0;
        constexpr int kRays = 20000;
        for (int i = 0; i < kRays; ++i) {
            const double u = random.uniform(), v = random.uniform();
            const LightRay out =
                lights.emit(0.5, {random.uniform(), random.uniform()}, {u, v}, kColorChannels);
            ASSERT_TRUE(out.infinite);
            power += out.radiance.b / (out.place_density * out.direction_density) / kRays;
            // Its ray covers all of the disc, and nothing outside it.
            const Vec3 beside = out.ray.origin + 3.0 * perpendicular(out.ray.direction);
            EXPECT_EQ(lights.environment_emit_density(out.ray.direction, out.ray.at(1.0)).place,
                      out.place_density);
            EXPECT_EQ(lights.environment_emit_density(out.ray.direction, beside).place, 0.0);
        }
        const double disc = kPi * 0.75 * (1.0 + 2e-9);  // of the box of the ball
        EXPECT_NEAR(power / (disc * 4.0 * kPi * scene.environment->mean().g), 1.0, 0.03);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
