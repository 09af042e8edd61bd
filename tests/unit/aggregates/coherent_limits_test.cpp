// Coherent batches at the limits of primitives, of the tree and of the eye: edges, vertices, the
// sides of the box.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/thorough.h"
#include "unit/aggregates/coherent_rays.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

constexpr double kInf = std::numeric_limits<double>::infinity();

/// A cube from -1 to 1, each side of 32 triangles.
PrimitiveTable divided_cube() {
    TableBuilder builder;
    for (int side = 0; side < 6; ++side) {
        for (int n = 0; n < 16; ++n) {
            const auto corner = [&](int du, int dv) {
                Vec3 p;
                p[side / 2] = side % 2 == 0 ? -1 : 1;
                p[(side / 2 + 1) % 3] = 0.5 * (n % 4 + du) - 1;
                p[(side / 2 + 2) % 3] = 0.5 * (n / 4 + dv) - 1;
                return p;
            };
            builder.add_triangle(corner(0, 0), corner(1, 0), corner(0, 1));
            builder.add_triangle(corner(1, 0), corner(1, 1), corner(0, 1));
        }
    }
    return builder.finish();
}

TEST(CoherentLimits, EdgesAndVerticesAreDecidedAsByTheList) {
    RandomEngine random(10);
    TableBuilder builder;
    std::vector<Vec3> targets;
    for (int i = 0; i < 400; ++i) {
        // A lattice: shared vertices and edges, coplanar and duplicate triangles.
        const Vec3 a = 0.25 * lattice_point(random, 4);
        const Vec3 b = a + 0.25 * lattice_point(random, 1), c = a + 0.25 * lattice_point(random, 1);
        builder.add_triangle(a, b, c, random() % 2 == 0);
        targets.insert(targets.end(), {a, b, 0.5 * (a + b), 0.5 * (b + c)});
    }
    builder.table.placements.emplace_back();
    TableBuilder others = builder;
    others.add_sphere({50, 50, 50}, 1, true, 0);  // packets are frusta
    for (const PrimitiveTable& table : {builder.finish(), others.finish()}) {
        for (const Vec3& eye : {Vec3{0.25, 0.5, 3}, Vec3{0.3, 0.2, 2.9}, Vec3{-3, 0.25, 0.25}}) {
            Rays rays;
            for (const Vec3& target : targets) rays.push_back({eye, target - eye, 0, kInf});
            std::sort(rays.begin(), rays.end(),
                      [](const Ray& a, const Ray& b) { return a.direction.y < b.direction.y; });
            compare("rays at vertices and edges", table, rays);
            for (Ray& ray : rays) ray.t_max = 1;
            compare("rays to vertices and edges", table, rays);
        }
        // Parallel along an axis: a common direction instead of a common point, zeros of both
        // signs.
        Rays rays;
        for (int i = 0; i < 400; ++i) {
            rays.push_back({{0.125 * (i % 20 - 10), 0.125 * (i / 20 - 10), 2}, {0.0, -0.0, -1}});
        }
        compare("parallel rays", table, rays);
        for (Ray& ray : rays) ray.origin = {0.001 * ray.origin.x, 0.25 + 0.001 * ray.origin.y, 2};
        compare("parallel rays in a beam", table, rays);
    }
}

TEST(CoherentLimits, EdgesOfAnUnevenMeshAreDecidedAsByTheList) {
    // Rays from one point at edges and vertices whose coordinates round: which of the triangles
    // around an edge is hit depends on the last bits.
    constexpr int kCells = 12;
    RandomEngine random(47);
    std::vector<Vec3> grid;
    for (int i = 0; i <= kCells; ++i) {
        for (int k = 0; k <= kCells; ++k) {
            grid.push_back(Vec3{i / 12.0 - 0.5, k / 12.0 - 0.5, 0} + uniform_point(random, 0.02));
        }
    }
    TableBuilder builder;
    std::vector<Vec3> targets;
    for (int i = 0; i < kCells; ++i) {
        for (int k = 0; k < kCells; ++k) {
            const auto at = [&](int di, int dk) {
                return grid[static_cast<std::size_t>((i + di) * (kCells + 1) + k + dk)];
            };
            const Vec3 a = at(0, 0), b = at(1, 0), c = at(0, 1), d = at(1, 1);
            builder.add_triangle(a, b, c);
            builder.add_triangle(c, b, d);
            targets.push_back(a);
            for (const Vec3& end : {b, c}) {
                for (int n = 0; n < 3; ++n)
                    targets.push_back(a + uniform(random, 0, 1) * (end - a));
            }
            for (int n = 0; n < 9; ++n) targets.push_back(b + uniform(random, 0, 1) * (c - b));
        }
    }
    const PrimitiveTable table = builder.finish();
    for (const Vec3& eye : {Vec3{0.13, 0.21, 1.1}, Vec3{-0.3, 0.1, 3.3}, Vec3{2.1, -1.7, 6.9}}) {
        Rays rays;
        for (const Vec3& target : targets) rays.push_back({eye, target - eye, 0, kInf});
        compare("edges of an uneven mesh", table, rays);
    }
}

