#include <gtest/gtest.h>

#include <map>
#include <set>

#include "alhazen/base/error.h"
#include "alhazen/renderers/antialias/adaptive_grid.h"
#include "alhazen/renderers/antialias/scene_objects.h"
#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/sampling/random.h"
#include "unit/renderers/antialias/antialiased_picture.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::AntialiasedPicture;
using testing::bright;
using testing::kPixel;
using testing::kSide;
using testing::picture;

/// Runs the grid to its end with the shade of a place in pixels.
template <class Shade>
std::size_t fill(AdaptiveGrid& grid, Shade&& shade) {
    std::size_t rays = 0;
    const double step = std::ldexp(1.0, -grid.depth());
    do {
        for (std::size_t i = 0; const GridPoint& p : grid.points()) {
            grid.shades()[i++] = shade(step * p.x, step * p.y);
        }
        rays += grid.points().size();
    } while (grid.refine(nullptr));
    return rays;
}

TEST(AdaptiveGrid, TheExampleOfTheTextHas16RaysAndItsFormula) {
    // Foley, van Dam, Feiner and Hughes, section 15.10.4: A B C above D E F are the corners of two
    // pixels; the right one is divided by G H I J K, its upper right quarter by L M N O P.
    std::map<std::pair<double, double>, char> names{
        {{0, 0}, 'A'},      {{1, 0}, 'B'},       {{2, 0}, 'C'},    {{0, 1}, 'D'},
        {{1, 1}, 'E'},      {{2, 1}, 'F'},       {{1.5, 0}, 'G'},  {{1, 0.5}, 'H'},
        {{1.5, 0.5}, 'I'},  {{2, 0.5}, 'J'},     {{1.5, 1}, 'K'},  {{1.75, 0}, 'L'},
        {{1.5, 0.25}, 'M'}, {{1.75, 0.25}, 'N'}, {{2, 0.25}, 'O'}, {{1.75, 0.5}, 'P'}};
    std::map<char, double> v;
    for (char c = 'A'; c <= 'P'; ++c) v[c] = 0.2 + 0.04 * random_at(1, 2, std::uint64_t(c), 3);
    v['C'] = 0.9;
    AdaptiveGrid grid(2, 1, {.threshold = 0.05, .depth = 2, .weigh = false, .neighbours = false});
    std::set<char> asked;
    const std::size_t rays = fill(grid, [&](double x, double y) {
        const auto found = names.find({x, y});
        EXPECT_NE(found, names.end()) << x << " " << y;
        EXPECT_TRUE(asked.insert(found->second).second) << found->second << " is traced twice";
        const double shade = v[found->second];
        return Rgb{shade, shade, shade};
    });
    EXPECT_EQ(rays, 16U);
    EXPECT_EQ(asked.size(), 16U);
    const auto mean = [&](const char* four) {
        return (v[four[0]] + v[four[1]] + v[four[2]] + v[four[3]]) / 4;
    };
    EXPECT_NEAR(grid.pixels()[0].g, mean("ABDE"), 1e-15);
    EXPECT_NEAR(grid.pixels()[1].g,
                (mean("BGHI") + (mean("GLMN") + mean("LCNO") + mean("MNIP") + mean("NOPJ")) / 4 +
                 mean("HIEK") + mean("IJKF")) /
                    4,
                1e-15);
    EXPECT_EQ(grid.points_of_pixels()[0] + grid.points_of_pixels()[1], 16U);
}

TEST(AdaptiveGrid, NoPointIsAskedForTwiceAndAreasAreExact) {
    // A disc: the pixels that its edge crosses are divided to the depth.
    AdaptiveGrid grid(19, 11, {.threshold = 0.05, .depth = 6, .weigh = false});
    std::set<std::pair<double, double>> asked;
    fill(grid, [&](double x, double y) {
        EXPECT_TRUE(asked.insert({x, y}).second) << x << " " << y;
        const double inside = std::hypot(x - 9.3, y - 5.2) < 4.1 ? 1.0 : 0.0;
        return Rgb{inside, 0.5, 0.0};
    });
    double area = 0;
    for (const Rgb& c : grid.pixels()) {
        area += c.r;
        EXPECT_EQ(c.g, 0.5);
    }
    EXPECT_NEAR(area, 3.14159265 * 4.1 * 4.1, 0.02);
    EXPECT_LT(asked.size(), 20U * 12U + 60U * 4U * 64U);
}

