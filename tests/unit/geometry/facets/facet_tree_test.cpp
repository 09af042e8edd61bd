#include "alhazen/geometry/facets/facet_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "alhazen/geometry/facets/depth_order.h"
#include "alhazen/geometry/facets/point_hull.h"
#include "alhazen/math/constants.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

struct Polygons {
    FacetPool pool;
    std::vector<FacetPiece> pieces;

    void add(std::span<const Vec3> corners) {
        Vec3 n;
        for (std::size_t k = 2; k < corners.size(); ++k) {
            n += cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
        }
        n = normalize(n);
        pool.planes.push_back({n, dot(n, corners[0])});
        pieces.push_back(pool.add(static_cast<std::uint32_t>(pool.planes.size() - 1), corners));
    }
    [[nodiscard]] FacetTree tree(const FacetTreeOptions& options = {}) const {
        return FacetTree(pool, pieces, options);
    }
};

struct Dice {
    std::mt19937_64 engine;
    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53);
    }
    Vec3 point(double r) { return {(*this)(-r, r), (*this)(-r, r), (*this)(-r, r)}; }
};

/// Regular polygons of 3 to 6 corners, of many planes, which cross each other.
Polygons crossing_polygons(int count, double size, std::uint64_t seed) {
    Dice dice{std::mt19937_64(seed)};
    Polygons polygons;
    for (int k = 0; k < count; ++k) {
        const Vec3 middle = dice.point(1.0);
        const Vec3 n = normalize(dice.point(1.0));
        const Vec3 u = perpendicular(n), v = cross(n, u);
        const int corners = 3 + k % 4;
        std::vector<Vec3> loop;
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * kPi * i / corners;
            loop.push_back(middle + size * std::cos(angle) * u + size * std::sin(angle) * v);
        }
        polygons.add(loop);
    }
    return polygons;
}

/// The boxes of a city: walls that touch, roofs in common planes.
Polygons city(int side) {
    Dice dice{std::mt19937_64(5)};
    Polygons polygons;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const Vec3 lo{double(i), double(j), 0};
            const Vec3 hi{i + 0.7, j + 0.7, std::floor(dice(1, 5))};
            for (int face = 0; face < 6; ++face) {
                const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
                std::array<Vec3, 4> loop;
                for (int k = 0; k < 4; ++k) {
                    Vec3& p = loop[static_cast<std::size_t>(face % 2 == 1 ? k : 3 - k)];
                    p[axis] = face % 2 == 1 ? hi[axis] : lo[axis];
                    p[u] = k == 1 || k == 2 ? hi[u] : lo[u];
                    p[v] = k >= 2 ? hi[v] : lo[v];
                }
                polygons.add(loop);
            }
        }
    }
    return polygons;
}

Polygons sphere_mesh(int rows) {
    Polygons polygons;
    const auto at = [&](int i, int j) {
        const double a = kPi * i / rows, b = kPi * j / rows;
        return Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
    };
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < 2 * rows; ++j) {
            const std::array<Vec3, 3> lower{at(i, j), at(i + 1, j), at(i + 1, j + 1)};
            const std::array<Vec3, 3> upper{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
            if (i + 1 < rows) polygons.add(lower);
            if (i > 0) polygons.add(upper);
        }
    }
    return polygons;
}

/// t where a ray meets a convex piece; infinite where it misses.
double meets(const FacetPool& pool, const FacetPiece& piece, const Vec3& from, const Vec3& along) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const FacetPlane& plane = pool.planes[piece.facet];
    const double slope = dot(plane.normal, along);
    if (std::abs(slope) < 1e-6) return kNever;
    const double t = -plane.at(from) / slope;
    if (!(t > 0.0)) return kNever;
    const Vec3 p = from + t * along;
    const std::span<const Vec3> c = pool.corners(piece);
    for (std::size_t k = 0; k < c.size(); ++k) {
        const Vec3& b = c[k + 1 == c.size() ? 0 : k + 1];
        if (dot(cross(b - c[k], p - c[k]), plane.normal) < 0.0) return kNever;
    }
    return t;
}

std::vector<FacetPiece> visit(const FacetTree& tree, const BeamApex& apex, const BeamSides& sides,
                              bool reject, FacetWalkCounts& counts) {
    std::vector<FacetPiece> order;
    FacetWalk walk(tree, apex, reject);
    while (true) {
        const std::span<const FacetPiece> pieces = walk.next(sides, counts);
        if (pieces.empty()) return order;
        order.insert(order.end(), pieces.begin(), pieces.end());
    }
}

void expect_in_order(const FacetPool& pool, std::span<const FacetPiece> order, const Vec3& from,
                     const Vec3& along, const char* what) {
    double last = 0.0;
    for (const FacetPiece& piece : order) {
        const double t = meets(pool, piece, from, along);
        if (!std::isfinite(t)) continue;
        ASSERT_GE(t, last - 1e-9) << what << " from " << from.x << " " << from.y << " " << from.z;
        last = t;
    }
}

