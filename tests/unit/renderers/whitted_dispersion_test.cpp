#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/renderers/whitted/wave_split.h"
#include "alhazen/shading/optics/dispersion.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::glass_named;
using testing::matt;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
constexpr double kDegree = std::numbers::pi / 180.0;

Film film_of(const Scene& original, const std::string& name, int side) {
    const auto renderer = make_renderer(name);
    Scene scene = original;
    renderer->adjust(scene.conventions.shading);
    Film film(side, side, {0, 0, side, side});
    const RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .control = {.threads = 1}};
    EXPECT_TRUE(renderer->render(job, film).complete());
    return film;
}

/// A ray through a prism, and a light of 0.02 degrees in the exit direction of a wavelength; `off`:
/// rotation of the light away from it, in degrees.
Scene prism_and_lamp(const std::string& glass, double nm, double off) {
    const double apex = 50 * kDegree, incidence = 45 * kDegree, tilt = 0.5 * apex;
    const double half = std::tan(tilt);
    SceneMaker maker;
    maker.add(maker.mesh(testing::prism(apex)), maker.material(glass_named(glass)));
    const Vec3 normal{-std::cos(tilt), std::sin(tilt), 0}, up{std::sin(tilt), std::cos(tilt), 0};
    const Vec3 far_normal{std::cos(tilt), std::sin(tilt), 0};
    const Vec3 direction = -std::cos(incidence) * normal + std::sin(incidence) * up;
    const Vec3 middle{-0.5 * half, 0, 0};
    maker.description().cameras[0].camera =
        OrthographicCamera{middle - 3.0 * direction,
                           direction,
                           {0, 0, 1e-9},
                           1e-9 * Vec3{-direction.y, direction.x, 0}};

    const double n = find_glass(glass)->sellmeier.index(nm);
    const double inside = std::asin(std::sin(incidence) / n);
    const Vec3 within = -std::cos(inside) * normal + std::sin(inside) * up;
    const double way = (0.5 * std::sin(tilt) - dot(middle, far_normal)) / dot(within, far_normal);
    const double turned = incidence + std::asin(n * std::sin(apex - inside)) - apex + off * kDegree;
    const Vec3 out{std::cos(turned) * direction.x + std::sin(turned) * direction.y,
                   std::cos(turned) * direction.y - std::sin(turned) * direction.x, 0};
    const Vec3 side{-out.y, out.x, 0}, along{0, 0, 1};
    const double wide = 100.0 * std::tan(0.01 * kDegree);
    maker.add(rectangle(middle + way * within + 100.0 * out - wide * side - along,
                        2.0 * wide * side, 2.0 * along),
              maker.material(shining({1, 1, 1})));
    return maker.compile();
}

TEST(WhittedDispersion, AShareOfEachWavelengthAddsUpToWhite) {
    for (const int count : {3, 4, 7, 64}) {
        const WaveSplit split(count);
        ASSERT_EQ(split.waves().size(), std::size_t(count));
        Rgb sum;
        double last = 380;
        for (const WaveSplit::Wave& wave : split.waves()) {
            EXPECT_GT(wave.nm, last);
            last = wave.nm;
            for (int c = 0; c < 3; ++c) EXPECT_GE(wave.weight[c], 0.0);
            sum += wave.weight;
        }
        EXPECT_LT(last, 780.0);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 1.0, 1e-14);
    }
    const WaveSplit three(3);
    EXPECT_GT(three.waves()[0].weight.b, 0.7);
    EXPECT_GT(three.waves()[2].weight.r, 0.7);
}

TEST(WhittedDispersion, APrismTurnsEachWavelengthAsSellmeierSays) {
    const WaveSplit three(3);
    for (const char* glass : {"BK7", "SF11"}) {
        for (const char* renderer :
             {"whitted:dispersion=3", "whitted:dispersion=3,fresnel=on,beer=on"}) {
            for (const WaveSplit::Wave& wave : three.waves()) {
                const Rgb seen = film_of(prism_and_lamp(glass, wave.nm, 0), renderer, 1).at(0, 0);
                const double passed = seen.g / wave.weight.g;
                EXPECT_GT(passed, 0.5) << glass << " " << wave.nm << renderer;
                EXPECT_LE(passed, 1.0);
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(seen[c], passed * wave.weight[c], 1e-6);
                }
                const Rgb beside =
                    film_of(prism_and_lamp(glass, wave.nm, 0.025), renderer, 1).at(0, 0);
                EXPECT_EQ(beside, Rgb{}) << glass << " " << wave.nm;
            }
        }
    }
}

Scene balls_before(const Material& material) {
    SceneMaker maker;
    maker.description().picture.background = {1, 1, 1};
    maker.add(ball({-0.6, 0, 0}, 0.7), maker.material(material));
    maker.add(ball({0.5, 0.3, -1}, 0.7), maker.material(matt({1, 1, 1})));
    maker.light(PointLight{.position = {3, 4, 5}});
    return maker.compile();
}

TEST(WhittedDispersion, ChangesNothingWhereNothingDisperses) {
    Material glass = glass_named("BK7");
    glass.dispersion.reset();
    const Scene scene = balls_before(glass);
    for (const char* more : {"", ",fresnel=on"}) {
        const Film off = film_of(scene, std::string("whitted:beer=off") + more, 24);
        const Film on = film_of(scene, std::string("whitted:beer=off,dispersion=5") + more, 24);
        for (int i = 0; i < 24 * 24; ++i) EXPECT_EQ(on.at(i % 24, i / 24), off.at(i % 24, i / 24));
    }
}

TEST(WhittedDispersion, WhiteSeenThroughFlintIsWhite) {
    SceneMaker maker;
    maker.description().picture.background = {0.7, 0.7, 0.7};
    maker.description().conventions.shading.max_depth = 60;  // all light inside comes out
    maker.add(ball({}, 1.5), maker.material(glass_named("SF11")));
    const Scene scene = maker.compile();
    for (const char* more : {"", ",fresnel=on"}) {
        const Film off = film_of(scene, std::string("whitted:beer=off") + more, 16);
        const Film on = film_of(scene, std::string("whitted:beer=off,dispersion=6") + more, 16);
        for (int i = 0; i < 256; ++i) {
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(on.at(i % 16, i / 16)[c], off.at(i % 16, i / 16)[c], 1e-6) << i << more;
            }
        }
    }
}

TEST(WhittedDispersion, RefusesTooFewAndTooManyWavelengths) {
    for (const char* count : {"1", "2", "65", "3.5", "-3"}) {
        EXPECT_THROW((void)make_renderer(std::string("whitted:dispersion=") + count), Error);
    }
    EXPECT_NO_THROW((void)make_renderer("whitted:dispersion=0"));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
