#include "alhazen/geometry/cones/cone_coverage.h"

#include <gtest/gtest.h>

#include <functional>

#include "alhazen/geometry/cones/coverage_tables.h"
#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(DiscArea, ClosedFormsOfTheText) {
    EXPECT_NEAR(lens_area(1, 1, 1), 2 * kPi / 3 - std::sqrt(3.0) / 2, 1e-15);
    EXPECT_NEAR(lens_area(1, 1, 1), 1.2283697, 5e-8);
    EXPECT_NEAR(segment_area(1, 0.5), 0.6141848, 5e-8);
    EXPECT_NEAR(lens(1, 1).area, lens_area(1, 1, 1), 1e-15);
    EXPECT_NEAR(lens(1, 1).center().x, 0.5, 1e-15);
}

TEST(DiscArea, OneDiscWithinAnotherOrApart) {
    EXPECT_EQ(lens_area(1, 0.25, 0.5), kPi * 0.0625);
    EXPECT_EQ(lens_area(1, 3, 1.5), kPi);
    EXPECT_EQ(lens_area(1, 0.5, 1.5), 0.0);
    EXPECT_EQ(segment_area(2, -2), kPi * 4);
    EXPECT_EQ(segment_area(2, 2), 0.0);
}

TEST(DiscArea, PolygonsAddUp) {
    const std::vector<Vec2> large{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}};
    EXPECT_NEAR(loop_part(large).area, kPi, 1e-12);
    const std::vector<Vec2> within{{-0.1, -0.1}, {0.3, -0.1}, {0.3, 0.2}, {-0.1, 0.2}};
    EXPECT_NEAR(loop_part(within).area, 0.12, 1e-15);
    EXPECT_NEAR(loop_part(within).center().x, 0.1, 1e-12);
    const std::vector<Vec2> half{{0.5, -9}, {9, -9}, {9, 9}, {0.5, 9}};
    EXPECT_NEAR(loop_part(half).area, segment_area(1, 0.5), 1e-12);
    EXPECT_NEAR(loop_part(half).center().x, 2.0 / 3 * std::pow(0.75, 1.5) / segment_area(1, 0.5),
                1e-12);
    // Through the centre, and in two pieces.
    const std::vector<Vec2> left{{-9, -9}, {0, -9}, {0, 9}, {-9, 9}};
    EXPECT_NEAR(loop_part(left).area, kPi / 2, 1e-12);
}

/// A cone, and lines evenly spread over its disc.
struct Sampled {
    ConeRay cone;
    Vec3 ex, ey;
    explicit Sampled(const ConeRay& c)
        : cone(c), ex(perpendicular(c.axis)), ey(cross(c.axis, ex)) {}

    /// The share of lines for which `covers(point at z, per unit of z)`.
    double share(const std::function<bool(const Vec3&, const Vec3&)>& covers, bool by_angle,
                 int side = 1000) const {
        double hit = 0, all = 0;
        for (int i = 0; i < side; ++i) {
            for (int j = 0; j < side; ++j) {
                const double u = 2.0 * (i + 0.5) / side - 1, v = 2.0 * (j + 0.5) / side - 1;
                if (u * u + v * v >= 1) continue;
                const Vec3 across = u * ex + v * ey;
                const Vec3 o = cone.origin + cone.radius * across;
                const Vec3 d = cone.axis + cone.spread * across;
                const double weight = by_angle ? std::pow(length_squared(d), -1.5) : 1.0;
                all += weight;
                if (covers(o, d)) hit += weight;
            }
        }
        return hit / all;
    }
};

Vec3 random_unit(RandomStream& random) {
    for (;;) {
        const Vec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        if (length_squared(v) < 1 && length_squared(v) > 0.01) return normalize(v);
    }
}

bool meets_sphere(const Vec3& o, const Vec3& d, const Vec3& c, double r) {
    const Vec3 v = c - o;
    const double along = dot(v, d) / dot(d, d);
    return length_squared(v - along * d) <= r * r && (along > 0 || length_squared(v) <= r * r);
}

