#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/sampling/samplers/sampler.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::floor_from_above;
using testing::matt;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

struct Layered {
    Film film;
    FilmLayers layers;
    [[nodiscard]] Rgb at(const std::string& name, int x, int y) const {
        const auto value = [&](const char* channel) {
            const auto& v = layers.find(name + channel)->values;
            return static_cast<double>(
                v[std::size_t(y) * std::size_t(film.frame_width()) + std::size_t(x)]);
        };
        return {value(".R"), value(".G"), value(".B")};
    }
};

Layered layered(const Scene& scene, const std::string& filter, int side, int samples) {
    SamplingPlan plan;
    plan.filter = find_filter(filter);
    plan.radius = plan.filter->radius;
    AovFilm aovs(parse_aovs("emission,direct,indirect,diffuse,specular,transmission,variance"),
                 {0, 0, side, side});
    Layered result{Film(side, side, {0, 0, side, side}), {}};
    RenderJob job{.scene = scene,
                  .camera = scene.cameras[0].camera,
                  .samples_per_pixel = samples,
                  .aovs = &aovs,
                  .sampling = &plan};
    EXPECT_TRUE(make_renderer("path_tracing")->render(job, result.film).complete());
    Film without(side, side, {0, 0, side, side});
    job.aovs = nullptr;
    EXPECT_TRUE(make_renderer("path_tracing")->render(job, without).complete());
    for (int i = 0; i < side * side; ++i) {
        EXPECT_EQ(result.film.at(i % side, i / side), without.at(i % side, i / side)) << i;
    }
    result.layers = aovs.layers();
    return result;
}

/// A room with a light, a matt and glossy floor, a mirror and glass.
Scene mixed_scene() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0, -3.8, 1}, {0, 1, 0}, {0, 0, 1}, 0.65, 1.0);
    Material glossy = matt({0.4, 0.3, 0.2});
    glossy.metallic_roughness.emplace();
    glossy.metallic_roughness->base_color.color = {0.5, 0.4, 0.3};
    glossy.metallic_roughness->metallic.value = 0;
    glossy.metallic_roughness->roughness.value = 0.4;
    Material mirror;
    mirror.reflective.color = {0.9, 0.9, 0.9};
    Material glass;
    glass.dielectric.emplace();
    glass.index.value = 1.5;
    maker.add(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), maker.material(glossy));
    maker.add(rectangle({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}), maker.material(matt({0.7, 0.7, 0.7})));
    maker.add(rectangle({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}),
              maker.material(shining({1, 2, 3}, {0.5, 0.5, 0.5})));
    maker.add(ball({-0.4, 0.2, 0.4}, 0.4), maker.material(glass));
    maker.add(ball({0.5, 0.2, 0.4}, 0.4), maker.material(mirror));
    return maker.compile();
}

TEST(LightLayers, TwoWaysOfDividingTheLightSumToThePicture) {
    const Scene scene = mixed_scene();
    for (const char* filter : {"box", "mitchell"}) {
        const Layered seen = layered(scene, filter, 12, 16);
        for (int y = 0; y < 12; ++y) {
            for (int x = 0; x < 12; ++x) {
                const Rgb& whole = seen.film.at(x, y);
                const Rgb emission = seen.at("emission", x, y);
                const Rgb by_order = emission + seen.at("direct", x, y) + seen.at("indirect", x, y);
                const Rgb by_kind = emission + seen.at("diffuse", x, y) +
                                    seen.at("specular", x, y) + seen.at("transmission", x, y);
                for (int i = 0; i < 3; ++i) {
                    EXPECT_NEAR(by_order[i], whole[i], 1e-5) << filter << x << " " << y;
                    EXPECT_NEAR(by_kind[i], whole[i], 1e-5) << filter << x << " " << y;
                }
            }
        }
    }
}

TEST(LightLayers, EachHoldsWhatItsNameSays) {
    const Layered seen = layered(mixed_scene(), "box", 32, 16);
    // The wall: matt. The glass ball, and what the mirror ball shows of the ceiling.
    const auto pixel = [&](const char* name, double x, double z) {
        const double half = std::tan(0.325) * 3.8;
        return seen.at(name, static_cast<int>(16 + 16 * x / half),
                       static_cast<int>(16 - 16 * (z - 1) / half));
    };
    EXPECT_EQ(pixel("specular", 0, 1.1).g, 0.0);
    EXPECT_EQ(pixel("transmission", 0, 1.1).g, 0.0);
    EXPECT_GT(pixel("diffuse", 0, 1.1).g, 0.1);
    EXPECT_GT(pixel("direct", 0, 1.1).g, pixel("indirect", 0, 1.1).g);
    EXPECT_EQ(pixel("diffuse", 0.5, 0.65).g, 0.0);
    EXPECT_GT(pixel("specular", 0.5, 0.65).g, 0.1);
    EXPECT_GT(pixel("transmission", -0.4, 0.4).g, pixel("specular", -0.4, 0.4).g);
    EXPECT_EQ(pixel("emission", 0, 1.1).g, 0.0);
}

/// Variances by samples that are independent are those of pictures by other seeds.
TEST(LightLayers, TheVarianceIsThatOfPictures) {
    SceneMaker maker = floor_from_above(0.2);
    maker.add(ball({0, 0, 1}, 0.3), maker.material(shining({3, 3, 3})));
    maker.description().picture.background = Rgb{0.5, 0.5, 0.5};
    const Scene scene = maker.compile();
    SamplingPlan plan;
    plan.sampler = find_sampler("independent");
    double estimated = 0, sum = 0, squares = 0;
    constexpr int kRuns = 400;
    for (int run = 0; run < kRuns; ++run) {
        AovFilm aovs(parse_aovs("variance"), {0, 0, 1, 1});
        Film film(1, 1, {0, 0, 1, 1});
        const RenderJob job{.scene = scene,
                            .camera = scene.cameras[0].camera,
                            .samples_per_pixel = 64,
                            .seed = std::uint64_t(run),
                            .aovs = &aovs,
                            .sampling = &plan};
        EXPECT_TRUE(make_renderer("path_tracing")->render(job, film).complete());
        estimated += aovs.layers().find("variance.G")->values[0] / kRuns;
        sum += film.at(0, 0).g;
        squares += film.at(0, 0).g * film.at(0, 0).g;
    }
    const double variance = (squares - sum * sum / kRuns) / (kRuns - 1);
    // A variance from 400 runs has a standard deviation of 7 %.
    EXPECT_NEAR(estimated / variance, 1.0, 0.25);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