TEST(AdaptiveGrid, ShadesAreWeighedByTheAreaOfTheirCell) {
    // An edge of height 0.5: a cell of level k may change its pixel by 0.5 / 4^k.
    const auto edge = [](double x, double) {
        const double v = x < 0.3 ? 0.2 : 0.7;
        return Rgb{v, v, v};
    };
    for (const int level : {1, 2, 3}) {
        AdaptiveGrid grid(1, 1, {.threshold = 0.51 * std::pow(4.0, -level), .depth = 8});
        fill(grid, edge);
        for (std::size_t k = 0; k < grid.divided().size(); ++k) {
            EXPECT_EQ(grid.divided()[k], k < std::size_t(level) ? 1U << k : 0U)
                << level << ' ' << k;
        }
    }
    // What lies beyond 1 in all of a pixel is not shown.
    AdaptiveGrid bright(1, 1, {.threshold = 0.02, .depth = 8});
    EXPECT_EQ(fill(bright, [](double x, double) { return Rgb{1 + x, 3, 1 + 9 * x}; }), 4U);
}

TEST(AdaptiveGrid, ACellSeesTheRaysOfItsNeighboursOnItsSides) {
    // A bar that enters the left pixel by the middle of its right side, and passes its corners by.
    const auto bar = [](double x, double y) {
        const double v = (x > 0.3 && std::abs(y - 0.45) < 0.2) || x > 1.3 ? 1.0 : 0.0;
        return Rgb{v, v, v};
    };
    const AntialiasSettings alone{.threshold = 0.001, .depth = 7, .neighbours = false};
    AdaptiveGrid blind(2, 1, alone);
    fill(blind, bar);
    EXPECT_EQ(blind.pixels()[0].g, 0.0);
    EXPECT_NEAR(blind.pixels()[1].g, 0.7 + 0.3 * 0.4, (1 + 2 * 0.3) / 64);
    AdaptiveGrid grid(2, 1, {.threshold = 0.001, .depth = 7});
    fill(grid, bar);
    // Edges along the grid: each is off by at most half of a cell of 1 / 32 pixel.
    EXPECT_NEAR(grid.pixels()[0].g, 0.7 * 0.4, (2 * 0.7 + 0.4) / 64);
    EXPECT_NEAR(grid.pixels()[1].g, 0.7 + 0.3 * 0.4, (1 + 2 * 0.3) / 64);
}

TEST(AdaptiveGrid, APixelBesideADividedOneShowsItsCentre) {
    // A disc in the middle pixel, met by no corner and on no side; an edge in the right one.
    const auto shade = [](double x, double y) {
        const double v = std::hypot(x - 1.5, y - 0.5) < 0.3 || x > 2.47 ? 1.0 : 0.0;
        return Rgb{v, v, v};
    };
    AdaptiveGrid grid(4, 1, {.threshold = 0.001, .depth = 6});
    std::set<std::pair<double, double>> asked;
    fill(grid, [&](double x, double y) {
        EXPECT_TRUE(asked.insert({x, y}).second) << x << ' ' << y;
        return shade(x, y);
    });
    EXPECT_NEAR(grid.pixels()[1].g, 3.14159265 * 0.09, 0.005);
    EXPECT_NEAR(grid.pixels()[2].g, 0.53, 0.02);  // along the grid
    EXPECT_EQ(grid.pixels()[3].g, 1.0);
    EXPECT_TRUE(asked.contains({0.5, 0.5}));  // next to the disc's
    std::uint64_t points = 0;
    for (const std::uint64_t n : grid.points_of_levels()) points += n;
    EXPECT_EQ(points, asked.size());
}

TEST(AdaptiveGrid, ErrorsFollowTheThresholdAndRaysTheEdge) {
    // A disc. Some 1 / sqrt(threshold) cells lie along an edge, each off by half the threshold at
    // most; where it is askew their errors have different signs.
    for (const double threshold : {0.02, 0.005}) {
        AdaptiveGrid grid(48, 48, {.threshold = threshold, .depth = 8});
        const double cx = 23.7, cy = 24.2, r = 20.3;
        const std::size_t rays = fill(grid, [&](double x, double y) {
            const double v = std::hypot(x - cx, y - cy) < r ? 1.0 : 0.0;
            return Rgb{v, v, v};
        });
        double sum = 0;
        for (int j = 0; j < 48; ++j) {
            for (int i = 0; i < 48; ++i) {
                double area = 0;  // columns of the disc in the pixel
                for (int k = 0; k < 256; ++k) {
                    const double dx = i + (k + 0.5) / 256 - cx;
                    const double half = std::sqrt(std::max(0.0, r * r - dx * dx));
                    area += std::clamp(cy + half, double(j), j + 1.0) -
                            std::clamp(cy - half, double(j), j + 1.0);
                }
                const double off = grid.pixels()[std::size_t(48 * j + i)].g - area / 256;
                EXPECT_LT(std::abs(off), 0.5 * std::sqrt(threshold));
                sum += off * off;
            }
        }
        EXPECT_LT(std::sqrt(sum / (48 * 48)), 0.25 * threshold);
        EXPECT_LT(rays, 49U * 49U + 160U * std::size_t(10 / std::sqrt(threshold)));
    }
}