TEST(ConeCoverage, SpheresAgreeWithAMillionRays) {
    RandomStream random(1984);
    for (int k = 0; k < 16; ++k) {
        const double spread = k % 2 == 0 ? random.uniform(0.001, 0.02) : random.uniform(0.02, 0.9);
        const Sampled s({{random.uniform(-1, 1), 2, 3}, random_unit(random), 0.0, spread});
        const double far = random.uniform(0.5, 20);
        const double r =
            far * (k % 4 < 2 ? random.uniform(0.1, 1.5) * spread : random.uniform(0.1, 0.999));
        // So that its edge crosses the cone.
        const double gamma = std::max(
            0.0, std::asin(std::min(r / far, 1.0)) + random.uniform(-1, 1) * std::atan(spread));
        const Vec3 center =
            s.cone.at(0) + far * (std::cos(gamma) * s.cone.axis + std::sin(gamma) * s.ey);
        const ConeCover cover = cover_of(sphere_disc(s.cone, ConeMap(s.cone), center, r));
        const double rays = s.share(
            [&](const Vec3& o, const Vec3& d) { return meets_sphere(o, d, center, r); }, true);
        EXPECT_NEAR(cover.share, rays, 1e-3) << k << " spread " << spread;
        if (cover.share > 0) {
            const Vec3 across = cover.at.x * s.ex + cover.at.y * s.ey;
            EXPECT_TRUE(
                meets_sphere(s.cone.origin, s.cone.axis + spread * across, center, r * (1 + 1e-9)))
                << k;
        }
    }
}

TEST(ConeCoverage, ASphereAroundTheApexCoversAll) {
    const ConeRay cone{{0.1, 0, 0}, {0, 0, 1}, 0.0, 0.3};
    EXPECT_EQ(cover_of(sphere_disc(cone, ConeMap(cone), {0, 0, 0}, 1)).share, 1.0);
    // Nearly touching: the sphere is a half plane of directions.
    const ConeRay narrow{{0, 0, 1 + 1e-9}, {1, 0, 0}, 0.0, 1e-3};
    EXPECT_NEAR(cover_of(sphere_disc(narrow, ConeMap(narrow), {0, 0, 0}, 1)).share,
                segment_area(1, std::sqrt(2e-9) / 1e-3) / kPi, 1e-6);
}

TEST(ConeCoverage, ParallelAndConvergingConesSeeSpheres) {
    const Vec3 center{0.7, 0.2, 5};
    for (const ConeRay& cone :
         {ConeRay{{0, 0, 0}, {0, 0, 1}, 1.0, 0.0}, ConeRay{{0, 0, 0}, {0, 0, 1}, 0.8, -0.01},
          ConeRay{{0, 0, 0}, {0, 0, 1}, 0.9, 0.01}, ConeRay{{0, 0, 0}, {0, 0, 1}, 0.02, -0.015}}) {
        const Sampled s(cone);
        const double r = cone.radius < 0.1 ? 0.68 : 0.6;
        const double rays = s.share(
            [&](const Vec3& o, const Vec3& d) { return meets_sphere(o, d, center, r); }, false);
        const ConeCover cover = cover_of(sphere_disc(cone, ConeMap(cone), center, r));
        EXPECT_NEAR(cover.share, rays, 1e-3) << cone.spread;
    }
}

TEST(ConeCoverage, PlanesAgreeWithAMillionRays) {
    RandomStream random(7);
    for (int k = 0; k < 16; ++k) {
        const double spread = random.uniform(0.001, 0.5);
        const double radius = k % 3 == 0 ? 0.0 : random.uniform(0.0, 0.3);
        const Sampled s({{0, 0, 0}, random_unit(random), radius, k % 5 == 4 ? -spread : spread});
        // Grazing, so that the horizon crosses the cone.
        const Vec3 normal =
            normalize(s.ex + 0.3 * s.ey + random.uniform(-1, 1) * spread * s.cone.axis);
        const Vec3 point = random.uniform(-0.2, 0.2) * normal;
        const ConeRange range{0.0, k % 4 == 3 ? 2.0 : std::numeric_limits<double>::infinity()};
        const double rays = s.share(
            [&](const Vec3& o, const Vec3& d) {
                const double t = dot(normal, point - o) / dot(normal, d);
                return t > 0 && t < range.z_max;
            },
            false);
        EXPECT_NEAR(plane_cover(s.cone, point, normal, range).share, rays, 1e-3) << k;
    }
}

