// Triangles of trimmed NURBS surfaces: few, within the tolerance, and without cracks.

#include "alhazen/shapes/tessellation/trimmed_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "alhazen/geometry/polygon/merged_positions.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/shapes/patches/nurbs/trim_arcs.h"
#include "alhazen/shapes/shape_tessellation.h"
#include "support/random_shapes.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using std::numbers::pi;
using testing::Random;

constexpr std::uint64_t kLimit = 500'000;

TrimLoop circle_loop(Vec2 center, double radius_u, double radius_v) {
    TrimCurve curve{.degree = 2, .knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}};
    for (int k = 0; k < 9; ++k) {
        const double f = k % 2 == 0 ? 1.0 : std::sqrt(2.0);
        curve.points.push_back({center.x + radius_u * f * std::cos(k * pi / 4),
                                center.y + radius_v * f * std::sin(k * pi / 4)});
        curve.weights.push_back(1.0 / f);
    }
    return {curve};
}
TrimLoop polyline_loop(std::vector<Vec2> points) {
    points.push_back(points.front());
    return {TrimCurve{.points = std::move(points)}};
}
TrimLoop rectangle_loop(Vec2 lo, Vec2 hi) {
    return polyline_loop({lo, {hi.x, lo.y}, hi, {lo.x, hi.y}});
}

std::vector<double> clamped_knots(std::uint32_t degree, std::size_t spans) {
    std::vector<double> knots(degree + 1, 0.0);
    for (std::size_t k = 1; k < spans; ++k) knots.push_back(double(k));
    knots.insert(knots.end(), degree + 1, double(spans));
    return knots;
}

/// A plane of `spans` by `spans` over the square of that size, x = u and y = v.
NurbsSurface flat_sheet(std::size_t spans, std::vector<TrimLoop> trims) {
    NurbsSurface sheet;
    sheet.degree_u = sheet.degree_v = 1;
    sheet.knots_u = sheet.knots_v = clamped_knots(1, spans);
    for (std::size_t i = 0; i <= spans; ++i) {
        for (std::size_t j = 0; j <= spans; ++j) sheet.points.push_back({double(i), double(j), 0});
    }
    sheet.trims = std::move(trims);
    return sheet;
}

/// Bicubic hills over the square of the size `spans`.
NurbsSurface hills(std::size_t spans, std::vector<TrimLoop> trims) {
    NurbsSurface sheet;
    sheet.knots_u = sheet.knots_v = clamped_knots(3, spans);
    for (std::size_t i = 0; i < spans + 3; ++i) {
        for (std::size_t j = 0; j < spans + 3; ++j) {
            const double high = 0.8 * std::sin(1.3 * double(i)) * std::cos(0.9 * double(j));
            sheet.points.push_back({double(i), double(j) + 0.1 * double(i % 2), high});
        }
    }
    sheet.trims = std::move(trims);
    return sheet;
}

/// A cylinder of radius 1 and height 2 over [0, 4] x [0, 2], u around it.
NurbsSurface cylinder(std::vector<TrimLoop> trims) {
    NurbsSurface s;
    s.degree_u = 2;
    s.degree_v = 1;
    s.knots_u = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    s.knots_v = {0, 0, 2, 2};
    for (int k = 0; k < 9; ++k) {
        const double f = k % 2 == 0 ? 1.0 : std::sqrt(2.0);
        for (const double z : {0.0, 2.0}) {
            s.points.push_back({f * std::cos(k * pi / 4), f * std::sin(k * pi / 4), z});
            s.weights.push_back(1.0 / f);
        }
    }
    // Ends where it begins, to the bit.
    s.points[16] = s.points[0];
    s.points[17] = s.points[1];
    s.trims = std::move(trims);
    return s;
}

/// A unit sphere over [0, 4] x [0, 2], u around it, v from pole to pole.
NurbsSurface ball(std::vector<TrimLoop> trims) {
    NurbsSurface s;
    s.degree_u = s.degree_v = 2;
    s.knots_u = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    s.knots_v = {0, 0, 0, 1, 1, 2, 2, 2};
    const double profile[5][3] = {{0, -1, 1}, {1, -1, 0.5}, {1, 0, 1}, {1, 1, 0.5}, {0, 1, 1}};
    for (int k = 0; k < 9; ++k) {
        const double f = k % 2 == 0 ? 1.0 : std::sqrt(2.0);
        for (const auto& [r, z, w] : profile) {
            const double weight = w == 1.0 ? 1.0 : std::sqrt(0.5);
            s.points.push_back({r * f * std::cos(k * pi / 4), r * f * std::sin(k * pi / 4), z});
            s.weights.push_back(weight / f);
        }
    }
    s.trims = std::move(trims);
    return s;
}

