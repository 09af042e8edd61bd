#include "alhazen/renderers/light_transport/volume_scattering.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "support/chi_square.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

BoxShape wide_layer(double bottom, double top) {
    return {{-1000, -1000, bottom}, {1000, 1000, top}};
}

/// Of twelve pictures, whose error is at most `largest` of it.
MeanBounds twelve(double largest) {
    return {.largest_error = largest, .bias = 1e-12, .runs = 12, .most_errors = 4.0};
}

TEST(HenyeyGreenstein, DrawsFollowItsDensityWhoseMeanCosineIsTheAnisotropy) {
    const double anisotropies[] = {0.0, 0.3, -0.5, 0.85, -0.9};
    const double level = sidak_level(1e-3, 5);
    for (const double g : anisotropies) {
        const Vec3 along = normalize(Vec3{0.3, -0.5, 0.8});
        RandomStream random(17);
        constexpr std::size_t kDraws = 200000;
        std::vector<std::size_t> counts(SphereCells::kCount);
        double cosines = 0.0;
        for (std::size_t i = 0; i < kDraws; ++i) {
            const double x = random.uniform(), y = random.uniform();
            const Vec3 d = sample_henyey_greenstein(along, g, {x, y});
            ++counts[std::size_t(SphereCells::cell_of(d))];
            cosines += dot(d, along);
        }
        const auto density = [&](const Vec3& d) { return henyey_greenstein(dot(d, along), g); };
        const std::vector<double> shares = integrate_cells(density);
        double whole = 0.0;
        for (const double share : shares) whole += share;
        EXPECT_NEAR(whole, 1.0, 1e-3) << g;
        EXPECT_GT(chi_square_probability(shares, counts, kDraws), level) << g;
        // The standard deviation of a cosine is below 1.
        EXPECT_NEAR(cosines / kDraws, g, 4.0 / std::sqrt(double(kDraws))) << g;
    }
}

TEST(VolumeStep, WeightsSumToTransmittanceAndWhatIsScattered) {
    const Spectrum absorption{0.2, 0, 0.5, 0.5}, scattering{0.3, 1.5, 0, 0.7};
    const Spectrum throughput{0.5, 1, 2, 0.1};
    for (const double length : {0.5, 3.0, std::numeric_limits<double>::infinity()}) {
        RandomStream random(3);
        Spectrum through, scattered;
        constexpr int kDraws = 200000;
        for (int i = 0; i < kDraws; ++i) {
            const double x = random.uniform(), y = random.uniform();
            const VolumeStep s = step_in_volume(absorption, scattering, throughput, length, {x, y});
            ASSERT_TRUE(s.weight.is_finite());
            ASSERT_LE((throughput * s.weight).max(), 3.6 * (1 + 1e-9));  // the sum of the four
            (s.scatters ? scattered : through) += (1.0 / kDraws) * s.weight;
        }
        for (int k = 0; k < 4; ++k) {
            const double extinction = absorption[k] + scattering[k];
            const double left = std::exp(-extinction * length);
            EXPECT_NEAR(through[k], left, 0.01) << length << " " << k;
            EXPECT_NEAR(scattered[k], scattering[k] / extinction * (1.0 - left), 0.01) << k;
        }
    }
}

TEST(VolumeScattering, WhatOnlyScattersIsInvisibleInEvenSurroundings) {
    for (const double g : {0.0, 0.7}) {
        SceneMaker maker;
        maker.description().picture.background = Rgb{1, 1, 1};
        maker.add(ball({0, 0, 0}, 1.5), maker.material(fog({}, {2, 2, 2}, g, kNearlyOne)));
        const Film film =
            picture_of(maker.compile(), "path_tracing:depth=1000,roulette=1000", 8, 16);
        for (int i = 0; i < 64; ++i) {
            const Rgb& c = film.at(i % 8, i / 8);
            EXPECT_NEAR(c.r, 1.0, 1e-9) << i;
            EXPECT_NEAR(c.b, 1.0, 1e-9) << i;
        }
        SceneMaker colored = looking_down();
        colored.description().picture.background = Rgb{1, 1, 1};
        colored.add(ball({0, 0, 0}, 1), colored.material(fog({}, {0.5, 1, 2}, g, kNearlyOne)));
        expect_mean(colored.compile(), "path_tracing:depth=1000", {1, 1, 1}, twelve(0.01));
    }
}

TEST(VolumeScattering, WhatIsNotScatteredFallsByBeersLaw) {
    // The boundary is passed straight: no scattering is left.
    const Rgb absorption{0.3, 0.1, 0.7}, scattering{0.2, 0.9, 0.1};
    SceneMaker maker = looking_down();
    maker.add(wide_layer(-1.5, 0), maker.material(fog(absorption, scattering)));
    maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}), maker.material(shining({4, 4, 4})));
    Rgb expected;
    for (int i = 0; i < 3; ++i)
        expected[i] = 4.0 * std::exp(-1.5 * (absorption[i] + scattering[i]));
    for (const char* renderer : {"path_tracing:depth=0", "bidirectional:depth=0"}) {
        expect_mean(maker.compile(), renderer, expected, twelve(0.02));
    }
}

