#pragma once
/// Closed patch meshes for tests, and lines aimed at their difficult places.

#include <array>
#include <vector>

#include "alhazen/math/constants.h"
#include "alhazen/shapes/patches/patch_mesh.h"
#include "support/random.h"

namespace alhazen::testing {

/// The control points of a circle of `arcs` rational quadratic arcs: (x, y, weight) of point k.
inline std::array<double, 3> circle_point(int k, int arcs) {
    const double half = kPi / arcs, angle = (k % (2 * arcs)) * half;
    if (k % 2 == 0) return {std::cos(angle), std::sin(angle), 1.0};
    return {std::cos(angle) / std::cos(half), std::sin(angle) / std::cos(half), std::cos(half)};
}

/// Biquadratic patches over a grid of control points; wraps in both directions where the grid is
/// one period.
inline PatchMesh grid_of_patches(int count_u, int count_v, std::vector<Vec3> points,
                                 std::vector<double> weights, int degree, int row, int period_u) {
    PatchMesh mesh;
    mesh.degree_u = mesh.degree_v = static_cast<std::uint32_t>(degree);
    mesh.points = std::move(points);
    mesh.weights = std::move(weights);
    for (int a = 0; a < count_u; ++a) {
        for (int b = 0; b < count_v; ++b) {
            for (int i = 0; i <= degree; ++i) {
                for (int j = 0; j <= degree; ++j) {
                    const int u = (degree * a + i) % period_u, v = (degree * b + j) % row;
                    mesh.patches.push_back(static_cast<std::uint32_t>(u * row + v));
                }
            }
        }
    }
    mesh.prepare();
    return mesh;
}

/// A torus of nine rational biquadratic patches, exact.
inline PatchMesh torus_of_patches(double major, double minor) {
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            const auto [x, y, w] = circle_point(i, 3);
            const auto [c, s, tube] = circle_point(j, 3);
            points.push_back({(major + minor * c) * x, (major + minor * c) * y, minor * s});
            weights.push_back(w * tube);
        }
    }
    return grid_of_patches(3, 3, points, weights, 2, 6, 6);
}

/// A unit sphere of eight octants, rational biquadratic, exact; each pole is an edge of four.
inline PatchMesh sphere_of_patches() {
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 5; ++j) {
            const auto [x, y, w] = circle_point(i, 4);
            // Half of a circle from pole to pole.
            const double half[5] = {0, 1, 1, 1, 0}, z[5] = {-1, -1, 0, 1, 1};
            points.push_back({half[j] * x, half[j] * y, z[j]});
            weights.push_back(w * (j % 2 == 0 ? 1.0 : std::sqrt(0.5)));
        }
    }
    return grid_of_patches(4, 2, points, weights, 2, 5, 8);
}

/// A torus of nine bicubic patches with every control point moved: folded and self-crossing.
inline PatchMesh random_closed_patches(Random& random, double change) {
    std::vector<Vec3> points;
    for (int i = 0; i < 9; ++i) {
        for (int j = 0; j < 9; ++j) {
            const double a = 2.0 * kPi * i / 9, b = 2.0 * kPi * j / 9;
            const double radius = 1.0 + 0.4 * std::cos(b);
            const Vec3 p{radius * std::cos(a), radius * std::sin(a), 0.4 * std::sin(b)};
            points.push_back(p + change * random.in_cube(1.0));
        }
    }
    return grid_of_patches(3, 3, points, {}, 3, 9, 9);
}

/// A line of one of many kinds: random, through borders, corners and cells' borders, or tangent
/// there to 1e-1 down to 1e-12 and exactly.
inline Ray hard_line(const PatchMesh& mesh, Random& random) {
    const Box3 box = mesh.box();
    const double size = length(box.size());
    const auto patch = static_cast<std::size_t>(random.below(static_cast<int>(mesh.patch_count())));
    double uv[2] = {random.uniform(), random.uniform()};
    const int place = random.below(5);
    if (place == 1 || place == 2) uv[random.below(2)] = random.below(2);
    if (place == 2) uv[random.below(2)] = random.below(2);
    if (place == 3) uv[random.below(2)] = random.below(17) / 16.0;
    if (place == 4) uv[0] = random.below(17) / 16.0, uv[1] = random.below(17) / 16.0;
    const PatchPoint p = derivatives_at(mesh.net(patch), uv[0], uv[1]);
    Vec3 direction = random.unit_vector(), origin = p.point;
    if (random.coin()) {
        const double angle = random.uniform(0, 2 * kPi);
        const Vec3 tangent = std::cos(angle) * p.du + std::sin(angle) * p.dv;
        if (length(tangent) > 0.0) direction = normalize(tangent);
        const Vec3 normal = patch_normal(mesh.net(patch), uv[0], uv[1]);
        if (random.below(8) != 0) {
            origin += (random.sign() * size * random.log_uniform(1e-12, 1e-1)) * normal;
        }
    } else if (random.below(4) == 0) {
        direction = random.lattice_direction();
    }
    origin -= (size * random.uniform(-1, 2)) * direction;
    return {origin, random.log_uniform(0.1, 10) * direction, -kInfinity, kInfinity};
}

}  // namespace alhazen::testing