Vec3 point_of(const std::vector<BezierPiece>& pieces, const Vec2& uv) {
    const BezierPiece* best = nullptr;
    double least = kInfinity;
    for (const BezierPiece& piece : pieces) {
        const double off = std::max(
            {piece.lo.x - uv.x, uv.x - piece.hi.x, piece.lo.y - uv.y, uv.y - piece.hi.y, 0.0});
        if (off < least) least = off, best = &piece;
    }
    const auto at = [](double x, double lo, double hi) {
        return std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
    };
    return point_at(best->net, at(uv.x, best->lo.x, best->hi.x), at(uv.y, best->lo.y, best->hi.y));
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double size = dot(along, along);
    const double s = size > 0.0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0.0;
    return length(p - (a + s * along));
}

struct Findings {
    std::size_t triangles = 0;
    double area = 0;
    double off_surface = 0;    ///< largest distance of points of triangles from the surface
    double off_loops = 0;      ///< largest distance of points of loops from the rim
    double off_rim = 0;        ///< the same, the other way round
    std::size_t overused = 0;  ///< edges of more than two triangles
};

/// Segments between close points of the loops on the surface.
std::vector<std::array<Vec3, 2>> loop_segments(const NurbsSurface& shape,
                                               const std::vector<BezierPiece>& pieces) {
    std::vector<std::array<Vec3, 2>> segments;
    for (const TrimArc& arc : trim_arcs(shape.trims, kInfinity)) {
        std::vector<TrimPiece> open{halved(arc).first, halved(arc).second};
        for (int depth = 0; depth < 6; ++depth) {
            std::vector<TrimPiece> next;
            for (const TrimPiece& piece : open) {
                next.push_back(halved(piece).first);
                next.push_back(halved(piece).second);
            }
            open = std::move(next);
        }
        for (const TrimPiece& piece : open) {
            segments.push_back({point_of(pieces, piece.begin), point_of(pieces, piece.end)});
        }
    }
    return segments;
}

Findings examine(NurbsSurface shape, double tolerance) {
    shape.prepare();
    TriangleMesh mesh;
    EXPECT_EQ(append_triangles(AnyShape{shape}, tolerance, kLimit, mesh), "");
    Findings found;
    found.triangles = mesh.triangles.size();
    NurbsSurface whole = shape;
    whole.trims.clear();
    whole.prepare();
    std::vector<BezierPiece> pieces;
    append_pieces(whole, pieces);
    const Vec2 lo{shape.knots_u.front(), shape.knots_v.front()};
    const Vec2 size{shape.knots_u.back() - lo.x, shape.knots_v.back() - lo.y};
    const auto in_domain = [&](const Vec2& uv) {
        return Vec2{lo.x + uv.x * size.x, lo.y + uv.y * size.y};
    };
    Random random(1);
    const std::vector<std::uint32_t> merged = merged_positions(mesh.positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        found.area += 0.5 * length(cross(b - a, c - a));
        for (int i = 0; i < 4; ++i) {
            double s = random.uniform(), r = random.uniform();
            if (s + r > 1.0) s = 1.0 - s, r = 1.0 - r;
            const Vec2 uv = s * mesh.uvs[t[0]] + r * mesh.uvs[t[1]] + (1 - s - r) * mesh.uvs[t[2]];
            const Vec3 p = s * a + r * b + (1 - s - r) * c;
            found.off_surface =
                std::max(found.off_surface, length(p - point_of(pieces, in_domain(uv))));
        }
        for (std::size_t k = 0; k < 3; ++k) {
            // Vertices are points of the surface.
            EXPECT_LT(length(mesh.positions[t[k]] - point_of(pieces, in_domain(mesh.uvs[t[k]]))),
                      1e-11);
            const std::uint32_t from = merged[t[k]], to = merged[t[(k + 1) % 3]];
            ++edges[std::minmax(from, to)];
        }
    }
    struct RimEdge {
        Vec3 a, b;
    };
    std::vector<RimEdge> rim;
    for (const auto& [edge, count] : edges) {
        if (count > 2) ++found.overused;
        if (count == 1) rim.push_back({mesh.positions[edge.first], mesh.positions[edge.second]});
    }
    const std::vector<std::array<Vec3, 2>> exact = loop_segments(shape, pieces);
    for (const auto& [p, end] : exact) {
        // Where two loops have one curve, at a seam too, there is no rim.
        const auto is_here = [&, q = p](const auto& s) { return length(s[0] - q) < 1e-9; };
        if (std::count_if(exact.begin(), exact.end(), is_here) > 1) continue;
        double least = kInfinity;
        for (const RimEdge& edge : rim) {
            least = std::min(least, distance_to_segment(p, edge.a, edge.b));
        }
        found.off_loops = std::max(found.off_loops, least);
    }
    for (const RimEdge& edge : rim) {
        for (const Vec3& p : {edge.a, 0.5 * (edge.a + edge.b)}) {
            double least = kInfinity;
            for (const auto& s : exact) least = std::min(least, distance_to_segment(p, s[0], s[1]));
            found.off_rim = std::max(found.off_rim, least);
        }
    }
    return found;
}