TEST(CoherentLimits, CornersThatFloatHoldsAndOthersAreDecidedAsByTheList) {
    // Blocks hold corners exactly where they are on the grid; the others come from the mesh.
    const auto on_grid = [](const Vec3& p) {
        const auto snap = [](double x) { return std::round(x * 1024) / 1024; };
        return Vec3{snap(p.x), snap(p.y), snap(p.z)};
    };
    for (const Vec3& middle : {Vec3{}, Vec3{96, 32, -64}}) {
        for (const int every : {1, 2, 1000}) {
            RandomEngine random(19);
            TableBuilder builder;
            for (int i = 0; i < cases(500, 1500); ++i) {
                Vec3 p[3] = {uniform_point(random, 1), {}, {}};
                p[1] = p[0] + uniform_point(random, 0.1), p[2] = p[0] + uniform_point(random, 0.1);
                for (Vec3& corner : p)
                    corner = middle + (i % every == 0 ? on_grid(corner) : corner);
                builder.add_triangle(p[0], p[1], p[2]);
            }
            const PrimitiveTable table = builder.finish();
            const Vec3 eye = middle + Vec3{0.1, 0.2, 3};
            const std::string name = "corners, every " + std::to_string(every) + " on the grid";
            compare(name, table, eye_rays(eye, {0, 0, -1}, 0.6, 40));
            compare(name, table, shadow_rays(middle + Vec3{-1.2, -1.1, -1.3}, 0.3, eye, 24));
        }
    }
}

TEST(CoherentLimits, RaysBesideTheBoxOfTheTreeHitWhatTheListHits) {
    // Rays that begin at a side of the box or beside it, and go away, along it or back, some by
    // numbers that float does not tell from 0. Packets of one kind, and of several.
    const PrimitiveTable cube = divided_cube();
    RandomEngine random(21);
    Rays rays;
    for (const double beside : {0.0, 1e-15, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3, 0.5, 20.0}) {
        for (const double away : {1.0, 1e-60, 0.0, -0.0, -1e-60, -1e-30, -1e-3, -1.0}) {
            for (const double along : {0.0, 1e-60, 0.1, 1.0}) {
                const int axis = static_cast<int>(random() % 3);
                const double side = random() % 2 == 0 ? -1 : 1;
                for (int i = 0; i < 32; ++i) {
                    Ray ray{uniform_point(random, 0.9), along * uniform_point(random, 1)};
                    ray.origin[axis] = side * (1 + beside);
                    ray.direction[axis] = side * away;
                    rays.push_back(ray);
                }
            }
        }
    }
    compare("packets beside a cube", cube, rays);
    // The cube lies behind them, within their range.
    Rays behind = rays;
    for (std::size_t i = 0; i < behind.size(); ++i) {
        behind[i].t_min = std::array{-10.0, -kInfinity, -1e-60, -0.0}[i / 32 % 4];
    }
    compare("packets beside a cube that lies behind them", cube, behind);
    for (Ray& ray : behind) ray.origin = {0.1, 0.2, 3}, ray.t_min = -10;
    compare("packets from a point beside a cube that lies behind them", cube, behind);
    std::shuffle(rays.begin(), rays.end(), random);
    compare("rays beside a cube", cube, rays);
}

TEST(CoherentLimits, TrianglesBesideTheEyeAreMet) {
    // Corners behind the eye, next to it and at its depth, whose slopes are meaningless.
    RandomEngine random(18);
    TableBuilder builder;
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = 0.5 * lattice_point(random, 4);
        builder.add_triangle(a, a + 0.5 * lattice_point(random, 3),
                             a + 0.5 * lattice_point(random, 3), random() % 2 == 0);
    }
    builder.table.placements.emplace_back();
    TableBuilder others = builder;
    others.add_sphere({50, 50, 50}, 1, true, 0);  // packets are frusta
    for (const PrimitiveTable& table : {builder.finish(), others.finish()}) {
        for (const Vec3& eye : {Vec3{0, 0, 0}, Vec3{0.5, -0.5, 1}, Vec3{0.51, 0.24, 0.5}}) {
            for (const Vec3& look : {Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{-1, 0.5, 0.25}}) {
                compare("triangles around the eye", table, eye_rays(eye, look, 0.4, 24), false);
                Rays rays = eye_rays(eye, look, 0.1, 16);
                for (Ray& ray : rays) ray.t_min = -1;
                compare("and from behind it", table, rays, false);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
