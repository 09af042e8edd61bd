#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/renderers/lane_carpenter/edge_line.h"
#include "alhazen/renderers/lane_carpenter/patch_surface.h"
#include "alhazen/renderers/lane_carpenter/scan_scene.h"
#include "alhazen/renderers/lane_carpenter/screen_view.h"
#include "alhazen/renderers/lane_carpenter/subdivision.h"
#include "alhazen/sampling/random.h"
#include "alhazen/simd/targets.h"
#include "unit/renderers/unit_pixels.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::unit_pixels;

TEST(ScreenView, ProjectsAsComputedByHand) {
    const PerspectiveCamera camera{{0, 0, 5}, {0, 0, -1}, {2, 0, 0}, {0, 2, 0}};
    const ScreenView view(camera, 200, 100, 10.0);
    // 2 before the eye; 1 of 4 to the right of the middle, 1/2 of 4 above.
    const HomogeneousPoint p = view.on_screen(homogeneous({1, 0.5, 3}));
    EXPECT_DOUBLE_EQ(p.x / p.w, 150.0);
    EXPECT_DOUBLE_EQ(p.y / p.w, 37.5);
    EXPECT_DOUBLE_EQ(p.z / p.w, 0.5);
    const NearnessPlane plane = view.nearness_of({1, 0.5, 3}, normalize(Vec3{0.3, -0.2, 0.9}));
    EXPECT_NEAR(plane.gx * 150.0 + plane.gy * 37.5 + plane.at_origin, 0.5, 1e-15);
    EXPECT_DOUBLE_EQ(view.pixel_size(0.5), 2.0 * 2.0 / 100.0);
    const ScreenView parallel(unit_pixels(8), 8, 8, 10.0);
    const HomogeneousPoint q = parallel.on_screen(homogeneous({1, 2, 40}, 3.0));
    EXPECT_DOUBLE_EQ(q.x / q.w, 5.0);
    EXPECT_DOUBLE_EQ(q.y / q.w, 2.0);
    EXPECT_DOUBLE_EQ(q.z / q.w, -60.0);
}

TEST(ScreenChord, DistancesCountDepthAndDoNotDependOnTheDirection) {
    const ScreenView view(unit_pixels(8), 8, 8, 10.0);
    const ScreenPoint a{0, 0, -10}, b{6, 8, -10}, c{3, 4, -13}, d{12, 16, -10}, e{-3, -4, -10};
    const ScreenChord chord(view, a, b);
    for (const auto& [point, squared] : {std::pair{c, 9.0}, {d, 100.0}, {e, 25.0}}) {
        EXPECT_TRUE(chord.is_within(point, squared));
        EXPECT_FALSE(chord.is_within(point, squared - 1e-9));
    }
    EXPECT_TRUE(ScreenChord(view, a, a).is_within(e, 25.0));
    EXPECT_FALSE(ScreenChord(view, a, a).is_within(e, 24.0));
    RandomStream random(4);
    for (int k = 0; k < 1000; ++k) {
        const auto point = [&] {
            return ScreenPoint{random.uniform(0, 9), random.uniform(0, 9), random.uniform(-9, -1)};
        };
        const ScreenPoint p = point(), q = point(), r = point();
        const double squared = random.uniform(0, 50);
        EXPECT_EQ(ScreenChord(view, q, r).is_within(p, squared),
                  ScreenChord(view, r, q).is_within(p, squared));
    }
}

