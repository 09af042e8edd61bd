#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "support/scene_maker.h"
#include "unit/renderers/lane_carpenter_scenes.h"
#include "unit/renderers/one_pixel.h"
#include "unit/renderers/unit_pixels.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::add_mixture;
using testing::closed_torus;
using testing::glowing;
using testing::scan_picture_of;
using testing::ScanPicture;
using testing::SceneMaker;
using testing::unit_pixels;
using testing::upright_square;

/// A sheet over [-32, 32]^2 that is a parabola in x, of height 4 in the middle.
BezierPatch arch(bool along_v = false) {
    BezierPatch patch;
    patch.degree_u = along_v ? 1 : 2;
    patch.degree_v = along_v ? 2 : 1;
    const Vec3 a{-32, -32, 0}, b{0, -32, 8}, c{32, -32, 0}, up{0, 64, 0};
    patch.points = along_v ? std::vector<Vec3>{a, b, c, a + up, b + up, c + up}
                           : std::vector<Vec3>{a, a + up, b, b + up, c, c + up};
    return patch;
}

TEST(LaneCarpenter, AFlatPatchIsOnePolygonAndCoversItsPixels) {
    SceneMaker maker;
    maker.add(upright_square(-2, 2, 0), maker.material(glowing({1, 0, 0})));
    const ScanPicture picture = scan_picture_of(maker, unit_pixels(8), 8);
    EXPECT_EQ(picture.counts.quads, 1u);
    EXPECT_EQ(picture.counts.split_u + picture.counts.split_v, 0u);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            const bool inside = x >= 2 && x < 6 && y >= 2 && y < 6;
            EXPECT_EQ(picture.film.at(x, y), (inside ? Rgb{1, 0, 0} : Rgb{0, 0, 1}));
        }
    }
}

TEST(LaneCarpenter, SplitsOnlyAlongTheDirectionThatIsNotFlat) {
    // The middle control point is 8 pixels off the chord; each halving leaves a quarter at most: 2,
    // then 0.5.
    for (const bool along_v : {false, true}) {
        SceneMaker maker;
        maker.add(arch(along_v));
        ScanLineOptions options;
        options.flatness = 0.5;
        const ScanPicture picture = scan_picture_of(maker, unit_pixels(80), 80, options);
        EXPECT_EQ(picture.counts.quads, 4u);
        EXPECT_EQ(along_v ? picture.counts.split_v : picture.counts.split_u, 3u);
        EXPECT_EQ(along_v ? picture.counts.split_u : picture.counts.split_v, 0u);
        options.split = SplitRule::Both;
        EXPECT_EQ(scan_picture_of(maker, unit_pixels(80), 80, options).counts.quads, 16u);
    }
}