bool in_loops(const Vec2& p, const std::vector<Vec2>& vertices,
              const std::vector<std::uint32_t>& ends) {
    bool in = false;
    std::size_t first = 0;
    for (const std::size_t end : ends) {
        for (std::size_t k = first; k < end; ++k) {
            const Vec2 a = vertices[k], b = vertices[k + 1 == end ? first : k + 1];
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
                in = !in;
            }
        }
        first = end;
    }
    return in;
}

TEST(ConeCoverage, PolygonsWithHolesAgreeWithAMillionRays) {
    const std::vector<Vec2> flat{{-1, -1}, {1.2, -1},    {1.2, 0.1},  {0.3, 0.2}, {1, 1.5},
                                 {-1, 1},  {-0.3, -0.5}, {-0.4, 0.5}, {0.2, 0.4}, {0.1, -0.6}};
    const std::vector<std::uint32_t> ends{6, 10};
    RandomStream random(12);
    ConeScratch scratch;
    for (int k = 0; k < 16; ++k) {
        const Sampled s({{0, 0, 0},
                         {0, 0, 1},
                         k % 3 == 1 ? 0.3 : 0.0,
                         k % 3 == 2 ? 0.0 + 0.3 : random.uniform(0.05, 0.6)});
        // Tilted up to grazing, partly behind the apex.
        const Vec3 u = normalize(Vec3{1, random.uniform(-1, 1), random.uniform(-1, 1)});
        const Vec3 v = normalize(cross(random_unit(random), u));
        const Vec3 base{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4),
                        random.uniform(0.1, 3)};
        std::vector<Vec3> vertices;
        for (const Vec2& p : flat) vertices.push_back(base + p.x * u + p.y * v);
        const ConeRange range{0.0, k % 4 == 3 ? 1.5 : std::numeric_limits<double>::infinity()};
        const Vec3 normal = cross(u, v);
        const double rays = s.share(
            [&](const Vec3& o, const Vec3& d) {
                const double t = dot(normal, base - o) / dot(normal, d);
                const Vec3 p = o + t * d - base;
                return t > 0 && t < range.z_max && in_loops({dot(p, u), dot(p, v)}, flat, ends);
            },
            false);
        bool front = false;
        const ConeCover cover =
            polygon_cover(ConeMap(s.cone), vertices, ends, range, scratch, &front);
        EXPECT_NEAR(cover.share, rays, 1e-3) << k;
        if (cover.share > 0) {
            EXPECT_EQ(front, dot(normal, base) < 0) << k;
        }
    }
}