void expect_good(const Findings& found, double tolerance, double chords = 1e-3) {
    EXPECT_EQ(found.overused, 0u);
    EXPECT_LE(found.off_surface, tolerance * (1 + 1e-9));
    EXPECT_LE(found.off_loops, tolerance * (1 + 1e-9));
    // The loops that it is measured from are chords of their own.
    EXPECT_LE(found.off_rim, tolerance + chords);
}

TEST(TrimmedTriangles, AHoleInAPlaneTakesTheRootOfTheToleranceOfTriangles) {
    const double radius = 0.5;
    for (const std::size_t spans : {1u, 3u}) {
        const double side = double(spans), middle = 0.5 * side;
        for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
            const NurbsSurface sheet =
                flat_sheet(spans, {rectangle_loop({0, 0}, {side, side}),
                                   circle_loop({middle, middle * 0.9}, radius * side / 2, 0.3)});
            const Findings found = examine(sheet, tolerance);
            expect_good(found, tolerance);
            EXPECT_LT(double(found.triangles), 60 * double(spans) + 20 / std::sqrt(tolerance));
            EXPECT_NEAR(found.area, side * side - pi * radius * side / 2 * 0.3,
                        tolerance * pi * side);
        }
    }
}

TEST(TrimmedTriangles, ARectangleOfAFlatPatchTakesAHandful) {
    NurbsSurface flat;
    flat.knots_u = flat.knots_v = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) flat.points.push_back({double(j), double(i), 0});
    }
    flat.trims = {rectangle_loop({3.5, 3}, {5, 4.25})};
    flat.prepare();
    for (const double tolerance : {1e-1, 1e-4, 1e-9}) {
        TriangleMesh mesh;
        EXPECT_EQ(append_triangles(AnyShape{flat}, tolerance, kLimit, mesh), "");
        EXPECT_LE(mesh.triangles.size(), 60u);
        double area = 0.0;
        for (const auto& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t[0]];
            area += 0.5 * cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).z;
        }
        EXPECT_NEAR(std::abs(area), 1.5 * 1.25, 1e-12);
    }
}

TEST(TrimmedTriangles, LoopsAcrossPatchesAndSeamsOfACylinder) {
    for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
        const Findings found =
            examine(cylinder({rectangle_loop({0, 0}, {4, 2}), circle_loop({2, 1}, 1.5, 0.9),
                              circle_loop({1.9, 1.1}, 1.2, 0.6), circle_loop({3, 1}, 0.01, 0.005)}),
                    tolerance);
        expect_good(found, tolerance);
    }
}

TEST(TrimmedTriangles, NestedAndTouchingLoopsOnHills) {
    // Two triangles share an edge, one touches the border of the domain, one has no area.
    const double s = 5;
    const std::vector<TrimLoop> trims{rectangle_loop({0, 0}, {s, s}),
                                      circle_loop({2.5, 2.5}, 2.2, 1.9),
                                      polyline_loop({{2, 2}, {3, 2}, {2.5, 3}}),
                                      polyline_loop({{2.5, 3}, {3, 2}, {3.5, 3}}),
                                      polyline_loop({{0, 0.5}, {0.3, 0.3}, {0.35, 0.7}}),
                                      polyline_loop({{1, 2.5}, {0.3, 2.5}, {1, 2.5}})};
    for (const double tolerance : {1e-1, 1e-2, 2e-3}) {
        expect_good(examine(hills(5, trims), tolerance), tolerance);
    }
}

