#include "alhazen/shapes/polygons/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Random;

Polygon polygon(std::vector<Vec3> vertices, std::vector<std::uint32_t> loop_ends = {}) {
    Polygon p{.vertices = std::move(vertices), .loop_ends = std::move(loop_ends)};
    p.prepare();
    return p;
}

bool hit_from_above(const Polygon& p, double x, double y) {
    ShapeHit hit;
    return p.intersect({{x, y, 5}, {0, 0, -1}}, &hit) == 1 && hit.t == 5.0;
}

int crossings(const std::vector<Polygon>& polygons, const Ray& ray) {
    int count = 0;
    ShapeHit hit;
    for (const Polygon& p : polygons) count += p.intersect(ray, &hit);
    return count;
}

TEST(Polygon, ConcaveCornersAreOutside) {
    const Polygon ell = polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}});
    EXPECT_EQ(ell.normal, (Vec3{0, 0, 1}));
    EXPECT_TRUE(hit_from_above(ell, 0.5, 1.5));
    EXPECT_TRUE(hit_from_above(ell, 1.5, 0.5));
    EXPECT_FALSE(hit_from_above(ell, 1.5, 1.5));
    EXPECT_FALSE(hit_from_above(ell, -0.1, 0.5));
}

TEST(Polygon, LoopsInsideLoopsAreHolesAndIslands) {
    std::vector<Vec3> vertices;
    for (const double half : {3.0, 2.0, 1.0}) {
        for (const Vec3& c : {Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}) {
            vertices.push_back(half * c);
        }
    }
    const Polygon p = polygon(vertices, {4, 8, 12});
    EXPECT_TRUE(hit_from_above(p, 2.5, 0));
    EXPECT_FALSE(hit_from_above(p, 1.5, 0));
    EXPECT_TRUE(hit_from_above(p, 0.5, 0));
    EXPECT_FALSE(hit_from_above(p, 3.5, 0));
}

TEST(Polygon, ABowTieWhoseHalvesCancelIsHitInBoth) {
    const Affine place = Affine::rotate({1, -2, 0.5}, 0.9) * Affine::scale({3, 3, 3});
    const std::vector<Vec3> bow{{-1, -1, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}};
    std::vector<Vec3> turned;
    for (const Vec3& v : bow) turned.push_back(place.point(v));
    for (const auto& vertices : {bow, turned}) {
        Diagnostics diagnostics;
        Polygon{.vertices = vertices}.validate({}, diagnostics);
        EXPECT_EQ(diagnostics.error_count(), 0u);
    }
    const Polygon flat = polygon(bow), aslant = polygon(turned);
    EXPECT_NEAR(std::abs(flat.normal.z), 1.0, 1e-15);
    EXPECT_NEAR(std::abs(dot(aslant.normal, place.vector({0, 0, 1}))), 3.0, 1e-14);
    EXPECT_LT(aslant.off_plane, 1e-14);
    Random random(5);
    int hits = 0;
    constexpr int kRays = 4000;
    for (int i = 0; i < kRays; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        const bool inside = std::abs(y) < std::abs(x);
        EXPECT_EQ(hit_from_above(flat, x, y), inside) << x << " " << y;
        ShapeHit hit;
        const Ray ray{place.point({x, y, 5}), place.vector({0, 0, -1})};
        EXPECT_EQ(aslant.intersect(ray, &hit), int{inside}) << x << " " << y;
        hits += inside;
    }
    EXPECT_NEAR(4.0 * hits / kRays, 2.0, 0.1);  // the area
}

TEST(Polygon, CornersOffThePlaneOfLoopsThatCancelTurnTheNormalByTheirDistanceAlone) {
    const std::vector<std::vector<Vec3>> loops = {
        {{-1, -1, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}},
        // Of the halves the right one is larger by 2e-6.
        {{-1, -1, 0}, {1, 1, 0}, {1 + 1e-6, -1, 0}, {-1, 1, 0}},
        // A narrow one.
        {{-1, -1e-4, 0}, {1, 1e-4, 0}, {1, -1e-4, 0}, {-1, 1e-4, 0}},
        // Two squares of opposite orientation that meet in a vertex.
        {{0, 0, 0},
         {1, 0, 0},
         {1, 1, 0},
         {0, 1, 0},
         {0, 0, 0},
         {0, -1, 0},
         {-1, -1, 0},
         {-1, 0, 0}},
    };
    const Affine aslant = Affine::rotate({1, -2, 0.5}, 0.9);
    for (const auto& loop : loops) {
        const double width = std::abs(loop[1].y) > 1e-3 ? 1.0 : 1e-4;
        for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 6e-8, 1e-6, 3e-5}) {
            for (std::size_t corner = 0; corner < loop.size(); ++corner) {
                for (const Affine& place : {Affine(), aslant}) {
                    std::vector<Vec3> vertices = loop;
                    vertices[corner].z += off * width;
                    for (Vec3& v : vertices) v = place.point(v);
                    const Polygon p = polygon(vertices);
                    // A plane through corners of the loop deviates from another by less.
                    const double most = 4.0 * off * width + 2e-9;
                    EXPECT_LT(p.off_plane, most) << &loop - loops.data() << " " << corner;
                    EXPECT_GT(std::abs(dot(p.normal, place.vector({0, 0, 1}))), 1 - 1e-6)
                        << &loop - loops.data() << " " << corner << " " << off;
                }
            }
        }
    }
}