double area_of(const FacetPool& pool, const FacetPiece& piece) {
    const std::span<const Vec3> c = pool.corners(piece);
    Vec3 sum;
    for (std::size_t k = 2; k < c.size(); ++k) sum += cross(c[k - 1] - c[0], c[k] - c[0]);
    return 0.5 * dot(sum, pool.planes[piece.facet].normal);
}

/// A beam of four sides around an axis.
struct Beam {
    BeamApex apex;
    BeamProjection projection;
    BeamSides sides;
};
Beam narrow_beam(const Vec3& from, const Vec3& along, double width) {
    const Vec3 u = perpendicular(along), v = cross(along, u);
    Beam beam;
    beam.apex = {from, 1};
    const auto row = [&](const Vec3& n) {
        return std::array<double, 4>{n.x, n.y, n.z, -dot(n, from)};
    };
    beam.projection.rows = {row(u / width), row(v / width), row(along)};
    beam.sides = {beam.projection.plane(1, 0, 1), beam.projection.plane(-1, 0, 1),
                  beam.projection.plane(0, 1, 1), beam.projection.plane(0, -1, 1),
                  beam.projection.plane(0, 0, 1)};
    return beam;
}

TEST(FacetTree, PiecesComeNearestFirstFromEverywhere) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const Polygons polygons = crossing_polygons(200, 0.35, seed);
        const FacetTree tree = polygons.tree();
        EXPECT_GT(tree.report().splits, 0u);
        Dice dice{std::mt19937_64(seed + 10)};
        FacetWalkCounts counts;
        for (int k = 0; k < 25; ++k) {
            const Vec3 from = dice.point(2.0);
            const auto order = visit(tree, {from, 1}, {}, false, counts);
            ASSERT_EQ(order.size(), tree.report().pieces);
            for (int i = 0; i < 40; ++i) {
                const Vec3 along = normalize(dice.point(1.0));
                expect_in_order(tree.pool(), order, from, along, "point");
            }
        }
    }
}

TEST(FacetTree, PiecesComeNearestFirstAlongParallelBeams) {
    const Polygons polygons = crossing_polygons(200, 0.4, 4);
    const FacetTree tree = polygons.tree();
    Dice dice{std::mt19937_64(11)};
    FacetWalkCounts counts;
    for (int k = 0; k < 40; ++k) {
        const Vec3 along = normalize(dice.point(1.0));
        const auto order = visit(tree, {-along, 0}, {}, false, counts);
        for (int i = 0; i < 40; ++i) {
            expect_in_order(tree.pool(), order, dice.point(1.0) - 10.0 * along, along, "parallel");
        }
    }
}

TEST(FacetTree, SplitsLoseNoArea) {
    const Polygons polygons = crossing_polygons(120, 0.5, 6);
    const FacetTree tree = polygons.tree();
    std::vector<double> left(polygons.pool.planes.size());
    for (const FacetPiece& piece : polygons.pieces) {
        left[piece.facet] += area_of(polygons.pool, piece);
    }
    for (const FacetPiece& piece : tree.pieces()) left[piece.facet] -= area_of(tree.pool(), piece);
    for (const double area : left) EXPECT_NEAR(area, 0.0, 1e-9);
}

TEST(FacetTree, HullsLoseNothingThatABeamMeets) {
    for (const Polygons& polygons :
         {crossing_polygons(400, 0.2, 7), city(12), sphere_mesh(20), crossing_polygons(9, 1, 8)}) {
        const FacetTree tree = polygons.tree();
        Dice dice{std::mt19937_64(21)};
        FacetWalkCounts counts;
        std::uint64_t met = 0;
        for (int k = 0; k < 200; ++k) {
            const Vec3 from = dice.point(8.0);
            const Beam beam =
                narrow_beam(from, normalize(dice.point(1.0) - from), dice(0.001, 0.2));
            std::set<std::uint32_t> visited;
            for (const FacetPiece& p : visit(tree, beam.apex, beam.sides, true, counts)) {
                visited.insert(p.first);
            }
            std::vector<Vec3> loop, clipped;
            for (const FacetPiece& piece : tree.pieces()) {
                const std::span<const Vec3> corners = tree.pool().corners(piece);
                loop.assign(corners.begin(), corners.end());
                for (const FacetPlane& side : beam.sides) {
                    clip_before(side, 0.0, loop, clipped);
                    loop.swap(clipped);
                }
                if (loop.empty()) continue;
                ++met;
                ASSERT_TRUE(visited.contains(piece.first)) << k;
            }
        }
        EXPECT_GT(met, 100u);
        EXPECT_GE(counts.polygons, met);
    }
}

TEST(FacetTree, AConvexMeshIsNoList) {
    const Polygons polygons = sphere_mesh(60);
    const FacetTree tree = polygons.tree();
    EXPECT_LT(tree.report().depth, 100u);
    EXPECT_LT(tree.report().pieces, 2 * polygons.pieces.size());
}