TEST(TrimmedTriangles, LoopsAroundAndAcrossThePolesOfABall) {
    for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
        // A cap, and a loop from pole to pole.
        const Findings cap = examine(ball({rectangle_loop({0, 0}, {4, 0.5})}), tolerance);
        EXPECT_EQ(cap.overused, 0u);
        EXPECT_LE(cap.off_surface, tolerance);
        EXPECT_LE(cap.off_loops, tolerance);
        const Findings lune = examine(ball({rectangle_loop({1, 0}, {2, 2})}), tolerance);
        EXPECT_EQ(lune.overused, 0u);
        EXPECT_LE(lune.off_surface, tolerance);
        EXPECT_LE(lune.off_loops, tolerance);
        EXPECT_NEAR(lune.area, pi, 4 * tolerance);
        const Findings holes = examine(
            ball({rectangle_loop({0, 0}, {4, 2}), circle_loop({2.1, 1.1}, 1.5, 0.8)}), tolerance);
        EXPECT_EQ(holes.overused, 0u);
        EXPECT_LE(holes.off_surface, tolerance);
    }
}

/// A surface of random degrees, knots (some of several times), points and weights.
NurbsSurface random_surface(Random& random) {
    NurbsSurface s;
    const auto whole = [&](int least, int most) {
        return static_cast<std::uint32_t>(least + int(random.uniform() * (most - least + 1)));
    };
    const double origin = random.uniform() < 0.3 ? 1000.0 : 0.0;
    const auto knots = [&](std::uint32_t degree) {
        std::vector<double> list(degree + 1, origin);
        double at = origin;
        for (std::uint32_t k = whole(0, 4); k > 0; --k) {
            at += 0.1 + random.uniform();
            list.insert(list.end(), whole(1, 2) == 1 ? 1 : whole(1, int(degree)), at);
        }
        list.insert(list.end(), degree + 1, at + 0.5 + random.uniform());
        return list;
    };
    s.degree_u = whole(1, 4);
    s.degree_v = whole(1, 4);
    s.knots_u = knots(s.degree_u);
    s.knots_v = knots(s.degree_v);
    const std::size_t m = s.knots_u.size() - s.degree_u - 1, n = s.knots_v.size() - s.degree_v - 1;
    const bool rational = random.uniform() < 0.5;
    for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            s.points.push_back({double(i) + 0.3 * random.uniform(),
                                double(j) + 0.3 * random.uniform(), 0.7 * random.uniform()});
            if (rational) s.weights.push_back(0.5 + 1.5 * random.uniform());
        }
    }
    return s;
}

TEST(TrimmedTriangles, RandomSurfacesAndLoopsHaveNoCracks) {
    Random random(11);
    const int cases = testing::thorough() ? 40 : 8;
    for (int i = 0; i < cases; ++i) {
        NurbsSurface s = random_surface(random);
        const Vec2 lo{s.knots_u.front(), s.knots_v.front()}, hi{s.knots_u.back(), s.knots_v.back()};
        if (i % 2 == 0) s.trims.push_back(rectangle_loop(lo, hi));
        const int side = 1 + i % 3;
        for (int k = 0; k < side * side; ++k) {
            // One closed curve in each cell of a grid.
            const Vec2 cell{(hi.x - lo.x) / side, (hi.y - lo.y) / side};
            const Vec2 middle{lo.x + (k % side + 0.5) * cell.x,
                              lo.y + (double(k / side) + 0.5) * cell.y};
            TrimCurve curve{.degree = 3};
            const int spans = 4 + i % 5;
            for (int p = 0; p < spans + 3; ++p) {
                const double a = 2 * pi * (p % spans) / spans, r = 0.15 + 0.3 * random.uniform();
                curve.points.push_back(
                    p < spans ? middle + r * Vec2{cell.x * std::cos(a), cell.y * std::sin(a)}
                              : curve.points[static_cast<std::size_t>(p - spans)]);
            }
            for (int p = 0; p < spans + 7; ++p) curve.knots.push_back(p);
            s.trims.push_back({curve});
        }
        const double tolerance = i % 3 == 0 ? 0.1 : i % 3 == 1 ? 0.01 : 0.003;
        // Loops run across kinks.
        expect_good(examine(s, tolerance), tolerance, 0.05);
        if (::testing::Test::HasFailure()) FAIL() << "case " << i;
    }
}