TEST(Polygon, TheNormalOfASimplePolygonIsNewells) {
    Random random(63);
    for (int i = 0; i < 3000; ++i) {
        // Star-shaped around the origin, or a narrow frame; corners off the plane.
        const int n = 4 + random.below(30);
        const bool frame = random.coin();
        const double off = i % 4 == 0 ? 0.0 : random.log_uniform(1e-12, 0.1);
        const Affine place = Affine::rotate(random.unit_vector(), random.uniform(0, 6));
        std::vector<Vec3> vertices;
        for (int loop = 0; loop < 1 + frame; ++loop) {
            for (int k = 0; k < n; ++k) {
                const double turn = loop == 0 ? 1.0 : -1.0;
                const double angle = turn * 6.283185307179586 * (k + 0.5 * random.uniform()) / n;
                const double r = frame ? (loop == 0 ? 1.0 : 0.6) : random.uniform(0.7, 1.4);
                vertices.push_back(place.point(
                    {r * std::cos(angle), r * std::sin(angle), random.uniform(-off, off)}));
            }
        }
        const auto count = static_cast<std::uint32_t>(n);
        const Polygon p = polygon(vertices, frame ? std::vector<std::uint32_t>{count, 2 * count}
                                                  : std::vector<std::uint32_t>{count});
        Vec3 sum;
        for (std::size_t loop = 0; loop < p.loop_ends.size(); ++loop) {
            const std::size_t first = loop == 0 ? 0 : p.loop_ends[loop - 1];
            for (std::size_t k = first; k < p.loop_ends[loop]; ++k) {
                const Vec3& next = vertices[k + 1 < p.loop_ends[loop] ? k + 1 : first];
                sum += cross(vertices[k] - vertices.front(), next - vertices.front());
            }
        }
        ASSERT_EQ(p.normal, normalize(sum)) << "seed 63, case " << i;
    }
}

TEST(Polygon, OddEvenRuleAgreesWithTheAngleAroundThePoint) {
    Random random(61);
    int inside_count = 0;
    for (int i = 0; i < 2000; ++i) {
        // Corners of random radius in angular order around the origin: simple, concave,
        // star-shaped.
        const int n = 3 + random.below(142);
        std::vector<Vec3> vertices;
        for (int k = 0; k < n; ++k) {
            const double angle = 6.283185307179586 * (k + 0.9 * random.uniform()) / n;
            const double r = random.uniform(0.5, 2);
            vertices.push_back({r * std::cos(angle), r * std::sin(angle), 0});
        }
        const Polygon p = polygon(vertices);
        for (int k = 0; k < 20; ++k) {
            const Vec3 at = random.in_cube(2);
            double turns = 0, nearest = 1;
            for (int j = 0; j < n; ++j) {
                const Vec3 a = vertices[j] - Vec3{at.x, at.y, 0};
                const Vec3 b = vertices[(j + 1) % n] - Vec3{at.x, at.y, 0};
                const double area = a.x * b.y - a.y * b.x;
                turns += std::atan2(area, dot(a, b)) / 6.283185307179586;
                nearest = std::min(nearest, std::abs(area));
            }
            if (nearest < 1e-9) continue;
            const bool inside = std::abs(turns) > 0.5;
            inside_count += inside;
            ASSERT_EQ(hit_from_above(p, at.x, at.y), inside) << "seed 61, case " << i << " " << k;
        }
    }
    EXPECT_GT(inside_count, 5000);
}

/// A square divided into quadrilaterals, some joined in pairs, in a random or a lattice plane.
struct Tiling {
    static constexpr int kSide = 7;
    std::vector<Vec3> corners;
    std::vector<Polygon> tiles;

    const Vec3& corner(int i, int j) const { return corners[i * kSide + j]; }

