// Databases built in rows: gears, lattice, rings, shells, sombrero, teapot.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "alhazen/math/constants.h"
#include "alhazen/session/generators/spd.h"
#include "alhazen/session/generators/teapot_patches.h"

namespace alhazen {

namespace {

// gears

constexpr int kTeeth = 36;

/// Outline of a gear of outer radius `size`; `turned` rotates it by half a tooth, so that gears
/// mesh.
std::vector<Vec3> gear_outline(const Vec3& center, double size, bool turned) {
    struct Corner {
        double radius, degrees;
    };
    static constexpr Corner kTooth[] = {{0.995, -1.9}, {0.995, 1.9}, {0.9, 3.0}, {0.9, 7.0}};
    std::vector<Vec3> outline;
    for (int tooth = 0; tooth < kTeeth; ++tooth) {
        for (const Corner& c : kTooth) {
            const double degrees = 360.0 / kTeeth * (tooth + (turned ? 0.5 : 0.0)) + c.degrees;
            const double a = degrees * kRadiansPerDegree;
            outline.push_back(
                center + Vec3{size * c.radius * std::cos(a), size * c.radius * std::sin(a), 0});
        }
    }
    return outline;
}

void write_gear(const std::vector<Vec3>& outline, double thickness, NffText& out) {
    const std::size_t n = outline.size();
    const Vec3 down{0, 0, -thickness};
    out.polygon(outline);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 &a = outline[i], &b = outline[(i + 1) % n];
        out.polygon(std::array{a, a + down, b + down, b});
    }
    std::vector<Vec3> bottom;
    for (std::size_t i = 0; i < n; ++i) bottom.push_back(outline[(n + 1 - i) % n] + down);
    out.polygon(bottom);
}

/// Colours and glass by remainders of the position, as in the files of sizes 1 and 4.
NffTextFill gear_fill(std::uint64_t i, std::uint64_t j, std::uint64_t k) {
    std::array<double, 3> c{static_cast<double>((5 + i + 3 * j + 5 * k) % 7),
                            static_cast<double>((3 + 3 * i + 2 * j + 6 * k) % 7),
                            static_cast<double>((2 + 4 * i + 2 * j + 6 * k) % 7)};
    constexpr double kLeast = 0.07;
    const double most = *std::max_element(c.begin(), c.end()) + kLeast;
    for (double& x : c) x = (x + kLeast) / most;
    const bool glass = (i + 3 * j + 4 * k) % 5 == 0;
    NffTextFill fill{.color = {c[0], c[1], c[2]}, .diffuse = glass ? 0.2 : 1, .shininess = kDull};
    if (glass) {
        fill.transmission = 0.8;
        fill.index = 1.1;
    }
    return fill;
}

// rings

/// Five tubes with balls at their ends: edges of a pentagon in the plane of `a` and `b`, with a
/// corner in direction `a`.
void write_ring(const Vec3& center, const Vec3& a, const Vec3& b, NffText& out) {
    constexpr double kTube = 0.07412;
    constexpr double kRadius = 1 / (1 + kTube);  // balls reach to 1, where the next knot begins
    std::array<Vec3, 5> corners;
    for (std::size_t i = 0; i < 5; ++i) {
        const double angle = 2 * kPi / 5 * static_cast<double>(i);
        corners[i] = center + kRadius * (std::cos(angle) * a + std::sin(angle) * b);
    }
    for (std::size_t i = 0; i < 5; ++i) {
        out.cone(corners[i], kTube, corners[(i + 4) % 5], kTube);
        out.sphere(corners[i], kTube);
    }
}

/// Six linked rings, in the planes perpendicular to the axes of an icosahedron.
void write_knot(const Vec3& center, NffText& out) {
    static constexpr Rgb kColors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                      {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
    for (int ring = 0; ring < 6; ++ring) {
        out.fill({.color = kColors[ring], .diffuse = 0.5, .specular = 0.2, .shininess = 3.0827});
        if (ring == 0) {
            write_ring(center, {1, 0, 0}, {0, 1, 0}, out);
            continue;
        }
        const double turn = (36.0 + 72.0 * (ring - 1)) * kRadiansPerDegree;
        const double c = std::cos(turn), s = std::sin(turn), lean = 1 / std::sqrt(5.0);
        write_ring(center, {c, s, 0}, {-s * lean, c * lean, 2 * lean}, out);
    }
}

void write_squares(std::uint64_t n, bool odd, NffText& out) {
    const auto place = [&](std::uint64_t i) {
        return -4.0 + 8.0 * static_cast<double>(i) / static_cast<double>(n);
    };
    for (std::uint64_t i = 0; i < n; ++i) {
        for (std::uint64_t j = 0; j < n; ++j) {
            if (((i + j) % 2 == 1) != odd) continue;
            const double x0 = place(i), x1 = place(i + 1), y0 = place(j), y1 = place(j + 1);
            out.polygon(std::array<Vec3, 4>{{{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}});
        }
    }
}

void write_patch(const PatchGrid& grid, NffText& out) {
    const auto same = [](const Vec3& a, const Vec3& b) { return max_component(abs(a - b)) < 1e-9; };
    for (int u = 0; u < grid.side; ++u) {
        for (int v = 0; v < grid.side; ++v) {
            const std::size_t a = grid.at(u, v), b = grid.at(u, v + 1), c = grid.at(u + 1, v + 1),
                              d = grid.at(u + 1, v);
            for (const auto& corners : {std::array{a, b, c}, std::array{c, d, a}}) {
                std::array<Vec3, 3> points, normals;
                for (std::size_t i = 0; i < 3; ++i) {
                    points[i] = grid.points[corners[i]];
                    normals[i] = grid.normals[corners[i]];
                }
                const bool flat = same(points[0], points[1]) || same(points[1], points[2]) ||
                                  same(points[2], points[0]);
                if (!flat) out.patch(points, normals);
            }
        }
    }
}

}  // namespace

void write_gears(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {-1.1, -2.1, 2.6}, .at = {0, 0, 0}, .up = {0, 0, 1}});
    constexpr Vec3 kLights[] = {
        {2, 4, 4}, {-2, 4, 3}, {2, -2.5, 2.5}, {-1, -4, 2}, {-1.111, -2.121, 2.626}};
    for (const Vec3& light : kLights) out.light(light);
    out.fill({.color = {1, 0.85, 0.7}, .diffuse = 0.3, .specular = 0.6, .shininess = 3.0827});
    out.polygon(std::array<Vec3, 4>{{{2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}}});
    const double count = static_cast<double>(n);
    const double size = 1 / (0.95 * (count - 1) + 1);
    const double thickness = n <= 4 ? 0.1 : 0.4 / count;
    for (std::uint64_t k = 0; k < n; ++k) {
        for (std::uint64_t j = 0; j < n; ++j) {
            for (std::uint64_t i = 0; i < n; ++i) {
                const Vec3 center{-1 + size + 1.9 * size * static_cast<double>(i),
                                  -1 + size + 1.9 * size * static_cast<double>(j),
                                  1 - static_cast<double>(k) / count};
                out.fill(gear_fill(i, j, k));
                write_gear(gear_outline(center, size, (i + j + k) % 2 == 1), thickness, out);
            }
        }
    }
}

