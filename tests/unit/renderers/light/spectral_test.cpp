#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/light_transport/random_walk.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::expect_same_light;
using testing::floor_from_above;
using testing::glass_named;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::prism;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Walks of light at one wavelength that scatter a wanted number of times.
class Walker {
  public:
    explicit Walker(const Scene& scene)
        : lights_(scene),
          sampler_(find_sampler("independent")->make(1, 1 << 14)),
          filter_(*find_filter("box"), 0.5),
          round_{*sampler_, filter_, 0, 1 << 14, {}, {}, 1},
          job_{.scene = scene, .camera = scene.cameras[0].camera},
          walk_(scene, lights_, counters_, nullptr) {
        job_.round = &round_;
    }
    /// The direction in which light leaves after these branches at each surface. Branches are
    /// random, so the walk is repeated until it takes them.
    Vec3 leaves(const Ray& ray, double nm, const std::vector<bool>& transmitted) {
        const Wavelengths waves = Wavelengths::single(nm);
        const PathRandomness chance(job_);
        for (std::uint32_t i = 0; i < 1 << 14; ++i) {
            const SampleId id{{3, 5}, i};
            WalkStart start{.ray = ray, .waves = &waves};
            walk_.walk(Transport::Importance, start, {chance, id, 16, 8, 64}, vertices_);
            if (!walk_.escape().is || vertices_.size() != transmitted.size()) continue;
            bool fits = true;
            for (std::size_t k = 0; k < transmitted.size(); ++k) {
                const Vec3 from = vertices_[k].scatter.view();
                const Vec3 to = k + 1 < transmitted.size() ? -vertices_[k + 1].scatter.view()
                                                           : walk_.escape().direction;
                const Vec3& n = vertices_[k].scatter.geometric();
                fits = fits && (dot(from, n) * dot(to, n) < 0.0) == transmitted[k];
            }
            if (fits) return walk_.escape().direction;
        }
        ADD_FAILURE() << "no path";
        return {};
    }

  private:
    Illumination lights_;
    std::unique_ptr<Sampler> sampler_;
    FilterKernel filter_;
    SampleRound round_;
    RenderJob job_;
    RayCounters counters_;
    RandomWalk walk_;
    std::vector<PathVertex> vertices_;
};

TEST(Spectral, APrismTurnsEachLineAsSellmeierSays) {
    for (const char* name : {"BK7", "SF11"}) {
        SceneMaker maker;
        const double apex = (name[0] == 'B' ? 60 : 45) * kDegree;
        maker.add(maker.mesh(prism(apex)), maker.material(glass_named(name)));
        const Scene scene = maker.compile();
        Walker walker(scene);
        for (const double nm : {kLineF, kLineD, 589.3, kLineC}) {
            const double n = find_glass(name)->sellmeier.index(nm);
            const double incidence = 52 * kDegree;
            // The left face's normal, and the ray that meets its middle at that angle from below.
            const double tilt = 0.5 * apex;
            const Vec3 normal{-std::cos(tilt), std::sin(tilt), 0};
            const Vec3 along{std::sin(tilt), std::cos(tilt), 0};  // of the face, upwards
            const Vec3 direction = -std::cos(incidence) * normal + std::sin(incidence) * along;
            const Vec3 middle{-0.5 * std::tan(tilt), 0, 0};
            const Vec3 out = walker.leaves({middle - direction, direction}, nm, {true, true});
            const double inside = std::asin(std::sin(incidence) / n);
            const double expected = incidence + std::asin(n * std::sin(apex - inside)) - apex;
            const double found = std::acos(std::clamp(dot(out, direction), -1.0, 1.0));
            EXPECT_NEAR(found / kDegree, expected / kDegree, 0.001) << name << ", " << nm;
        }
    }
}

TEST(Spectral, ARainbowStandsAt42Degrees) {
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 1), maker.material(glass_named("water")));
    const Scene scene = maker.compile();
    Walker walker(scene);
    for (const double nm : {kLineF, kLineD, kLineC}) {
        double bow = 0;
        for (double offset = 0.80; offset < 0.92; offset += 0.004) {
            const Vec3 out = walker.leaves({{offset, 0, 5}, {0, 0, -1}}, nm, {true, false, true});
            bow = std::max(bow, std::acos(std::clamp(out.z, -1.0, 1.0)) / kDegree);
        }
        // Descartes: the angle is greatest where cos^2 of the incidence is (n^2 - 1) / 3.
        const double n = find_glass("water")->sellmeier.index(nm);
        const double incidence = std::acos(std::sqrt((n * n - 1) / 3));
        const double inside = std::asin(std::sin(incidence) / n);
        EXPECT_NEAR(bow, (4 * inside - 2 * incidence) / kDegree, 0.01) << nm;
        if (nm != kLineF) {
            EXPECT_GT(bow, 42.0);
            EXPECT_LT(bow, 42.5);
        }
    }
}

