#pragma once
/// Bilinear and Steiner patches for tests: sheets with shared edges, random patches, pieces of the
/// Roman surface and of a sphere; the crossings of a Steiner patch against those by its quartic.

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/shapes/patches/bilinear_patch.h"
#include "alhazen/shapes/patches/steiner_implicit.h"
#include "support/random.h"

namespace alhazen::testing {

inline BilinearPatch bilinear(const Vec3& p00, const Vec3& p10, const Vec3& p01, const Vec3& p11) {
    BilinearPatch patch{p00, p10, p01, p11};
    patch.prepare();
    return patch;
}

inline Ray whole_line(const Vec3& through, const Vec3& direction) {
    return {through, direction, -kInfinity, kInfinity};
}

template <class S>
int crossings(const S& patch, const Ray& ray) {
    ShapeHit hits[S::kMaxHits];
    return patch.intersect(ray, hits);
}

/// Expects that every ray at the inner corner or the inner edges of a sheet of four skew patches
/// crosses it once.
inline void expect_no_leaks(Random& random, int sheets, int rays_each) {
    for (int k = 0; k < sheets; ++k) {
        Vec3 p[3][3];
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) p[i][j] = Vec3{double(i), double(j), 0} + 0.15 * random.in_cube(1.0);
        }
        std::vector<BilinearPatch> sheet;
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t j = 0; j < 2; ++j) {
                sheet.push_back(bilinear(p[i][j], p[i + 1][j], p[i][j + 1], p[i + 1][j + 1]));
            }
        }
        for (int i = 0; i < rays_each; ++i) {
            const Vec3 end = i % 2 == 0 ? p[1][2 * random.below(2)] : p[2 * random.below(2)][1];
            const double along = i % 10 == 0 ? 0.0 : random.uniform(0.0, 0.999);
            const Vec3 target = p[1][1] + along * (end - p[1][1]);
            const Vec3 direction = Vec3{0, 0, 1} + 0.2 * random.in_cube(1.0);
            const double away = i % 3 == 0 ? random.log_uniform(1, 1e9) : random.uniform(0, 10);
            const Ray ray = whole_line(target - away * direction, direction);
            int count = 0;
            for (const BilinearPatch& patch : sheet) count += crossings(patch, ray);
            ASSERT_EQ(count, 1) << k << " " << i;
        }
    }
}

/// The part over the parameters' triangle a, b, c: `at(p, q)` is the polar form of the homogeneous
/// point.
template <class Point, class F>
SteinerPatch steiner_over(const Point& a, const Point& b, const Point& c, F&& at) {
    SteinerPatch patch;
    const std::pair<Point, Point> pairs[6] = {{a, a}, {a, b}, {b, b}, {a, c}, {b, c}, {c, c}};
    for (const auto& [p, q] : pairs) {
        const HomogeneousPoint point = at(p, q);
        patch.points.push_back(projected(point));
        patch.weights.push_back(point.w);
    }
    patch.prepare();
    return patch;
}

/// Steiner's Roman surface (y z, z x, x y) / (x^2 + y^2 + z^2).
inline SteinerPatch roman_piece(const Vec3& a, const Vec3& b, const Vec3& c) {
    return steiner_over(a, b, c, [](const Vec3& p, const Vec3& q) {
        return HomogeneousPoint{0.5 * (p.y * q.z + p.z * q.y), 0.5 * (p.z * q.x + p.x * q.z),
                                0.5 * (p.x * q.y + p.y * q.x), dot(p, q)};
    });
}

/// The unit sphere from its pole (0, 0, -1).
inline SteinerPatch sphere_piece(const Vec2& a, const Vec2& b, const Vec2& c) {
    return steiner_over(a, b, c, [](const Vec2& p, const Vec2& q) {
        const double square = p.x * q.x + p.y * q.y;
        return HomogeneousPoint{p.x + q.x, p.y + q.y, 1.0 - square, 1.0 + square};
    });
}

/// Folded and crossing itself, or a wavy sheet, or with weights; or a piece of the Roman surface.
inline SteinerPatch random_steiner(Random& random) {
    SteinerPatch patch;
    const int kind = random.below(5);
    if (kind == 0) {
        const Vec3 x{random.coin() ? 1.0 : -1.0, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
        return random.coin() ? roman_piece(x, 0.5 * (x + y), 0.5 * (x + z))
                             : roman_piece(0.5 * (x + y), 0.5 * (y + z), 0.5 * (z + x));
    }
    for (int k = 0; k < 6; ++k) patch.points.push_back(random.in_cube(1.0));
    if (kind == 1) {
        const Vec3 flat[6] = {{0, 0, 0}, {.5, 0, 0}, {1, 0, 0}, {0, .5, 0}, {.5, .5, 0}, {0, 1, 0}};
        for (std::size_t k = 0; k < 6; ++k) patch.points[k] = flat[k] + 0.2 * patch.points[k];
    }
    for (int k = 0; kind >= 3 && k < 6; ++k) patch.weights.push_back(random.log_uniform(0.2, 5));
    patch.prepare();
    return patch;
}

/// True if rounding may decide the count: a crossing on the border, or two that are close.
inline bool is_delicate(const ShapeHit* hits, int count) {
    for (int k = 0; k < count; ++k) {
        if (std::min({hits[k].u, hits[k].v, 1.0 - hits[k].u - hits[k].v}) < 1e-8) return true;
        if (k > 0 && hits[k].t - hits[k - 1].t < 1e-4) return true;
    }
    return false;
}

/// Counts of `compare_with_quartic`.
struct QuarticComparison {
    int rays = 0, found = 0, delicate = 0;
    int missed = 0;  ///< rays with crossings that the quartic does not find
};

/// Expects that all crossings lie on the patch, and the same ones by the quartic, of rays at random
/// and rays aimed at the patch. Near a double line of the surface the quartic has a double root, of
/// which one may be on the patch: it finds neither.
inline QuarticComparison compare_with_quartic(Random& random, int patches, int rays_each) {
    QuarticComparison counts;
    for (int k = 0; k < patches; ++k) {
        const SteinerPatch patch = random_steiner(random);
        const SteinerImplicit implicit(patch);
        EXPECT_TRUE(implicit.usable()) << k;
        if (!implicit.usable()) continue;
        for (int i = 0; i < rays_each; ++i) {
            Vec3 through = random.in_cube(1.0);
            if (i % 2 == 0) {
                const double v = random.uniform(0, 1), u = random.uniform(0, 1 - v);
                through = patch.surface({}, {0, u, v, 0}).point;
            }
            const Ray ray = whole_line(through, random.unit_vector());
            ShapeHit hits[4], others[4];
            const int count = patch.intersect(ray, hits), other = implicit.crossings(ray, others);
            ++counts.rays;
            counts.found += count;
            const bool delicate = is_delicate(hits, count) || is_delicate(others, other);
            counts.delicate += delicate;
            if (delicate) continue;
            counts.missed += other < count;
            EXPECT_LE(other, count) << k << " " << i;
            for (int j = 0; j < count; ++j) {
                const Vec3 p = patch.surface(ray, hits[j]).point;
                EXPECT_LT(length(p - ray.at(hits[j].t)), 1e-12) << k << " " << i;
                if (other == count) {
                    EXPECT_NEAR(hits[j].t, others[j].t, 1e-10) << k << " " << i;
                }
            }
        }
    }
    return counts;
}

}  // namespace alhazen::testing
