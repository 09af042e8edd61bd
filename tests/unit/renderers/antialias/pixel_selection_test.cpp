#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/base/error.h"
#include "alhazen/renderers/core/antialias_settings.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

struct Shot {
    Film film;
    RenderReport report;
    Shot(int width, int height) : film(width, height, {0, 0, width, height}) {}
};

/// `step` 0: a ray for each pixel.
Shot shot(const Scene& scene, int width, int height, int step, double threshold = 0.05,
          int threads = 2) {
    Shot result(width, height);
    RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    AntialiasSettings settings;
    settings.step = step;
    settings.threshold = threshold;
    if (step > 0) job.antialias = &settings;
    job.control.threads = threads;
    result.report = Whitted{}.render(job, result.film);
    return result;
}
std::uint64_t rays(const Shot& s) {
    return s.report.counters[RayKind::Eye].cast;
}
double largest_difference(const Rgb& a, const Rgb& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}
bool same_pixels(const Film& a, const Film& b) {
    const PixelBox& crop = a.crop();
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x) {
            if (a.at(x, y) != b.at(x, y)) return false;
        }
    }
    return true;
}

/// A matt ball and a mirror, lit from the side.
Scene balls() {
    testing::SceneMaker maker;
    Material matt, mirror;
    matt.diffuse.color = {0.8, 0.5, 0.3};
    mirror.reflective.color = {0.9, 0.9, 0.9};
    maker.add(Sphere{{-0.9, 0, 0}, 0.8}, maker.material(matt));
    maker.add(Sphere{{0.9, 0, 0}, 0.8}, maker.material(mirror));
    maker.light(DirectionalLight{normalize(Vec3{-1, 1, 1}), {1, 1, 1}});
    return maker.compile();
}

TEST(PixelSelection, AStepOfOneIsThePictureItself) {
    const Scene scene = balls();
    const Shot all = shot(scene, 40, 31, 0), one = shot(scene, 40, 31, 1);
    EXPECT_EQ(rays(one), 40U * 31U);
    EXPECT_TRUE(same_pixels(all.film, one.film));
}

TEST(PixelSelection, NothingToBeSeenTakesTheFirstRaysOnly) {
    testing::SceneMaker maker;
    maker.add(Sphere{{0, 0, 100}, 0.1});  // behind the eye
    const Scene scene = maker.compile();
    // 17 = 2 * 8 + 1 columns, rows at 0, 8 and 11.
    EXPECT_EQ(rays(shot(scene, 17, 12, 8)), 9U);
    EXPECT_EQ(rays(shot(scene, 1, 1, 8)), 1U);
    EXPECT_EQ(rays(shot(scene, 1, 20, 8)), 4U);
    EXPECT_EQ(rays(shot(scene, 20, 1, 64)), 2U);
}

TEST(PixelSelection, FewRaysShowTheSamePicture) {
    const Scene scene = balls();
    const int width = 160, height = 120;
    const Shot all = shot(scene, width, height, 0), some = shot(scene, width, height, 8);
    EXPECT_LT(rays(some), std::uint64_t(width * height) * 3 / 10);
    int far = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            far += largest_difference(all.film.at(x, y), some.film.at(x, y)) > 0.1;
        }
    }
    EXPECT_LT(far, width * height / 200);
}

TEST(PixelSelection, PixelsAreOffByTheThresholdWhereShadesAreSmooth) {
    // A matt plane before the eye, lit from near by: shades bend, without edges.
    testing::SceneMaker maker;
    Material matt;
    matt.diffuse.color = {0.9, 0.9, 0.9};
    maker.add(Plane{{0, 0, 0}, {0, 0, 1}}, maker.material(matt));
    maker.light(PointLight{{0.5, 0.2, 1.0}, {1, 1, 1}});
    const Scene scene = maker.compile();
    const Shot all = shot(scene, 128, 96, 0);
    std::uint64_t before = 0;
    for (const double threshold : {0.2, 0.05, 0.0125}) {
        const Shot some = shot(scene, 128, 96, 16, threshold);
        double worst = 0;
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 128; ++x) {
                worst = std::max(worst, largest_difference(all.film.at(x, y), some.film.at(x, y)));
            }
        }
        EXPECT_LT(worst, threshold);
        EXPECT_GT(worst, 0.0);
        EXPECT_GT(rays(some), before);
        before = rays(some);
    }
    EXPECT_LT(before, 128U * 96U);
}

TEST(PixelSelection, ThingsOfOneShadeAreToldApart) {
    // Two black balls: the border between them has rays on both sides.
    testing::SceneMaker maker;
    const MaterialId black = maker.material({});
    maker.add(Sphere{{-0.5, 0, 0}, 1.0}, black);
    maker.add(Sphere{{0.5, 0, 0}, 1.0}, black);
    const Scene two = maker.compile();
    testing::SceneMaker other;
    other.add(Sphere{{-0.5, 0, 0}, 1.0}, other.material({}));
    EXPECT_GT(rays(shot(two, 128, 128, 8)), rays(shot(other.compile(), 128, 128, 8)) + 128);
}

TEST(PixelSelection, ThreadsAreNotSeen) {
    const Scene scene = balls();
    const Shot one = shot(scene, 150, 99, 8, 0.03, 1), two = shot(scene, 150, 99, 8, 0.03, 2);
    EXPECT_EQ(rays(one), rays(two));
    EXPECT_TRUE(same_pixels(one.film, two.film));
}

TEST(PixelSelection, AnEdgeBetweenCellsIsFoundBySmallerNeighbours) {
    // A post that no ray of the first grid meets next to a ball that is divided: the sides of the
    // cells next to it show it.
    testing::SceneMaker maker;
    Material bright;
    bright.emission.color = {1, 1, 1};
    const MaterialId white = maker.material(bright);
    maker.add(Sphere{{0, 0, 0}, 0.5}, white);
    maker.add(Cylinder{{-3, 0.06, 0}, {3, 0.06, 0}, 0.02}, white);
    const Scene scene = maker.compile();
    const Shot all = shot(scene, 256, 192, 0), some = shot(scene, 256, 192, 8);
    int missed = 0, lit = 0;
    for (int y = 0; y < 192; ++y) {
        for (int x = 0; x < 256; ++x) {
            lit += all.film.at(x, y).g > 0.5;
            missed += largest_difference(all.film.at(x, y), some.film.at(x, y)) > 0.5;
        }
    }
    EXPECT_GT(lit, 1000);
    EXPECT_LT(missed, lit / 100);
}

TEST(PixelSelection, SettingsAreChecked) {
    EXPECT_EQ(parse_antialias("pixel_selection").step, 8);
    EXPECT_EQ(parse_antialias("pixel_selection:step=16,threshold=0.1").step, 16);
    EXPECT_THROW(static_cast<void>(parse_antialias("pixel_selection:step=0")), Error);
    EXPECT_THROW(static_cast<void>(parse_antialias("pixel_selection:depth=2")), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