void write_lattice(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {2.1, 1.8, 1.5}, .at = {0.5, 0.5, 0.45}, .up = {0, 0, 1}, .hither = 0.01});
    constexpr Vec3 kLights[] = {{8, 2, 5},  {2, 8, 5},  {5, 5, 9},
                                {-6, 3, 4}, {3, -6, 4}, {6, 6, -5}};
    for (const Vec3& light : kLights) out.light(light);
    out.fill({.color = {0.9, 0.6, 0.3}, .diffuse = 0.8, .specular = 0.2, .shininess = 10});
    const double pitch = 1 / static_cast<double>(n);
    const double ball = 0.2 * pitch, rod = 0.08 * pitch;
    const auto node = [&](std::uint64_t x, std::uint64_t y, std::uint64_t z) {
        return Vec3{pitch * static_cast<double>(x), pitch * static_cast<double>(y),
                    pitch * static_cast<double>(z)};
    };
    for (std::uint64_t z = 0; z <= n; ++z) {
        for (std::uint64_t y = 0; y <= n; ++y) {
            for (std::uint64_t x = 0; x <= n; ++x) {
                const Vec3 p = node(x, y, z);
                out.sphere(p, ball);
                if (x < n) out.cone(p, rod, node(x + 1, y, z), rod);
                if (y < n) out.cone(p, rod, node(x, y + 1, z), rod);
                if (z < n) out.cone(p, rod, node(x, y, z + 1), rod);
            }
        }
    }
}