TEST(FacetTree, NarrowBeamsAreOfferedAFifthOfThePolygonsAtMost) {
    const Polygons polygons = city(40);
    const FacetTree tree = polygons.tree();
    Dice dice{std::mt19937_64(3)};
    FacetWalkCounts with, without;
    for (int k = 0; k < 50; ++k) {
        const Vec3 from{20, -20, 15};
        const Vec3 to{dice(0, 40), dice(0, 40), dice(0, 5)};
        const Beam beam = narrow_beam(from, normalize(to - from), 0.05);
        (void)visit(tree, beam.apex, beam.sides, true, with);
        (void)visit(tree, beam.apex, beam.sides, false, without);
    }
    EXPECT_LT(5 * with.polygons, without.polygons);
}

TEST(FacetTree, AnEmptySceneHasNoNodes) {
    const FacetTree tree = Polygons{}.tree();
    FacetWalkCounts counts;
    EXPECT_TRUE(tree.empty());
    EXPECT_TRUE(visit(tree, {}, {}, true, counts).empty());
}

TEST(FacetTree, TheTreeDependsOnThePolygonsAlone) {
    const Polygons polygons = crossing_polygons(200, 0.4, 9);
    const FacetTree a = polygons.tree(), b = polygons.tree();
    ASSERT_EQ(a.pieces().size(), b.pieces().size());
    for (std::size_t k = 0; k < a.pool().points.size(); ++k) {
        ASSERT_EQ(a.pool().points[k], b.pool().points[k]);
    }
}

TEST(DepthOrder, ComesNearestFirst) {
    const Polygons polygons = crossing_polygons(120, 0.4, 12);
    Dice dice{std::mt19937_64(31)};
    for (int k = 0; k < 20; ++k) {
        const Vec3 from = 4.0 * normalize(dice.point(1.0));
        const Beam beam = narrow_beam(from, normalize(-from), 0.6);
        FacetPool pool = polygons.pool;
        DepthOrderReport report;
        const auto order = depth_order(pool, polygons.pieces, beam.apex, beam.projection,
                                       beam.sides, 1e-11, report);
        EXPECT_EQ(report.polygons, polygons.pieces.size());
        for (int i = 0; i < 40; ++i) {
            const Vec3 along = normalize(0.7 * dice.point(1.0) - from);
            expect_in_order(pool, order, from, along, "list");
        }
    }
}

TEST(DepthOrder, OfPolygonsInOnePlaneTheFirstIsNearest) {
    const auto square = [](double x, double size) {
        return std::array<Vec3, 4>{
            {{x, -size, 0}, {x + 2 * size, -size, 0}, {x + 2 * size, size, 0}, {x, size, 0}}};
    };
    const Vec3 from{0.2, 0.1, 4};
    const Beam beam = narrow_beam(from, {0, 0, -1}, 0.6);
    // In either order of the list, and of either orientation.
    for (const bool reversed : {false, true}) {
        for (const bool turned : {false, true}) {
            Polygons polygons;
            for (int k = 0; k < 4; ++k) {
                std::array<Vec3, 4> corners = square(-1 + 0.1 * k, 1);
                if (turned && k % 2 == 1) std::reverse(corners.begin(), corners.end());
                polygons.add(corners);
            }
            if (reversed) std::reverse(polygons.pieces.begin(), polygons.pieces.end());
            DepthOrderReport report;
            const auto order = depth_order(polygons.pool, polygons.pieces, beam.apex,
                                           beam.projection, beam.sides, 1e-11, report);
            ASSERT_EQ(order.size(), 4u);
            for (std::uint32_t k = 0; k < 4; ++k) EXPECT_EQ(order[k].facet, k);
        }
    }
}

double reach(std::span<const Vec3> points, const Vec3& along) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) most = std::max(most, dot(along, p));
    return most;
}

TEST(PointHull, ReachesAsFarAsThePoints) {
    Dice dice{std::mt19937_64(41)};
    for (int k = 0; k < 300; ++k) {
        std::vector<Vec3> points;
        const int count = 5 + k % 130;
        for (int i = 0; i < count; ++i) {
            Vec3 p = dice.point(1.0);
            if (k % 5 == 1) p = normalize(p);
            if (k % 5 == 2) p.z = 0.25 * p.x;
            if (k % 5 == 3) p = {std::round(2 * p.x), std::round(2 * p.y), std::round(2 * p.z)};
            if (k % 5 == 4) p = {p.x, 2 * p.x, -p.x};
            points.push_back(p);
        }
        std::vector<Vec3> hull = points;
        const std::size_t most = k % 2 == 0 ? 40 : 1000;
        reduce_to_hull(hull, most);
        EXPECT_LE(hull.size(), std::max<std::size_t>(most, 48));
        for (int i = 0; i < 100; ++i) {
            const Vec3 along = normalize(dice.point(1.0));
            const double of_hull = reach(hull, along), of_points = reach(points, along);
            EXPECT_GE(of_hull, of_points - 1e-9) << k;
            if (most == 1000 && k % 5 < 4) {
                EXPECT_LE(of_hull, of_points + 1e-9) << k;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
