#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shading/bsdf/dispersing.h"
#include "alhazen/shading/bsdf/smooth_dielectric.h"
#include "alhazen/shading/spectrum/color_matching.h"
#include "alhazen/shading/spectrum/illuminant_spectrum.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// The colour of light, wavelength by wavelength: `spectrum(waves)` at each.
template <class F>
Rgb integrated(const F& spectrum) {
    constexpr double kStep = 0.25;
    Rgb sum;
    for (double nm = kShortestWave + kStep / 2; nm < kLongestWave; nm += kStep) {
        sum += (kStep * spectrum(Wavelengths::single(nm)).a) * response(nm);
    }
    return sum;
}

double largest_difference(const Rgb& a, const Rgb& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

TEST(Dispersion, GlassesHaveTheIndicesAndAbbeNumbersOfTheCatalogue) {
    const struct {
        const char* name;
        double index, abbe, index_error, abbe_error;
    } kCatalogue[] = {
        {"BK7", 1.51680, 64.17, 1e-5, 0.01},          {"F2", 1.62004, 36.37, 1e-5, 0.01},
        {"SF10", 1.72825, 28.41, 1e-5, 0.01},         {"SF11", 1.78472, 25.76, 1e-5, 0.01},
        {"fused_quartz", 1.45846, 67.82, 1e-5, 0.01}, {"diamond", 2.4175, 55.3, 1e-3, 1.0},
        {"water", 1.33336, 55.8, 1e-4, 0.3},
    };
    EXPECT_EQ(std::size(kCatalogue), named_glasses().size());
    for (const auto& c : kCatalogue) {
        const NamedGlass* const glass = find_glass(c.name);
        ASSERT_NE(glass, nullptr) << c.name;
        const auto n = [&](double nm) { return glass->sellmeier.index(nm); };
        EXPECT_NEAR(n(kLineD), c.index, c.index_error) << c.name;
        EXPECT_NEAR((n(kLineD) - 1) / (n(kLineF) - n(kLineC)), c.abbe, c.abbe_error) << c.name;
    }
    EXPECT_EQ(find_glass("bk7"), find_glass("BK7"));
    EXPECT_EQ(find_glass("BK8"), nullptr);
}

TEST(Dispersion, AnAbbeNumberIsWhatCauchysFormulaGivesBack) {
    const Dispersion d{.abbe = 30};
    const auto n = [&](double nm) { return d.index(1.6, nm); };
    EXPECT_NEAR(n(kLineD), 1.6, 1e-14);
    EXPECT_NEAR(0.6 / (n(kLineF) - n(kLineC)), 30.0, 1e-9);
}

/// Not inline: GCC 12 would take the empty optional of a material for one that is read.
[[gnu::noinline]] Material khr_material(double dispersion) {
    Material m;
    m.metallic_roughness.emplace();
    m.metallic_roughness->dispersion = dispersion;
    return m;
}

TEST(Dispersion, KhrMaterialsDispersionIsTwentyOverTheAbbeNumber) {
    EXPECT_FALSE(dispersion_of(khr_material(0.0)));
    const Material m = khr_material(0.5);
    EXPECT_EQ(dispersion_of(m)->abbe, 40.0);
    EXPECT_EQ(index_of(m, 1.5, kColorChannels), Spectrum::all(1.5));
}

TEST(Wavelengths, ColoursOfReflectancesComeBack) {
    const double kChannels[] = {0.02, 0.3, 0.6, 0.95};
    double worst = 0;
    for (const double r : kChannels) {
        for (const double g : kChannels) {
            for (const double b : kChannels) {
                const Rgb color{r, g, b};
                const Rgb back = integrated([&](const Wavelengths& waves) {
                    return waves.emission({1, 1, 1}) * waves.reflectance(color);
                });
                worst = std::max(worst, largest_difference(back, color));
            }
        }
    }
    EXPECT_LT(worst, 2e-3);
    const Rgb skin{0.8, 0.55, 0.45};
    EXPECT_LT(largest_difference(integrated([&](const Wavelengths& waves) {
                                     return waves.emission({1, 1, 1}) * waves.reflectance(skin);
                                 }),
                                 skin),
              5e-5);
}

TEST(Wavelengths, LightsOfAnySizeKeepTheirColour) {
    for (const Rgb& color : {Rgb{1, 1, 1}, Rgb{10, 5, 1}, Rgb{0.02, 0.01, 0.05}}) {
        const Rgb back =
            integrated([&](const Wavelengths& waves) { return waves.emission(color); });
        EXPECT_LT(largest_difference(back, color), 1e-3 * color.max());
    }
    EXPECT_TRUE(Wavelengths::drawn(0.3).emission({0, 0, 0}).is_black());
}

TEST(Wavelengths, FourOfThemShowTheColourInTheMean) {
    constexpr int kDraws = 4096;
    Rgb white, orange;
    for (int i = 0; i < kDraws; ++i) {
        const Wavelengths waves = Wavelengths::drawn((i + 0.5) / kDraws);
        white += (1.0 / kDraws) * waves.color(waves.emission({1, 1, 1}));
        orange += (1.0 / kDraws) *
                  waves.color(waves.emission({1, 1, 1}) * waves.reflectance({0.8, 0.4, 0.1}));
        // The hero alone shows the same in the mean.
        EXPECT_EQ(waves.reflectance({0.4, 0.4, 0.4}), Spectrum::all(0.4));
    }
    EXPECT_LT(largest_difference(white, {1, 1, 1}), 2e-4);
    EXPECT_LT(largest_difference(orange, {0.8, 0.4, 0.1}), 5e-4);
}

TEST(Wavelengths, TheHeroStandsForAllFour) {
    constexpr int kDraws = 1 << 14;
    Rgb white;
    for (int i = 0; i < kDraws; ++i) {
        Wavelengths waves = Wavelengths::drawn((i + 0.5) / kDraws);
        Spectrum throughput = Spectrum::all(1);
        waves.keep_hero(throughput);
        waves.keep_hero(throughput);
        EXPECT_EQ(throughput, (Spectrum{4, 0, 0, 0}));
        white += (1.0 / kDraws) * waves.color(waves.emission({1, 1, 1}) * throughput);
    }
    EXPECT_LT(largest_difference(white, {1, 1, 1}), 1e-3);
}

TEST(Illuminants, HaveTheChromaticitiesOfTheStandard) {
    const auto xy = [](const Rgb& c) {
        const double x = 0.4124564 * c.r + 0.3575761 * c.g + 0.1804375 * c.b;
        const double y = 0.2126729 * c.r + 0.7151522 * c.g + 0.0721750 * c.b;
        const double z = 0.0193339 * c.r + 0.1191920 * c.g + 0.9503041 * c.b;
        return Vec2{x / (x + y + z), y / (x + y + z)};
    };
    const auto check = [&](const Illuminant& light, double x, double y) {
        const Vec2 found = xy(color_of(light));
        EXPECT_NEAR(found.x, x, 5e-4);
        EXPECT_NEAR(found.y, y, 5e-4);
    };
    check({IlluminantKind::D65}, 0.3127, 0.3290);
    check({IlluminantKind::A}, 0.44758, 0.40745);
    check({IlluminantKind::E}, 1.0 / 3, 1.0 / 3);
    check({IlluminantKind::BlackBody, 6500}, 0.3135, 0.3237);
    check({IlluminantKind::BlackBody, 2856}, 0.44758, 0.40745);
    EXPECT_LT(largest_difference(color_of(Illuminant{IlluminantKind::D65, 0, 3}), {3, 3, 3}), 1e-9);
}

TEST(Illuminants, AColourInTheGamutKeepsItsLuminance) {
    for (const double kelvin : {500.0, 1000.0, 1800.0}) {
        const Illuminant body{IlluminantKind::BlackBody, kelvin, 2};
        EXPECT_LT(color_of(body).b, 0.0) << kelvin;
        const Rgb shown = color_in_gamut(body);
        EXPECT_EQ(shown.b, 0.0) << kelvin;
        EXPECT_GT(shown.r, 0.0) << kelvin;
        EXPECT_NEAR(luminance_of(shown), 2.0, 1e-12) << kelvin;
    }
    const Illuminant warm{IlluminantKind::BlackBody, 2856, 2};
    EXPECT_EQ(color_in_gamut(warm), color_of(warm));
    EXPECT_EQ(color_in_gamut({IlluminantKind::BlackBody, 1000, 0}), Rgb{});
}

TEST(SmoothDielectric, ReflectionAtFourIndicesIsThatOfEachInTheMean) {
    // Any of the four may be the hero: the reflected light and that transmitted for the hero,
    // together.
    const Spectrum all{1 / 1.5, 1 / 1.6, 1 / 1.7, 1 / 1.8};
    const Vec3 view = normalize(Vec3{0.8, 0, 0.6});
    constexpr int kChoices = 20000;
    Spectrum sum;
    for (int first = 0; first < 4; ++first) {
        // Turned, so that wavelength (first + i) mod 4 is at place i.
        Spectrum turned;
        for (int i = 0; i < 4; ++i) turned[i] = all[(first + i) % 4];
        const SmoothDielectric glass{.eta = turned.a, .etas = turned};
        for (int k = 0; k < kChoices; ++k) {
            const auto s = glass.sample(view, (k + 0.5) / kChoices, {}, Transport::Importance);
            ASSERT_TRUE(s);
            if (s->dispersed) {
                sum[first] += 4.0 * s->weight.a / (4.0 * kChoices);
            } else {
                for (int i = 0; i < 4; ++i) {
                    sum[(first + i) % 4] += s->weight[i] / (4.0 * kChoices);
                }
            }
        }
    }
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(sum[i], 1.0, 1e-3);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