TEST(AdaptiveGrid, EqualShadesNeedTheCornersOnly) {
    AdaptiveGrid grid(37, 23, {.threshold = 0.0, .depth = 8});
    EXPECT_EQ(fill(grid, [](double, double) { return Rgb{0.3, 7.0, 0.1}; }), 38U * 24U);
    for (const Rgb& c : grid.pixels()) EXPECT_EQ(c, (Rgb{0.3, 7.0, 0.1}));
}

TEST(AdaptiveGrid, LeavesOutWhatIsNotFinite) {
    AdaptiveGrid grid(1, 1, {.threshold = 0.1, .depth = 0});
    fill(grid, [](double x, double y) {
        const double bad = x + y > 1.5 ? std::numeric_limits<double>::quiet_NaN() : 0.5;
        return Rgb{bad, bad, bad};
    });
    EXPECT_EQ(grid.pixels()[0], (Rgb{0.5, 0.5, 0.5}));
}

Vec3 random_place(std::uint64_t i) {
    const auto at = [&](std::uint64_t k) { return 3.0 * (random_at(11, i, k, 0) - 0.5); };
    return {0.7 * at(0), 0.7 * at(1), at(2)};
}

TEST(Antialias, SpheresOfATwentiethOfAPixelAreAllMet) {
    testing::SceneMaker maker;
    const MaterialId light = bright(maker);
    for (std::uint64_t i = 0; i < 40; ++i) {
        const Vec3 c = random_place(i);
        maker.add(Sphere{c, 0.025 * kPixel * (5 - c.z) / 5}, light);
    }
    const Scene scene = maker.compile("wide_bvh");
    const AntialiasedPicture with = picture(scene, {.depth = 5});
    EXPECT_EQ(with.counts().objects, 40U);
    EXPECT_EQ(with.counts().met, 40U);
    EXPECT_EQ(with.counts().below_depth, 0U);
    EXPECT_EQ(picture(scene, {.depth = 5, .weigh = false, .neighbours = false}).counts().met, 40U);
    const AntialiasedPicture without = picture(scene, {.depth = 5, .guarantee = false});
    EXPECT_FALSE(without.counts().guarantee);
    EXPECT_LT(without.counts().total_points(), with.counts().total_points() / 4);
}

TEST(Antialias, ObjectsBelowTheDepthAreCountedAndNamed) {
    testing::SceneMaker maker;
    const MaterialId light = bright(maker);
    maker.add(Sphere{{0.3, 0.4, 0}, 0.6}, light);
    maker.add(Sphere{{-1.03, -0.77, 0}, 1e-3 * kPixel}, light);
    const Scene scene = maker.compile();
    const AntialiasedPicture p = picture(scene, {.depth = 3});
    EXPECT_EQ(p.counts().met, 1U);
    EXPECT_EQ(p.counts().sought, 1U);
    EXPECT_EQ(p.counts().below_depth, 1U);
    ASSERT_EQ(p.counts().unmet.size(), 1U);
    EXPECT_EQ(p.counts().unmet[0].part, 1U);
    EXPECT_LE(p.counts().below_depth_pixels, 4U);
    EXPECT_EQ(int(p.counts().unmet[0].x), int(8 - 1.03 / kPixel));
    EXPECT_EQ(int(p.counts().unmet[0].y), int(8 + 0.77 / kPixel));
}

TEST(Antialias, WhatLiesBehindSomethingIsNotLookedFor) {
    testing::SceneMaker maker;
    const MaterialId light = bright(maker);
    maker.add(Sphere{{0, 0, 0}, 1.0}, light);
    for (std::uint64_t i = 0; i < 20; ++i) {
        maker.add(Sphere{{0.1 * random_place(i).x, 0.1 * random_place(i).y, -3}, 0.001}, light);
    }
    const AntialiasedPicture p = picture(maker.compile(), {.depth = 4});
    EXPECT_EQ(p.counts().sought, 0U);
    EXPECT_EQ(p.counts().met, 1U);
}

TriangleMesh two_slivers(double size) {
    TriangleMesh mesh;
    for (const double x : {-0.413, 0.731}) {
        for (const Vec3& p : {Vec3{x, 0.3, 0}, Vec3{x + size, 0.3, 0}, Vec3{x, 0.3 + size, 0}}) {
            mesh.triangles.resize(mesh.positions.size() / 3 + 1);
            mesh.triangles.back()[mesh.positions.size() % 3] =
                static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(p);
        }
    }
    return mesh;
}