void write_rings(std::uint64_t n, NffText& out) {
    const double spacing = 1 / std::sin(kPi / 8);  // of the layers: within the field of view
    const Vec3 eye{-1, -spacing, 0.5};
    out.background(kSky);
    out.view({.from = eye, .at = eye + Vec3{0, 1, 0}, .up = {0, 0, 1}});
    for (const Vec3& light : {Vec3{3, eye.y, 3}, Vec3{-4, eye.y, 1}, Vec3{2, eye.y, -4}}) {
        out.light(light);
    }
    const double wall = spacing * static_cast<double>(n + 1);
    const double half = 1.01 * (wall - eye.y) * std::tan(kPi / 8);  // fills the image
    out.fill({.color = {1, 1, 1}, .diffuse = 1, .shininess = kDull});
    out.polygon(std::array<Vec3, 4>{{{eye.x + half, wall, eye.z + half},
                                     {eye.x - half, wall, eye.z + half},
                                     {eye.x - half, wall, eye.z - half},
                                     {eye.x + half, wall, eye.z - half}}});
    for (std::uint64_t layer = 1; layer <= n; ++layer) {
        const auto place = [&](std::uint64_t i) {
            return 1 - static_cast<double>(layer) + 2 * static_cast<double>(i);
        };
        for (std::uint64_t z = 0; z < layer; ++z) {
            for (std::uint64_t x = 0; x < layer; ++x) {
                write_knot({place(x), spacing * static_cast<double>(layer), place(z)}, out);
            }
        }
    }
}

void write_shells(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {0.6, -4.6, 1.6}, .at = {0.1, 0, -0.75}, .up = {0, 0, 1}, .hither = 0.01});
    out.light({5, -8, 9});
    out.fill({.color = {0.9, 0.75, 0.55}, .diffuse = 0.8, .specular = 0.2, .shininess = 20});
    // Logarithmic spiral on a cone. Every ball overlaps its neighbours and the previous turn, which
    // makes this scene hard for bounding volumes.
    const std::uint64_t balls = 90 * n + 1;
    constexpr double kTurns = 6, kGrowthOfTurn = 1.55;
    for (std::uint64_t i = 0; i < balls; ++i) {
        const double turns = kTurns * static_cast<double>(i) / static_cast<double>(balls - 1);
        const double size = std::pow(kGrowthOfTurn, turns - kTurns);
        const double a = 2 * kPi * turns;
        out.sphere({size * std::cos(a), size * std::sin(a), -1.9 * size}, 0.62 * size);
    }
}

void write_sombrero(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view(
        {.from = {0, 5, -8}, .at = {0, 0, 0}, .up = {0, 0, 1}, .angle_deg = 40, .hither = 0.01});
    out.light({10, 10, -10});
    out.fill({.color = {1, 0.1, 0.1}, .diffuse = 0.8, .shininess = 2.60078, .index = 1});
    const std::uint64_t side = std::uint64_t{16} << n;
    const auto point = [&](std::uint64_t i, std::uint64_t j) {
        // The function is sampled on a lattice that ends one step before that of the points.
        const double places = static_cast<double>(side - 1), steps = static_cast<double>(side);
        const double x = -4 + 8 * static_cast<double>(i) / steps;
        const double z = -4 + 8 * static_cast<double>(j) / steps;
        const double r = std::hypot(x, z);
        return Vec3{-4 + 8 * static_cast<double>(i) / places,
                    -3 + std::exp(-r) * std::cos(2 * kPi * r),
                    -4 + 8 * static_cast<double>(j) / places};
    };
    for (std::uint64_t j = 0; j + 1 < side; ++j) {
        for (std::uint64_t i = 0; i + 1 < side; ++i) {
            const Vec3 a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1),
                       d = point(i, j + 1);
            out.polygon(std::array{a, c, b});
            out.polygon(std::array{a, d, c});
        }
    }
}

void write_teapot(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {4.86, 7.2, 5.4}, .at = {0, 0, 0}, .up = {0, 0, 1}});
    out.light({-3.1, 9.8, 12.1});
    out.light({11.3, 5.1, 8.8});
    for (const bool odd : {true, false}) {
        const double grey = odd ? 1.0 : 0.5;
        out.fill(
            {.color = {grey, grey, grey}, .diffuse = 0.5, .specular = 0.5, .shininess = 4.81884});
        write_squares(n, odd, out);
    }
    out.fill({.color = {1, 0.5, 0.1}, .diffuse = 0.75, .specular = 0.25, .shininess = 3.0827});
    for (const TeapotPatch& patch : teapot_patches()) {
        write_patch(evaluate(patch, static_cast<int>(n)), out);
    }
}

}  // namespace alhazen
