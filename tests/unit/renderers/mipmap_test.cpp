// A checkerboard that extends to the horizon: the use case of mipmaps and ray cones.

#include <gtest/gtest.h>

#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

constexpr int kWidth = 96, kHeight = 64;

/// Two black and two white squares that repeat for ever over the plane y = 0, seen from above it;
/// with `mirror`, in an upright mirror that far behind, too; with `veil`, through half of it.
Scene checkerboard(TextureFilter filter, double mirror = 0, bool veil = false) {
    Image image(64, 64, 1);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) image.pixel(x, y)[0] = float((x / 32 + y / 32) % 2);
    }
    SceneMaker maker;
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    texture.filter = filter;
    maker.description().textures.push_back({"", texture, {}});
    Material m;
    m.emission = {{1, 1, 1}, TextureId{0}};
    maker.add(Plane{.point = {0.1, 0, 0.2}, .normal = {0, 1, 0}}, maker.material(m));
    if (mirror > 0) {
        Material silver;
        silver.reflective.color = {1, 1, 1};
        maker.add(Plane{.point = {0, 0, -mirror}, .normal = {0, 0, 1}}, maker.material(silver));
    }
    if (veil) {
        Material half;
        half.alpha_mode = AlphaMode::Blend;
        half.alpha.value = 0.5;
        maker.add(Plane{.point = {0, 0, 4}, .normal = {0, 0, 1}}, maker.material(half));
    }
    const double aspect = double(kWidth) / kHeight;
    maker.description().cameras[0].camera =
        look_along({0, 1, 5}, {0.3, -0.12, -1}, {0, 1, 0}, 0.8, aspect);
    return maker.compile();
}

Film render(const Scene& scene, int samples, const Whitted& renderer = Whitted{}) {
    Film film(kWidth, kHeight, {0, 0, kWidth, kHeight});
    RayCounters counters;
    const Camera& camera = scene.cameras[0].camera;
    const RenderJob job{.scene = scene,
                        .camera = camera,
                        .samples_per_pixel = samples,
                        .cone = eye_cone(camera, kHeight, samples)};
    renderer.render_tile(job, {0, 0, kWidth, kHeight}, film, counters);
    return film;
}

/// Root of the mean squared difference over some rows.
double rmse(const Film& a, const Film& b, int y0 = 0, int y1 = kHeight) {
    double sum = 0;
    for (int y = y0; y < y1; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double d = a.at(x, y).r - b.at(x, y).r;
            sum += d * d;
        }
    }
    return std::sqrt(sum / ((y1 - y0) * kWidth));
}

/// The board by 1024 samples per pixel.
const Film& truth() {
    static const Film film = render(checkerboard(TextureFilter::Bilinear), 1024);
    return film;
}

int horizon_row(const Film& film) {
    int y = 0;
    while (y < kHeight && film.at(kWidth / 2, y).r == 0.0) ++y;
    return y;
}

TEST(Mipmaps, OneSampleIsAsGoodAsSixteenWithoutThem) {
    const Scene plain = checkerboard(TextureFilter::Bilinear);
    const Scene mipmapped = checkerboard(TextureFilter::Mipmapped);
    const Film& reference = truth();
    const double one = rmse(render(plain, 1), reference);
    const double sixteen = rmse(render(plain, 16), reference);
    const double filtered = rmse(render(mipmapped, 1), reference);
    RecordProperty("rmse_bilinear_1", std::to_string(one));
    RecordProperty("rmse_bilinear_16", std::to_string(sixteen));
    RecordProperty("rmse_mipmapped_1", std::to_string(filtered));
    EXPECT_LE(filtered, sixteen);
    EXPECT_LT(filtered, 0.25 * one);
}

TEST(Mipmaps, ThereIsNoMoireBelowTheHorizon) {
    const Scene plain = checkerboard(TextureFilter::Bilinear);
    const Film& reference = truth();
    const Film filtered = render(checkerboard(TextureFilter::Mipmapped), 1);
    const int top = horizon_row(filtered) + 1;
    const double with_moire = rmse(render(plain, 1), reference, top, top + 5);
    const double without = rmse(filtered, reference, top, top + 5);
    EXPECT_GT(with_moire, 0.3);
    EXPECT_LT(without, 0.05);
}

TEST(Mipmaps, ConesGoOnThroughAMirror) {
    const Scene plain = checkerboard(TextureFilter::Bilinear, 20);
    const Scene mipmapped = checkerboard(TextureFilter::Mipmapped, 20);
    const Film reference = render(plain, 1024);
    EXPECT_LE(rmse(render(mipmapped, 1), reference), rmse(render(plain, 16), reference));
}

TEST(Mipmaps, MoreSamplesNarrowTheCones) {
    const Scene mipmapped = checkerboard(TextureFilter::Mipmapped);
    EXPECT_LT(rmse(render(mipmapped, 16), truth()), rmse(render(mipmapped, 1), truth()));
}

TEST(Mipmaps, BehindAVeilHasTheConesOfItsOwnRays) {
    // A cone that has grown behind the veil must not be that of the next ray.
    const Scene scene = checkerboard(TextureFilter::Mipmapped, 0, true);
    const Film at_once = render(scene, 1, Whitted(std::size_t{kWidth * kHeight}));
    for (const std::size_t rays : {1, 100}) {
        EXPECT_EQ(rmse(render(scene, 1, Whitted(rays)), at_once), 0.0) << rays;
    }
    EXPECT_GT(rmse(at_once, render(checkerboard(TextureFilter::Mipmapped), 1)), 0.01);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