    Tiling(Random& random, bool lattice) {
        const Vec3 normal = random.unit_vector();
        Vec3 x = perpendicular(normal), y = cross(normal, x), origin = random.in_cube(3);
        if (lattice) {
            x = y = {};
            const int k = random.below(3);
            x[k] = y[(k + 1) % 3] = 1.0;
            origin = random.on_lattice(2, 0.5);
        }
        for (int i = 0; i < kSide; ++i) {
            for (int j = 0; j < kSide; ++j) {
                const bool rim = i == 0 || j == 0 || i == kSide - 1 || j == kSide - 1;
                const double shake = lattice || rim ? 0.0 : 0.45;
                corners.push_back(origin + (i + random.uniform(-shake, shake)) * x +
                                  (j + random.uniform(-shake, shake)) * y);
            }
        }
        for (int i = 0; i + 1 < kSide; ++i) {
            for (int j = 0; j + 1 < kSide; ++j) {
                std::vector<Vec3> loop{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                       corner(i, j + 1)};
                if (j + 2 < kSide && random.coin()) {
                    // Joined with the next tile; the corners between them stay in the loop.
                    loop = {corner(i, j),         corner(i + 1, j), corner(i + 1, j + 1),
                            corner(i + 1, j + 2), corner(i, j + 2), corner(i, j + 1)};
                    ++j;
                }
                if (random.coin()) std::reverse(loop.begin(), loop.end());
                tiles.push_back(polygon(loop));
            }
        }
    }
};

TEST(Polygon, TilesOfAPlaneAreHitExactlyOnce) {
    Random random(62);
    int checked = 0;
    for (int i = 0; i < 150; ++i) {
        const bool lattice = i % 3 == 0;
        const Tiling tiling(random, lattice);
        const Vec3 normal = tiling.tiles.front().normal;
        for (int k = 0; k < 150; ++k) {
            const int a = 1 + random.below(Tiling::kSide - 2);
            const int b = 1 + random.below(Tiling::kSide - 2);
            const int c = 1 + random.below(Tiling::kSide - 2);
            // Exactly at an inner vertex, on an edge, or between any two inner vertices.
            Vec3 target = tiling.corner(a, b);
            if (k % 3 == 1) target = 0.5 * target + 0.5 * tiling.corner(a, b == 1 ? 2 : b - 1);
            if (k % 3 == 2) target += random.uniform() * (tiling.corner(c, a) - target);
            const Vec3 origin = lattice
                                    ? target + random.on_lattice(4, 0.5)
                                    : target + random.log_uniform(1, 1e5) * random.unit_vector();
            Ray ray = line(origin, target - origin);
            if (lattice && random.coin()) ray = line(target - normal, normal);
            if (std::abs(dot(normal, ray.direction)) <= 1e-3 * length(ray.direction)) continue;
            ++checked;
            ASSERT_EQ(crossings(tiling.tiles, ray), 1) << "seed 62, case " << i << " " << k;
        }
    }
    EXPECT_GT(checked, 15000);
}

/// A prism over a star with a hole: two concave faces of two loops each, and a quadrilateral per
/// edge.
struct Prism {
    std::vector<Vec3> corners;
    std::vector<Polygon> faces;

    Prism(Random& random, bool lattice) {
        const Vec3 up = lattice ? Vec3{0, 0, 1} : random.unit_vector();
        const Vec3 x = perpendicular(up), y = cross(up, x);
        const Vec3 origin = lattice ? random.on_lattice(2, 1) : random.in_cube(3);
        const std::vector<Vec2> outline =
            lattice ? std::vector<Vec2>{{0, 0}, {4, 0}, {4, 1}, {2, 2}, {4, 3},
                                        {4, 4}, {0, 4}, {1, 1}, {1, 2}, {2, 1}}
                    : star(random);
        const std::uint32_t outer = lattice ? 7 : 20;
        const auto n = static_cast<std::uint32_t>(outline.size());
        std::vector<Vec3> low, high;
        for (const Vec2& p : outline) {
            low.push_back(origin + p.x * x + p.y * y);
            high.push_back(low.back() + 2.0 * up);
        }
        faces = {polygon(low, {outer, n}), polygon(high, {outer, n})};
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t first = i < outer ? 0 : outer, end = i < outer ? outer : n;
            const std::uint32_t next = i + 1 < end ? i + 1 : first;
            faces.push_back(polygon({low[i], low[next], high[next], high[i]}));
        }
        corners = low;
        corners.insert(corners.end(), high.begin(), high.end());
    }

    static std::vector<Vec2> star(Random& random) {
        std::vector<Vec2> points;
        for (int i = 0; i < 40; ++i) {
            const double r = i >= 20 ? 0.5 : random.uniform(0.8, 3);
            const double angle = 6.283185307179586 * (i % 20) / 20;
            points.push_back({r * std::cos(angle), r * std::sin(angle)});
        }
        return points;
    }
};