/// Pixels of the bright ground between eight dark ones.
int ground_pixels(SceneMaker& maker, Cracks cracks, int views, std::uint64_t& counted) {
    constexpr int kSize = 192;
    Scene scene = compile_without_geometry(maker.description());
    scene.background = {1, 1, 1};
    int found = 0;
    RandomStream random(7);
    for (int k = 0; k < views; ++k) {
        const Vec3 direction{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const Vec3 from = 6.0 * normalize(direction);
        const Camera camera = look_along(from, -from, {0.1, 0.3, 0.9}, 0.7, 1.0);
        Film film(kSize, kSize, {0, 0, kSize, kSize});
        const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
        ScanLineOptions options;
        options.cracks = cracks;
        options.flatness = 1.0;
        options.find_cracks = true;
        counted += LaneCarpenter(options).render(job, film).scan_lines->crack_samples;
        for (int y = 1; y + 1 < kSize; ++y) {
            for (int x = 1; x + 1 < kSize; ++x) {
                int ground = 0;
                for (int n = 0; n < 9; ++n) {
                    ground += film.at(x + n % 3 - 1, y + n / 3 - 1) == scene.background;
                }
                found += ground == 1 && film.at(x, y) == scene.background;
            }
        }
    }
    return found;
}

TEST(LaneCarpenter, CracksShowUnlessTheyAreClosed) {
    SceneMaker maker;
    Material dark = glowing({0.1, 0, 0});
    dark.double_sided = false;  // else the far side is seen through a crack
    maker.add(closed_torus(), maker.material(dark));
    std::uint64_t counted = 0, none = 0;
    EXPECT_GT(ground_pixels(maker, Cracks::Show, 4, counted), 0);
    EXPECT_GT(counted, 0u);
    EXPECT_EQ(ground_pixels(maker, Cracks::Tighter, 2, none), 0);
    EXPECT_EQ(none, 0u);
    EXPECT_EQ(ground_pixels(maker, Cracks::Clark, 20, none), 0);
}

TEST(LaneCarpenter, TheToleranceThatClosesCracksDoesNotDependOnTheCrop) {
    constexpr int kSize = 8;
    BezierPatch folded;
    folded.degree_u = folded.degree_v = 2;
    folded.points = {{0.4, 0.7, 0.9},  {1.3, 0.7, 1.3},   {-1.4, -0.1, 1.3},
                     {0.4, 1.2, -1.2}, {-0.1, -0.8, 0.1}, {0.2, -1.5, -0.8},
                     {-0.7, 1.2, 0.8}, {-1.0, 0.9, -1.1}, {0.4, -1.1, -1.5}};
    SceneMaker maker;
    maker.add(std::move(folded), MaterialId{0});
    maker.light(PointLight{.position = {3, 4, 6}});
    const Scene scene = maker.compile();
    const OrthographicCamera camera{{0, 0, 6}, {0, 0, -1}, {3, 0, 0}, {0, 3, 0}};
    const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
    ScanLineOptions options;
    options.cracks = Cracks::Tighter;
    Film whole(kSize, kSize, {0, 0, kSize, kSize});
    const RenderReport report = LaneCarpenter(options).render(job, whole);
    ASSERT_GT(report.scan_lines->passes, 1u);
    for (const PixelBox& box : {PixelBox{0, 0, 8, 4}, PixelBox{0, 4, 8, 8}, PixelBox{2, 2, 4, 3}}) {
        Film crop(kSize, kSize, box);
        const auto counts = LaneCarpenter(options).render(job, crop).scan_lines;
        EXPECT_EQ(counts->flatness, report.scan_lines->flatness);
        for (int y = box.y0; y < box.y1; ++y) {
            for (int x = box.x0; x < box.x1; ++x) EXPECT_EQ(crop.at(x, y), whole.at(x, y));
        }
    }
}

TEST(LaneCarpenter, ThreadsAndCropsGiveTheSameBits) {
    SceneMaker maker;
    add_mixture(maker);
    const Scene scene = maker.compile();
    const Camera camera = look_along({0.4, 1.2, 5}, {-0.08, -0.24, -1}, {0, 1, 0}, 0.7, 1.0);
    for (const int samples : {1, 4}) {
        RenderJob job{.scene = scene,
                      .camera = camera,
                      .samples_per_pixel = samples,
                      .description = &maker.description()};
        Film one(70, 60, {0, 0, 70, 60}), many = one, crop(70, 60, {21, 13, 55, 50});
        job.control.threads = 1;
        const RenderReport first = LaneCarpenter().render(job, one);
        job.control.threads = 4;
        const RenderReport second = LaneCarpenter().render(job, many);
        (void)LaneCarpenter().render(job, crop);
        EXPECT_EQ(first.scan_lines->most_held, second.scan_lines->most_held);
        for (int y = 0; y < 60; ++y) {
            for (int x = 0; x < 70; ++x) {
                ASSERT_EQ(one.at(x, y), many.at(x, y));
                const PixelBox& box = crop.crop();
                if (x < box.x0 || x >= box.x1 || y < box.y0 || y >= box.y1) continue;
                ASSERT_EQ(one.at(x, y), crop.at(x, y)) << x << ',' << y;
            }
        }
    }
}

TEST(LaneCarpenter, CropsMayEndBetweenAPatchAndItsControlPoints) {
    SceneMaker maker;
    maker.add(Sphere{.center = {-0.875, -0.875, 1}, .radius = 0.625}, {},
              Affine::rotate({1, 0, 0}, 30 * kPi / 180));
    const Scene scene = maker.compile();
    const Camera camera = look_along({0.25, 0.0067, -5.4914}, {-0.247, 0.0063, 5.4624},
                                     {0.1, 0.2, 1}, 0.567, 48.0 / 36.0);
    for (const bool all_first : {false, true}) {
        for (const int samples : {1, 4}) {
            const RenderJob job{.scene = scene,
                                .camera = camera,
                                .samples_per_pixel = samples,
                                .description = &maker.description()};
            const LaneCarpenter renderer({.all_first = all_first});
            Film whole(48, 36, {0, 0, 48, 36});
            (void)renderer.render(job, whole);
            for (int begin = 0; begin < 36; begin += 5) {
                for (int end = begin + 1; end <= 36; ++end) {
                    Film crop(48, 36, {0, begin, 48, end});
                    (void)renderer.render(job, crop);
                    for (int y = begin; y < end; ++y) {
                        for (int x = 0; x < 48; ++x) {
                            ASSERT_EQ(whole.at(x, y), crop.at(x, y)) << begin << ' ' << end;
                        }
                    }
                }
            }
        }
    }
}

TEST(LaneCarpenter, ClarkGivesTheSamePictureFromMorePatches) {
    SceneMaker maker;
    maker.add(closed_torus());
    const Camera camera = look_along({2, -4, 3}, {-2, 4, -3}, {0, 0, 1}, 0.7, 1.0);
    ScanLineOptions options;
    const ScanPicture lazy = scan_picture_of(maker, camera, 200, options);
    options.all_first = true;
    const ScanPicture first = scan_picture_of(maker, camera, 200, options);
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) ASSERT_EQ(lazy.film.at(x, y), first.film.at(x, y));
    }
    EXPECT_EQ(lazy.counts.quads, first.counts.quads);
    EXPECT_GT(first.counts.most_held, 4 * lazy.counts.most_held);
    EXPECT_EQ(lazy.counts.lines.size(), 200u);
}

TEST(LaneCarpenter, RefusesByNameWhatIsNoPatch) {
    SceneMaker maker;
    (void)maker.material({});
    maker.add(Blob{});
    maker.add(Superellipsoid{});
    const ObjectIndex solid = maker.object("cut");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(solid);
    try {
        (void)scan_scene(maker.description(), compile_without_geometry(maker.description()), {});
        FAIL();
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        for (const char* name : {"blob", "superellipsoid", "'cut'"}) {
            EXPECT_NE(text.find(name), std::string::npos) << text;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