TEST(Spectral, WhiteStaysWhiteInAFurnace) {
    SceneMaker maker;
    maker.description().cameras[0].camera = look_along({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.7, 1.0);
    maker.add(ball({0, 0, 0}, 3), maker.material(shining({0.5, 0.5, 0.5}, {0.5, 0.5, 0.5})));
    const Scene scene = maker.compile();
    for (const char* renderer : {"path_tracing --spectral", "bidirectional --spectral"}) {
        if (renderer[0] == 'p' && !testing::thorough()) continue;
        const Rgb seen = mean_of(picture_of(scene, renderer, 16, 1024));
        EXPECT_NEAR(seen.r / seen.g, 1.0, 0.002) << renderer;
        EXPECT_NEAR(seen.b / seen.g, 1.0, 0.002) << renderer;
        EXPECT_NEAR(seen.g, 1.0, 0.005) << renderer;
    }
}

TEST(Spectral, GreyScenesAreThoseOfColours) {
    SceneMaker maker = floor_from_above(1, {0.6, 0.6, 0.6});
    maker.add(ball({0, 0, 1.5}, 0.3), maker.material(shining({8, 8, 8})));
    Material pane;
    pane.dielectric = Dielectric{{0.5, 0.5, 0.5}};
    pane.index.value = 1.5;
    maker.add(ball({0.2, 0.1, 0.3}, 0.2), maker.material(pane));
    const Scene scene = maker.compile();
    expect_same_light(scene, "grey",
                      {"path_tracing", "path_tracing --spectral", "bidirectional --spectral"}, 64,
                      5.0);
}

TEST(Spectral, ColouredScenesHaveTheColoursOfTheirMaterials) {
    SceneMaker maker = floor_from_above(0.2, {0.7, 0.3, 0.1});
    maker.description().picture.background = Rgb{2, 2, 2};
    const Rgb seen = mean_of(picture_of(maker.compile(), "path_tracing --spectral", 16, 1024));
    EXPECT_NEAR(seen.r, 1.4, 0.01);
    EXPECT_NEAR(seen.g, 0.6, 0.01);
    EXPECT_NEAR(seen.b, 0.2, 0.01);
}

TEST(Spectral, StrategiesAgreeOnLightThatADispersingBallThrows) {
    for (const double roughness : {0.0, 0.4}) {
        if (roughness > 0.0 && !testing::thorough()) continue;
        SceneMaker maker = floor_from_above(1, {0.8, 0.8, 0.8});
        maker.add(ball({0, 0, 2.5}, 0.6), maker.material(shining({4, 4, 4})));
        Material flint = glass_named("SF11");
        flint.roughness.value = roughness;
        maker.add(ball({0.1, 0, 0.3}, 0.25), maker.material(flint));
        expect_same_light(maker.compile(), "flint, roughness " + std::to_string(roughness),
                          {"path_tracing --spectral", "bidirectional --spectral"}, 256, 5.0);
    }
}

TEST(Spectral, PicturesDependNeitherOnThreadsNorOnTiles) {
    SceneMaker maker = floor_from_above(1, {0.8, 0.5, 0.2});
    maker.add(ball({0, 0, 1.5}, 0.3), maker.material(shining({8, 7, 6})));
    maker.add(ball({0.2, 0.1, 0.3}, 0.2), maker.material(glass_named("diamond")));
    const Scene scene = maker.compile();
    for (const char* renderer :
         {"path_tracing --spectral", "light_tracing --spectral", "bidirectional --spectral"}) {
        const Film one = picture_of(scene, renderer, 24, 8, 1, 1, 32);
        const Film two = picture_of(scene, renderer, 24, 8, 1, 2, 5);
        for (int i = 0; i < 24 * 24; ++i) {
            ASSERT_EQ(one.at(i % 24, i / 24), two.at(i % 24, i / 24)) << renderer;
        }
    }
}

TEST(Spectral, ATextureOfTheIndexIsItsNumberInASolidOfTwoMedia) {
    const auto seen = [](const ScalarInput& index) {
        SceneMaker maker = floor_from_above(1, {0.8, 0.5, 0.2});
        maker.description().picture.background = Rgb{2, 2, 2};
        maker.description().textures.push_back(
            {"half", SolidTexture{.color = {0.5, 0.5, 0.5}, .other = {0.5, 0.5, 0.5}}, {}});
        const ObjectIndex lens = maker.object("lens");
        maker.description().objects.back().combine = Combine::Union;
        Material crown, flint;
        crown.transmissive.color = {0.9, 0.9, 0.9};
        crown.index = index;
        flint = glass_named("SF11");
        maker.add(ball({-0.2, 0, 0.5}, 0.4), maker.material(crown), {}, lens);
        maker.add(ball({0.2, 0, 0.5}, 0.4), maker.material(flint), {}, lens);
        maker.add(lens);
        return picture_of(maker.compile(), "path_tracing --spectral", 16, 4);
    };
    const Film number = seen({1.5, kNoTexture}), texture = seen({3.0, TextureId{0}});
    for (int i = 0; i < 16 * 16; ++i) {
        // The mean of a texture over a footprint is rounded.
        const Rgb off = number.at(i % 16, i / 16) - texture.at(i % 16, i / 16);
        EXPECT_LT(std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)}), 1e-9) << i;
    }
}

TEST(Spectral, ABlackBodyHasItsOwnColourThroughAFilter) {
    // Behind a filter the spectrum differs from its colour: both are seen through the same glass.
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {0.1, 0, 0}, {0, 0.1, 0}};
    Material body;
    body.illuminant = Illuminant{IlluminantKind::BlackBody, 3200, 2};
    body.emission.color = {3, 2, 1};
    const double luminance = 0.2126729 * 3 + 0.7151522 * 2 + 0.0721750;
    maker.add(rectangle({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}), maker.material(body));
    const Rgb seen = mean_of(picture_of(maker.compile(), "path_tracing --spectral", 16, 1024));
    EXPECT_NEAR(0.2126729 * seen.r + 0.7151522 * seen.g + 0.0721750 * seen.b, luminance, 0.02);
    EXPECT_GT(seen.r / seen.b, 3.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