TEST(Polygon, LinesCrossASolidOfPolygonsAnEvenNumberOfTimes) {
    Random random(63);
    int crossed = 0;
    for (int i = 0; i < 100; ++i) {
        const bool lattice = i % 2 == 0;
        const Prism prism(random, lattice);
        const int n = static_cast<int>(prism.corners.size());
        for (int k = 0; k < 300; ++k) {
            // Through a corner, along an edge or a diagonal, or on the lattice.
            const Vec3& a = prism.corners[random.below(n)];
            const Vec3& b = prism.corners[random.below(n)];
            Ray ray = line(a, random.unit_vector());
            if (k % 3 == 1 && a != b) ray = line(a - 3.0 * (b - a), b - a);
            if (k % 3 == 2) ray.direction = random.lattice_direction();
            if (k % 4 == 0) ray.origin = random.on_lattice(4, 0.5);
            const int count = crossings(prism.faces, ray);
            ASSERT_EQ(count % 2, 0) << "seed 63, case " << i << " " << k;
            crossed += count > 0;
        }
    }
    EXPECT_GT(crossed, 10000);
}

TEST(Polygon, VerticesOffThePlaneStayInTheBox) {
    Random random(64);
    for (int i = 0; i < 500; ++i) {
        std::vector<Vec3> bent;
        for (int k = 0; k < 8; ++k) {
            const double angle = 0.785398 * k;
            bent.push_back({std::cos(angle), std::sin(angle), random.uniform(-0.2, 0.2)});
        }
        const Polygon p = polygon(bent);
        for (int k = 0; k < 100; ++k) {
            const Vec3 d = random.unit_vector();
            const Ray ray = line(random.in_cube(1) - 5.0 * d, d);
            ShapeHit hit;
            if (p.intersect(ray, &hit) == 0) continue;
            const Vec3 at = ray.at(hit.t), slack{1e-12, 1e-12, 1e-12};
            ASSERT_TRUE((Box3{p.box().lo - slack, p.box().hi + slack}).contains(at)) << i;
        }
    }
}

TEST(Polygon, RaysInItsPlaneMissIt) {
    const Polygon square = polygon({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
    ShapeHit hit;
    for (const double zero : {0.0, -0.0}) {
        EXPECT_EQ(square.intersect(line({-1, 0.5, 1}, {1, 0, zero}), &hit), 0);
        EXPECT_EQ(square.intersect(line({-1, 0, 1}, {1, zero, zero}), &hit), 0);
        EXPECT_EQ(square.intersect(line({-1, -1, 1}, {1, 1, zero}), &hit), 0);
        EXPECT_EQ(square.intersect(line({-1, 0.5, 1.5}, {1, 0, zero}), &hit), 0);
    }
}

TEST(Polygon, TextureRunsAlongTheFirstEdge) {
    const Polygon p = polygon({{1, 1, 0}, {1, 3, 0}, {-1, 3, 0}, {-1, 1, 0}});
    const Ray ray{{0.5, 2, 5}, {0, 0, -1}};
    ShapeHit hit;
    ASSERT_EQ(p.intersect(ray, &hit), 1);
    EXPECT_NEAR(p.surface(ray, hit).uv.x, 1.0, 1e-15);
    EXPECT_NEAR(p.surface(ray, hit).uv.y, 0.5, 1e-15);
}

TEST(Polygon, BadLoopsAreReported) {
    const auto errors = [](std::vector<Vec3> vertices, std::vector<std::uint32_t> ends) {
        Diagnostics diagnostics;
        Polygon{.vertices = std::move(vertices), .loop_ends = std::move(ends)}.validate(
            {}, diagnostics);
        return diagnostics.error_count();
    };
    const std::vector<Vec3> square{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    EXPECT_EQ(errors(square, {4}), 0u);
    EXPECT_EQ(errors(square, {}), 0u);
    EXPECT_EQ(errors(square, {3}), 1u);
    EXPECT_EQ(errors(square, {5}), 1u);
    EXPECT_EQ(errors(square, {2, 4}), 1u);
    EXPECT_EQ(errors(square, {4, 0xFFFFFFFFu}), 1u);
    EXPECT_EQ(errors(square, {4, 3}), 1u);
    EXPECT_EQ(errors({}, {}), 1u);
    EXPECT_EQ(errors({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {3}), 1u);
    EXPECT_EQ(errors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {}), 1u);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(errors({{0, 0, 0}, {1, 1, nan}, {2, 0, 0}}, {3}), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