TEST(ConeCoverage, TrianglesAgreeWithAMillionRaysAndAreFoundAtTheirCentre) {
    RandomStream random(77);
    for (int k = 0; k < 24; ++k) {
        const Sampled s({{0, 0, 0}, {0, 0, 1}, k % 2 == 0 ? 0.0 : 0.1, random.uniform(0.01, 0.5)});
        std::array<Vec3, 3> p;
        for (Vec3& q : p) {
            const double z = random.uniform(k % 4 == 3 ? -1.0 : 0.5, 4);
            const double wide = 1.8 * s.cone.radius_at(std::abs(z)) + 0.02;
            q = {random.uniform(-wide, wide), random.uniform(-wide, wide), z};
        }
        const ConeMap map(s.cone);
        const std::array<ConePoint, 3> corners{map(p[0]), map(p[1]), map(p[2])};
        bool front = false;
        const ConeCover cover = triangle_cover(corners, {}, false, front);
        const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
        const auto meet = [&](const Vec3& o, const Vec3& d) {
            const double t = dot(normal, p[0] - o) / dot(normal, d);
            return t > 0 ? o + t * d : Vec3{1e300, 0, 0};
        };
        const double rays = s.share(
            [&](const Vec3& o, const Vec3& d) {
                const Vec3 at = meet(o, d);
                if (at.x > 1e200) return false;
                const auto side = [&](int a, int b) {
                    return dot(cross(
                                   p[static_cast<std::size_t>(b)] - p[static_cast<std::size_t>(a)],
                                   at - p[static_cast<std::size_t>(a)]),
                               normal) >= 0;
                };
                return side(0, 1) && side(1, 2) && side(2, 0);
            },
            false);
        EXPECT_NEAR(cover.share, rays, 1e-3) << k;
        if (cover.share < 1e-4) continue;
        const TrianglePlace place = place_in_triangle(corners, cover.at);
        const Vec3 across = cover.at.x * s.ex + cover.at.y * s.ey;
        const Vec3 at =
            meet(s.cone.origin + s.cone.radius * across, s.cone.axis + s.cone.spread * across);
        const Vec3 ours = (1 - place.u - place.v) * p[0] + place.u * p[1] + place.v * p[2];
        EXPECT_NEAR(length(at - ours), 0.0, 1e-9 * length(at)) << k;
        EXPECT_NEAR(place.z, at.z, 1e-9 * length(at));
    }
}

TEST(ConeCoverage, ABoxThatSharesALineWithTheConeIsNeverLeftOut) {
    RandomStream random(5);
    int met = 0, kept = 0, all = 0;
    for (int k = 0; k < 20000; ++k) {
        const double spread = random.uniform(-0.3, 0.3);
        const ConeRay cone{{0, 0, 0}, random_unit(random), random.uniform(0, 0.5), spread};
        if (spread < 0 && cone.radius == 0) continue;
        const Sampled s(cone);
        const Vec3 center = random.uniform(0.2, 6) * random_unit(random);
        const Vec3 half{random.uniform(0, 0.4), random.uniform(0, 0.4), random.uniform(0, 0.4)};
        const bool may =
            test_box(ConeMap(cone), center, half, 0.0, std::numeric_limits<double>::infinity())
                .may_meet;
        bool truth = false;
        for (int n = 0; n < 60 && !truth; ++n) {
            const double r = std::sqrt(random.uniform(0, 1)), a = random.uniform(0, 2 * kPi);
            const Vec3 across = r * std::cos(a) * s.ex + r * std::sin(a) * s.ey;
            const Vec3 o = cone.origin + cone.radius * across - center;
            const Vec3 d = cone.axis + cone.spread * across;
            double t0 = 0, t1 = 1e9;
            for (int i = 0; i < 3; ++i) {
                const double a0 = (-half[i] - o[i]) / d[i], a1 = (half[i] - o[i]) / d[i];
                t0 = std::max(t0, std::min(a0, a1));
                t1 = std::min(t1, std::max(a0, a1));
            }
            truth = t0 <= t1;
        }
        if (truth) {
            EXPECT_TRUE(may) << k;
        }
        met += truth;
        kept += may;
        ++all;
    }
    EXPECT_GT(met, 1000);
    EXPECT_LT(kept, 2 * met + all / 20);
}

TEST(CoverageTables, AreOffByAtMostAThousandth) {
    const CoverageTables& tables = CoverageTables::shared();
    RandomStream random(1987);
    double worst = 0;
    for (int k = 0; k < 1000000; ++k) {
        const double R = std::exp(random.uniform(-5, 7));
        const double d = std::abs(R - 1) + random.uniform(-0.1, 1.1) * (R + 1 - std::abs(R - 1));
        if (d < 0) continue;
        const double off = std::abs(tables.sphere(d, R) - lens_area(1, R, d) / kPi);
        worst = std::max(worst, off);
        const double h = random.uniform(-1.1, 1.1);
        worst = std::max(worst, std::abs(tables.plane(h) - segment_area(1, h) / kPi));
    }
    EXPECT_LE(worst, 1e-3);
    RecordProperty("worst", std::to_string(worst));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