TEST(EdgeLine, FindsTheFirstSampleOnTheRight) {
    using PixelSample = SamplingConventions::PixelSample;
    for (const auto where : {PixelSample::Center, PixelSample::FrameCorners}) {
        for (const int size : {1, 2, 61}) {
            Scene scene;
            scene.conventions.sampling.pixel_sample = where;
            const ScreenView view(unit_pixels(size), size, size, 10.0);
            const RenderJob job{scene, unit_pixels(size)};
            const Film film(size, size, {0, 0, size, size});
            const SampleGrid grid(job, film, view);
            RandomStream random(11);
            for (int k = 0; k < 4000; ++k) {
                // Every other line passes exactly through a sample.
                FixedPoint from{view.to_grid(random.uniform(-9, 70)),
                                view.to_grid(random.uniform(-9, 70))};
                FixedPoint to{view.to_grid(random.uniform(-9, 70)),
                              view.to_grid(random.uniform(-9, 70))};
                const int row = k % size, column = k / 3 % size;
                if (k % 2 == 0) {
                    const auto dx = static_cast<std::int32_t>(random.below(7000));
                    const auto dy = static_cast<std::int32_t>(random.below(7000));
                    from = {grid.x(column) - 3 * dx, grid.y(row) - 3 * dy};
                    to = {grid.x(column) + 5 * dx, grid.y(row) + 5 * dy};
                }
                const EdgeLine line(from, to);
                int first = 0;
                while (first < size && !line.is_right(grid.x(first), grid.y(row))) ++first;
                if (line.dy == 0) continue;
                EXPECT_EQ(line.first_right(grid, grid.y(row)), first);
            }
        }
    }
}

/// A patch with random points around a plane; weights of 1/2 to 2 where it is rational.
BezierNet bumpy(int degree_u, int degree_v, bool rational, RandomStream& random) {
    BezierNet net;
    net.degree_u = degree_u;
    net.degree_v = degree_v;
    for (int i = 0; i <= degree_u; ++i) {
        for (int j = 0; j <= degree_v; ++j) {
            const Vec3 p{double(i) / degree_u, double(j) / degree_v, random.uniform(-0.2, 0.2)};
            net.at(i, j) = homogeneous(p, rational ? random.uniform(0.5, 2) : 1.0);
        }
    }
    return net;
}

TEST(PatchBlock, LanesHaveTheBitsOfSinglePoints) {
    RandomStream random(5);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride override(target);
        for (int k = 0; k < 200; ++k) {
            ScanScene scene;
            scene.sources.push_back({.mirrored = k % 3 == 0, .is_patch = true});
            ScanPiece piece{.lo = {0.25, 0}, .hi = {0.5, 1}, .polynomial = k % 2 == 0};
            const int degree = k % 4 == 0 ? 3 : 1 + k % 7;
            piece.net = bumpy(degree, k % 5 == 0 ? 3 : degree, !piece.polynomial, random);
            // An edge that is a point: no normal there.
            if (k % 11 == 0) {
                for (int j = 1; j <= piece.net.degree_v; ++j)
                    piece.net.at(0, j) = piece.net.at(0, 0);
            }
            PatchBlock block;
            block.count = 1 + static_cast<std::size_t>(k) % PatchBlock::kMost;
            std::vector<Ray> rays(block.count);
            for (std::size_t i = 0; i < block.count; ++i) {
                const Vec3 from{random.uniform(0, 1), random.uniform(0, 1), 3};
                block.u[i] = i == 2 ? 0.0 : random.uniform(0, 1);
                block.v[i] = random.uniform(0, 1);
                const Vec3 near{block.u[i] + random.uniform(-0.02, 0.02), block.v[i], 0};
                rays[i] = {from, normalize(near - from)};
                block.error[i] = i % 2 == 0 ? 1e-3 : 0.1;
            }
            block.rays = rays.data();
            const PatchBlock given = block;
            find_patch_points(piece.net, piece.polynomial, block);
            for (std::size_t i = 0; i < block.count; ++i) {
                Surface one, lane;
                set_patch_surface(scene, piece, {given.u[i], given.v[i]}, rays[i], given.error[i],
                                  one);
                set_patch_surface(scene, piece, block, i, true, lane);
                EXPECT_EQ(one.point, lane.point) << target << ' ' << k << ' ' << i;
                EXPECT_EQ(one.normal, lane.normal) << target << ' ' << k << ' ' << i;
                EXPECT_EQ(one.uv, lane.uv);
                EXPECT_EQ(one.dpdu, lane.dpdu);
                EXPECT_EQ(one.dpdv2, lane.dpdv2);
                EXPECT_EQ(one.error, lane.error);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