TEST(VolumeScattering, ASlabInEvenLightShowsTheFirstOrderOfItsScattering) {
    const Rgb absorption{0.05, 0.3, 0}, scattering{0.02, 0.2, 0.6};
    constexpr double kThick = 1.25;
    for (const double g : {0.0, 0.6}) {
        SceneMaker maker = looking_down();
        maker.description().picture.background = Rgb{1, 1, 1};
        maker.add(wide_layer(-kThick, 0), maker.material(fog(absorption, scattering, g)));
        Rgb expected;
        constexpr int kSteps = 400;
        for (int c = 0; c < 3; ++c) {
            const double extinction = absorption[c] + scattering[c];
            double sum = std::exp(-extinction * kThick);
            for (int i = 0; i < kSteps * kSteps; ++i) {
                const double z = kThick * (i % kSteps + 0.5) / kSteps;  // below the top
                const double mu = (i / kSteps + 0.5) / kSteps;
                const double around =
                    henyey_greenstein(mu, g) * std::exp(-extinction * (kThick - z) / mu) +
                    henyey_greenstein(-mu, g) * std::exp(-extinction * z / mu);
                sum += scattering[c] * std::exp(-extinction * z) * 2.0 * kPi * around * kThick /
                       (kSteps * kSteps);
            }
            expected[c] = sum;
        }
        for (const char* renderer : {"path_tracing:depth=1", "bidirectional:depth=1"}) {
            expect_mean(maker.compile(), renderer, expected, twelve(0.01));
        }
    }
}

TEST(VolumeScattering, ALampInFogShinesByTheIntegralAlongTheView) {
    const Rgb absorption{0.1, 0, 0.4}, scattering{0.3, 0.2, 0.05};
    const Vec3 lamp{0.5, 0, 1};
    for (const double g : {0.0, -0.4, 0.7}) {
        SceneMaker maker = looking_down();
        maker.description().conventions.shading.clamp_attenuation = false;
        maker.add(BoxShape{{-50, -50, -2}, {50, 50, 50}},
                  maker.material(fog(absorption, scattering, g)));
        maker.add(rectangle({-40, -40, -1}, {80, 0, 0}, {0, 80, 0}), maker.material(matt({})));
        maker.light(PointLight{.position = lamp, .color = {3, 3, 3}, .attenuation = {0, 0, 1}});
        Rgb expected;
        constexpr int kSteps = 20000;
        for (int c = 0; c < 3; ++c) {
            const double extinction = absorption[c] + scattering[c];
            for (int i = 0; i < kSteps; ++i) {
                const double s = 6.0 * (i + 0.5) / kSteps;
                const Vec3 to = lamp - Vec3{0, 0, 5 - s};
                const double d = length(to), cosine = -to.z / d;
                // A light of intensity 1 gives the irradiance pi at a distance of 1.
                expected[c] += 6.0 / kSteps * scattering[c] * std::exp(-extinction * (s + d)) *
                               henyey_greenstein(cosine, g) * 3.0 * kPi / (d * d);
            }
        }
        for (const char* renderer : {"path_tracing:depth=1", "bidirectional:depth=1"}) {
            expect_mean(maker.compile(), renderer, expected, twelve(0.03));
        }
    }
}

TEST(VolumeScattering, NestedVolumesScatterByTheInnermost) {
    // Clear inside of fog: only what is outside of it scatters.
    const Rgb scattering{0.2, 0.2, 0.2};
    SceneMaker maker = looking_down();
    maker.add(wide_layer(-3, 0), maker.material(fog({}, scattering)));
    maker.add(wide_layer(-2, -1), maker.material(fog({}, {})));
    maker.add(rectangle({-9, -9, -4}, {18, 0, 0}, {0, 18, 0}), maker.material(shining({1, 1, 1})));
    const double left = std::exp(-0.2 * 2.0);
    for (const char* renderer : {"path_tracing:depth=0", "bidirectional:depth=0"}) {
        expect_mean(maker.compile(), renderer, {left, left, left}, twelve(0.02));
    }
}

TEST(VolumeScattering, PicturesDependNeitherOnThreadsNorOnTiles) {
    SceneMaker maker;
    maker.description().picture.background = Rgb{0.5, 0.7, 1};
    maker.add(ball({0, 0, 0}, 1), maker.material(fog({0.1, 0, 0}, {1, 2, 3}, 0.5)));
    maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}),
              maker.material(matt({0.5, 0.5, 0.5})));
    const Scene scene = maker.compile("wide_bvh");
    const Film a = picture_of(scene, "path_tracing", 16, 4, 7, 1, 32);
    const Film b = picture_of(scene, "path_tracing", 16, 4, 7, 2, 5);
    for (int i = 0; i < 256; ++i) EXPECT_EQ(a.at(i % 16, i / 16), b.at(i % 16, i / 16)) << i;
}

TEST(VolumeScattering, RenderersThatHaveNoneSaySo) {
    const std::set<std::string> scatter{"path_tracing",   "light_tracing", "bidirectional",
                                        "photon_mapping", "sppm",          "vcm"};
    for (const RendererEntry& entry : renderers()) {
        EXPECT_EQ(make_renderer(entry.name)->scatters_in_volumes(), scatter.contains(entry.name))
            << entry.name;
    }
    EXPECT_FALSE(make_renderer("path_tracing:manifold=on")->scatters_in_volumes());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