TEST(TrimmedTriangles, RandomStarsHaveTheirAreaInAPlane) {
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        const std::size_t spans = 1 + static_cast<std::size_t>(i % 4);
        const double side = double(spans);
        std::vector<Vec2> star;
        const int corners = 5 + i % 30;
        for (int k = 0; k < corners; ++k) {
            double r = side * (0.05 + 0.45 * random.uniform());
            const double a = 2 * pi * k / corners, across = std::cos(a);
            const double line = std::round(0.5 * side + r * across);
            // Some on lines of knots.
            const double reach = (line - 0.5 * side) / across;
            const bool on_line = random.uniform() < 0.4 && reach > 0.01 && reach < 0.7 * side &&
                                 std::abs(reach * std::sin(a)) < 0.5 * side;
            if (on_line) r = reach;
            Vec2 p{0.5 * side + r * across, 0.5 * side + r * std::sin(a)};
            if (on_line) p.x = line;
            star.push_back(p);
        }
        double area = 0.0;
        for (std::size_t k = 0; k < star.size(); ++k) {
            const Vec2 a = star[k], b = star[(k + 1) % star.size()];
            area += 0.5 * (a.x * b.y - a.y * b.x);
        }
        const NurbsSurface sheet = flat_sheet(spans, {polyline_loop(star)});
        NurbsSurface prepared = sheet;
        prepared.prepare();
        TriangleMesh mesh;
        EXPECT_EQ(append_triangles(AnyShape{prepared}, 1e-3, kLimit, mesh), "");
        double sum = 0.0;
        for (const auto& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t[0]];
            sum += 0.5 * cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).z;
        }
        EXPECT_NEAR(sum, area, 1e-10 * side * side) << i;
    }
}

TEST(TrimmedTriangles, BeyondTheLimitThereAreNone) {
    NurbsSurface sheet = flat_sheet(2, {circle_loop({1, 1}, 0.9, 0.8)});
    sheet.prepare();
    TriangleMesh mesh;
    EXPECT_EQ(append_triangles(AnyShape{sheet}, 1e-12, 100'000, mesh), kTooManyTriangles);
    EXPECT_TRUE(mesh.positions.empty() && mesh.triangles.empty());
    EXPECT_EQ(append_triangles(AnyShape{sheet}, 1e-3, 100, mesh), kTooManyTriangles);
    EXPECT_TRUE(mesh.positions.empty() && mesh.triangles.empty());
}

TEST(TrimmedTriangles, LoopsThatRunAlongOneAnotherCancelThere) {
    // Divided at other points, along the border of the domain, lines of knots and each other.
    for (const std::size_t spans : {1u, 2u, 4u}) {
        const double s = double(spans);
        NurbsSurface sheet = flat_sheet(
            spans, {rectangle_loop({0, 0}, {s, s}),
                    rectangle_loop({0, 0}, {0.5 * s, 0.3 * s}),
                    polyline_loop({{0.5 * s, 0.2 * s}, {0.8 * s, 0.2 * s}, {0.5 * s, 0.6 * s}}),
                    circle_loop({0.7 * s, 0.7 * s}, 0.2 * s, 0.2 * s),
                    {TrimCurve{.degree = 3,
                               .points = {{0.1 * s, 0.5 * s},
                                          {0.4 * s, 0.5 * s},
                                          {0.4 * s, 0.9 * s},
                                          {0.1 * s, 0.5 * s}}}}});
        TrimCurve reversed = sheet.trims[3][0];
        std::reverse(reversed.points.begin(), reversed.points.end());
        std::reverse(reversed.weights.begin(), reversed.weights.end());
        sheet.trims.push_back({reversed});
        sheet.prepare();
        TriangleMesh mesh;
        EXPECT_EQ(append_triangles(AnyShape{sheet}, 1e-5, kLimit, mesh), "");
        double area = 0.0;
        for (const auto& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t[0]];
            area += 0.5 * cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).z;
        }
        // The curve from a point back to it encloses 3/20 of the parallelogram of its control
        // points; the circle twice is none.
        const double leaf = 3.0 / 20.0 * 0.3 * 0.4 * s * s;
        EXPECT_NEAR(area, s * s * (1 - 0.15 - 0.06) - leaf, 1e-4 * s);
    }
}

TEST(TrimmedTriangles, OutsideOfAllLoopsThereIsNothing) {
    for (const TrimLoop& loop :
         {polyline_loop({{0.5, 0.5}, {1.5, 0.5}, {0.5, 0.5}}), rectangle_loop({5, 5}, {6, 6})}) {
        NurbsSurface sheet = flat_sheet(2, {loop});
        sheet.prepare();
        TriangleMesh mesh;
        EXPECT_EQ(append_triangles(AnyShape{sheet}, 0.01, kLimit, mesh), "");
        EXPECT_TRUE(mesh.triangles.empty());
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