TEST(Antialias, PiecesOfMeshesSolidsAndNestedInstancesAreObjects) {
    testing::SceneMaker maker;
    const MaterialId light = bright(maker);
    const double tiny = 0.08 * kPixel;
    maker.add(maker.mesh(two_slivers(tiny)), light);
    const ObjectIndex solid = maker.object("solid");
    maker.description().objects[static_cast<std::size_t>(solid)].combine = Combine::Difference;
    maker.add(Sphere{{0, 0, 0}, tiny}, light, {}, solid);
    maker.add(Sphere{{0, 0, -2 * tiny}, 1.5 * tiny}, light, {}, solid);
    const ObjectIndex grain = maker.object("grain"), pair = maker.object("pair");
    maker.add(Sphere{{0, 0, 0}, tiny}, light, {}, grain);
    maker.add(grain, light, Affine::translate({0.317, 0, 0}), pair);
    maker.add(grain, light, Affine::translate({-0.317, 0.011, 0}), pair);
    for (const double y : {-0.9, -1.27, 1.11}) {
        maker.add(solid, light, Affine::translate({y, y, 0}));
        maker.add(pair, light, Affine::translate({0.05, y, 0.1}));
    }
    const Scene scene = maker.compile("wide_bvh");
    const SceneObjects objects(*scene.aggregate);
    EXPECT_EQ(objects.objects().size(), 2U + 3U + 6U);
    const AntialiasedPicture p = picture(scene, {.depth = 6});
    EXPECT_EQ(p.counts().objects, 11U);
    EXPECT_EQ(p.counts().met, 11U);
    EXPECT_EQ(p.counts().below_depth, 0U);
    // With room for fewer objects, instances are objects.
    EXPECT_EQ(SceneObjects(*scene.aggregate, 9).objects().size(), 2U + 3U + 3U);
}

TEST(Antialias, ThreadsChangeNoBitAndNoCount) {
    testing::SceneMaker maker;
    const MaterialId light = bright(maker);
    for (std::uint64_t i = 0; i < 30; ++i) {
        maker.add(Sphere{random_place(i), i % 3 == 0 ? 0.3 : 0.004}, light);
    }
    const Scene scene = maker.compile("wide_bvh");
    const auto same = [&](const Renderer& renderer) {
        const AntialiasedPicture one = picture(scene, {}, renderer, 1);
        const AntialiasedPicture four = picture(scene, {}, renderer, 4);
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) EXPECT_EQ(one.film.at(x, y), four.film.at(x, y));
        }
        EXPECT_EQ(one.report.counters.total_cast(), four.report.counters.total_cast());
        EXPECT_EQ(one.report.counters[RayKind::Eye].cast, one.counts().eye_rays());
        EXPECT_EQ(one.counts().searching, four.counts().searching);
        EXPECT_EQ(one.counts().met, four.counts().met);
    };
    same(Whitted{});
    same(RayCasting{});
}

TEST(Antialias, WholeScenesOfOneSolidAndEndlessShapes) {
    testing::SceneMaker maker;
    const MaterialId light = bright(maker);
    maker.description().objects[0].combine = Combine::Union;
    maker.add(Sphere{{0, 0, 0}, 0.5}, light);
    maker.add(Sphere{{0.5, 0, 0}, 0.5}, light);
    EXPECT_EQ(picture(maker.compile(), {}).counts().met, 1U);
    testing::SceneMaker endless;
    endless.add(Plane{{0, -1, 0}, {0, 1, 0}}, bright(endless));
    const AntialiasedPicture p = picture(endless.compile(), {});
    EXPECT_EQ(p.counts().unbounded, 1U);
    EXPECT_EQ(p.counts().below_depth, 0U);
}

TEST(Antialias, SettingsAreChecked) {
    EXPECT_EQ(parse_antialias("whitted").depth, 4);
    const AntialiasSettings s =
        parse_antialias("whitted:threshold=0.1,depth=2,guarantee=off,weigh=off,neighbours=off");
    EXPECT_FALSE(s.weigh);
    EXPECT_FALSE(s.neighbours);
    EXPECT_EQ(s.threshold, 0.1);
    EXPECT_EQ(s.depth, 2);
    EXPECT_FALSE(s.guarantee);
    EXPECT_FALSE(s.behind_all);
    EXPECT_TRUE(parse_antialias("whitted:guarantee=all").behind_all);
    for (const char* bad :
         {"", "cook", "whitted:depth=9", "whitted:depth=1.5", "whitted:x=1", "whitted:threshold=-1",
          "whitted:threshold=nan", "whitted:guarantee=2", "whitted:weigh=no"}) {
        EXPECT_THROW((void)parse_antialias(bad), Error) << bad;
    }
    EXPECT_TRUE(Whitted{}.answers_single_rays());
    EXPECT_FALSE(LaneCarpenter(ScanLineOptions{}).answers_single_rays());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
