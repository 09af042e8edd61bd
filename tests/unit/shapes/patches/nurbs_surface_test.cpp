// NURBS surfaces: values, pieces, crossings, trimming loops, bad input.

#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"

#include <gtest/gtest.h>

#include "alhazen/shapes/patches/nurbs/trim_region.h"
#include "alhazen/shapes/quadrics/cylinder.h"
#include "support/any_ray.h"
#include "support/random_patches.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::RandomShape;

const double kHalfRoot = std::sqrt(0.5);

/// A circle as four quarters, counterclockwise.
TrimLoop circle_loop(const Vec2& center, double radius) {
    TrimCurve curve{.degree = 2, .knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}};
    const double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    for (int k = 0; k < 9; ++k) {
        curve.points.push_back({center.x + radius * x[k], center.y + radius * y[k]});
        curve.weights.push_back(k % 2 == 0 ? 1.0 : kHalfRoot);
    }
    return {curve};
}

TrimLoop star_loop(const Vec2& center, double radius) {
    TrimCurve curve;
    for (int k = 0; k < 10; ++k) {
        const double angle = 0.2 * kPi * k + 0.1, r = k % 2 == 0 ? radius : 0.45 * radius;
        curve.points.push_back({center.x + r * std::cos(angle), center.y + r * std::sin(angle)});
    }
    curve.points.push_back(curve.points[0]);
    return {curve};
}

/// Whether p is inside of a closed polyline: crossings of the half-line, by the definition.
bool inside_polyline(const std::vector<Vec2>& points, const Vec2& p) {
    bool inside = false;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec2 a = points[k], b = points[k + 1];
        if ((a.y > p.y) == (b.y > p.y)) continue;
        const double u = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        if (u > p.x) inside = !inside;
    }
    return inside;
}

std::string findings(const NurbsSurface& s) {
    Diagnostics diagnostics;
    s.validate({}, diagnostics);
    std::string text;
    for (const Diagnostic& finding : diagnostics.all()) text += finding.message + "\n";
    return text;
}

TEST(TrimRegion, KeepsWhatIsInsideOfARationalCircle) {
    const Vec2 center{0.4, 0.6};
    const double radius = 0.3;
    const std::vector<TrimLoop> loops{circle_loop(center, radius)};
    const TrimRegion region(loops);
    Random random(1);
    int inside = 0;
    for (int i = 0; i < 100000; ++i) {
        Vec2 p{random.uniform(0, 1), random.uniform(0, 1)};
        if (i % 4 == 0) {  // close to the circle
            const double angle = random.uniform(0, 2 * kPi);
            const double r =
                radius * (1 + (random.coin() ? 1 : -1) * random.log_uniform(1e-13, 1e-3));
            p = {center.x + r * std::cos(angle), center.y + r * std::sin(angle)};
        }
        const double distance = std::hypot(p.x - center.x, p.y - center.y) - radius;
        if (std::abs(distance) < 1e-15) continue;
        ASSERT_EQ(region.contains(p), distance < 0.0) << i << " " << distance;
        inside += distance < 0.0;
    }
    EXPECT_GT(inside, 20000);
}

TEST(TrimRegion, CountsLoopsByParity) {
    const std::vector<TrimLoop> loops{
        {TrimCurve{.points = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}}}},
        star_loop({1.5, 1.5}, 1.25),
        circle_loop({1.5, 1.5}, 0.375),
    };
    const TrimRegion region(loops);
    Random random(2);
    for (int i = 0; i < 50000; ++i) {
        Vec2 p{random.uniform(-1, 5), random.uniform(-1, 4)};
        // Heights and places of the corners, too.
        if (i % 8 == 0) p.y = loops[1][0].points[std::size_t(random.below(10))].y;
        const bool expected =
            inside_polyline(loops[0][0].points, p) !=
            (inside_polyline(loops[1][0].points, p) != (std::hypot(p.x - 1.5, p.y - 1.5) < 0.375));
        ASSERT_EQ(region.contains(p), expected) << p.x << " " << p.y;
    }
}

TEST(TrimRegion, CoverIsTrueOfEveryPoint) {
    const std::vector<TrimLoop> loops{circle_loop({0, 0}, 1.0), star_loop({0.1, 0}, 0.5)};
    const TrimRegion region(loops);
    Random random(3);
    int all = 0, none = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec2 lo{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
        const Vec2 hi = lo + Vec2{random.log_uniform(1e-3, 0.5), random.log_uniform(1e-3, 0.5)};
        const TrimRegion::Cover cover = region.cover(lo, hi);
        if (cover == TrimRegion::Cover::Some) continue;
        (cover == TrimRegion::Cover::All ? all : none) += 1;
        for (int k = 0; k < 20; ++k) {
            const Vec2 p{random.uniform(lo.x, hi.x), random.uniform(lo.y, hi.y)};
            ASSERT_EQ(region.contains(p), cover == TrimRegion::Cover::All);
        }
    }
    EXPECT_GT(all, 100);
    EXPECT_GT(none, 100);
}

/// Cox and de Boor's recursion.
double basis(const std::vector<double>& knots, std::size_t i, int degree, double u) {
    if (degree == 0) {
        const bool last = u == knots[knots.size() - 1] && knots[i + 1] == u && knots[i] < u;
        return (knots[i] <= u && u < knots[i + 1]) || last ? 1.0 : 0.0;
    }
    const auto d = static_cast<std::size_t>(degree);
    double sum = 0.0;
    if (knots[i + d] > knots[i]) {
        sum += (u - knots[i]) / (knots[i + d] - knots[i]) * basis(knots, i, degree - 1, u);
    }
    if (knots[i + d + 1] > knots[i + 1]) {
        sum += (knots[i + d + 1] - u) / (knots[i + d + 1] - knots[i + 1]) *
               basis(knots, i + 1, degree - 1, u);
    }
    return sum;
}

Vec3 value_of(const NurbsSurface& s, double u, double v) {
    const std::size_t nu = s.knots_u.size() - s.degree_u - 1;
    const std::size_t nv = s.knots_v.size() - s.degree_v - 1;
    Vec3 sum;
    double weight = 0.0;
    for (std::size_t i = 0; i < nu; ++i) {
        const double bu = basis(s.knots_u, i, int(s.degree_u), u);
        for (std::size_t j = 0; j < nv; ++j) {
            const double w = bu * basis(s.knots_v, j, int(s.degree_v), v) *
                             (s.weights.empty() ? 1.0 : s.weights[i * nv + j]);
            sum = sum + w * s.points[i * nv + j];
            weight += w;
        }
    }
    return sum / weight;
}

TEST(NurbsSurface, PiecesHaveTheValuesOfTheBasisFunctions) {
    Random random(4);
    for (int i = 0; i < 60; ++i) {
        NurbsSurface s = RandomShape<NurbsSurface>::make({random, i % 2 == 1});
        s.trims.clear();
        s.prepare();
        for (int k = 0; k < 20; ++k) {
            const auto within = [&](const std::vector<double>& knots, std::uint32_t degree) {
                return random.uniform(knots[degree], knots[knots.size() - degree - 1]);
            };
            const double u = within(s.knots_u, s.degree_u), v = within(s.knots_v, s.degree_v);
            const Vec3 expected = value_of(s, u, v);
            for (std::size_t piece_index = 0; piece_index < s.tree->pieces().size();
                 ++piece_index) {
                const BezierPiece piece = s.tree->pieces()[piece_index];
                if (u < piece.lo.x || u > piece.hi.x || v < piece.lo.y || v > piece.hi.y) continue;
                const Vec3 found = point_at(piece.net, (u - piece.lo.x) / (piece.hi.x - piece.lo.x),
                                            (v - piece.lo.y) / (piece.hi.y - piece.lo.y));
                ASSERT_LT(length(found - expected), 1e-11 * (1 + length(expected))) << i;
            }
        }
    }
}

/// A cylinder about z of radius 1 and height 2, u around.
NurbsSurface round_sheet() {
    NurbsSurface s;
    s.degree_u = 2;
    s.degree_v = 1;
    s.knots_u = circle_loop({0, 0}, 1)[0].knots;
    s.knots_v = {0, 0, 1, 1};
    const TrimLoop circle = circle_loop({0, 0}, 1);
    for (std::size_t k = 0; k < 9; ++k) {
        for (const double z : {0.0, 2.0}) {
            s.points.push_back({circle[0].points[k].x, circle[0].points[k].y, z});
            s.weights.push_back(circle[0].weights[k]);
        }
    }
    return s;
}

TEST(NurbsSurface, TrimsKeepExactlyTheCrossingsInside) {
    NurbsSurface whole = round_sheet(), cut = round_sheet();
    cut.trims = {{TrimCurve{.points = {{0, 0}, {4, 0}, {4, 1}, {0, 1}, {0, 0}}}},
                 circle_loop({1.5, 0.5}, 0.375),
                 star_loop({3.25, 0.5}, 0.4)};
    ASSERT_EQ(findings(cut), "");
    whole.prepare();
    cut.prepare();
    Random random(5);
    int kept = 0, dropped = 0;
    for (int i = 0; i < 20000; ++i) {
        const Ray ray = testing::any_ray(whole.box(), random);
        ShapeHits all, some;
        whole.intersect(ray, all);
        cut.intersect(ray, some);
        std::size_t next = 0;
        for (const ShapeHit& hit : all) {
            const Vec2 p{hit.u, hit.v};
            const bool inside = std::hypot(p.x - 1.5, p.y - 0.5) > 0.375 &&
                                !inside_polyline(cut.trims[2][0].points, p);
            (inside ? kept : dropped) += 1;
            if (!inside) continue;
            ASSERT_LT(next, some.size()) << i;
            EXPECT_EQ(some[next].t, hit.t);
            EXPECT_EQ(some[next].u, hit.u);
            ++next;
        }
        ASSERT_EQ(next, some.size()) << i;
        ShapeHit first;
        ASSERT_EQ(first_hit(cut, ray, first), !some.empty()) << i;
        if (!some.empty()) {
            EXPECT_EQ(first.t, some.front().t);
        }
    }
    EXPECT_GT(kept, 5000);
    EXPECT_GT(dropped, 500);
}

TEST(NurbsSurface, PiecesInHolesAreLeftOut) {
    NurbsSurface s = round_sheet();
    s.trims = {{TrimCurve{.points = {{1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 0}}}}};
    s.prepare();
    ASSERT_LE(s.tree->pieces().size(), 3u);
    const Ray ray{.origin = {-3, 3, 1}, .direction = {1, -1, 0}};
    ShapeHits hits;
    s.intersect(ray, hits);
    ASSERT_EQ(hits.size(), 1u);
    const ShapeSurface surface = s.surface(ray, hits[0]);
    EXPECT_LT(length(surface.point - Vec3{-kHalfRoot, kHalfRoot, 1}), 1e-14);
    EXPECT_NEAR(surface.uv.x, 1.5 / 4, 1e-14);
}

TEST(NurbsSurface, BadInputIsNamed) {
    const auto with = [](auto change) {
        NurbsSurface s = round_sheet();
        change(s);
        return findings(s);
    };
    EXPECT_EQ(findings(round_sheet()), "");
    const auto expect = [&](auto change, const char* text) {
        const std::string found = with(change);
        EXPECT_NE(found.find(text), std::string::npos) << text << "\n" << found;
    };
    expect([](auto& s) { s.knots_u[4] = 0.5; }, "knot 4 is less than the one before it");
    expect([](auto& s) { s.knots_v = {0, 0, 0, 0}; }, "the domain is empty");
    expect([](auto& s) { s.knots_u[3] = kInfinity; }, "knot 3 must be a finite number");
    expect([](auto& s) { s.degree_u = 40; }, "degree_u must be from 1 to 7, not 40");
    expect([](auto& s) { s.weights[3] = 0; }, "weight 3");
    expect([](auto& s) { s.weights[3] = -1; }, "weight 3");
    expect(
        [](auto& s) {
            s.trims = {{TrimCurve{.points = {{1, 0}, {2, 0}}, .weights = {1, 1e-9}}}};
        },
        "weight 1 must be from 1e-6 to 1e6, not 1e-09");
    expect([](auto& s) { s.points[2].y = std::nan(""); }, "point 2");
    expect(
        [](auto& s) {
            s.points.pop_back();
            s.weights.pop_back();
        },
        "need 9 x 2 points, found 17");
    expect([](auto& s) { s.trims = {TrimLoop{}}; }, "loop 0 has no curves");
    expect(
        [](auto& s) {
            s.trims = {{TrimCurve{.points = {{1, 0.2}, {2, 0.2}, {2, 0.8}}}}};
        },
        "loop 0 is open: curve 0 ends at (2.0");
    expect(
        [](auto& s) {
            s.trims = {{TrimCurve{.points = {{1, .2}, {2, .8}, {2, .2}, {1, .8}, {1, .2}}}}};
        },
        "loop 0 crosses itself near (1.5");
    expect(
        [](auto& s) {
            s.trims = {circle_loop({1, .5}, .3), circle_loop({1.2, .5}, .3)};
        },
        "loop 0 crosses loop 1 near (1.1");
    expect(
        [](auto& s) {
            s.trims = {{TrimCurve{.degree = 3, .points = {{0, 0}, {1, 1}}}}};
        },
        "without knots has 4 points, not 2");
    expect(
        [](auto& s) {
            s.trims = {{TrimCurve{.degree = 16, .points = {{0, 0}, {1, 1}}}}};
        },
        "the degree must be from 1 to 15, not 16");
    expect(
        [](auto& s) {
            s.trims = {circle_loop({1, .5}, .3)};
            s.trims[0][0].knots[5] = 0.5;
        },
        "curve 0: knot 5 is less");
    expect(
        [](auto& s) {
            s.trims = {circle_loop({1, .5}, .3)};
            s.trims[0][0].weights[1] = 0;
        },
        "curve 0: weight 1");
    expect(
        [](auto& s) {
            s.trims = {circle_loop({1, .5}, .3)};
            s.trims[0][0].points[1].x = std::nan("");
        },
        "curve 0: point 1");
}

TEST(NurbsSurface, LoopsThatTouchOrNestDoNotCross) {
    NurbsSurface s = round_sheet();
    s.trims = {circle_loop({1, .5}, .25),
               circle_loop({1.5, .5}, .25),
               circle_loop({1, .5}, .125),
               {TrimCurve{.points = {{2, 0.2}, {3, 0.2}, {3, 0.8}, {2, 0.8}, {2, 0.2}}}},
               {TrimCurve{.points = {{3, 0.2}, {4, 0.2}, {4, 0.8}, {3, 0.8}, {3, 0.2}}}}};
    EXPECT_EQ(findings(s), "");
    // Rounded ends are joined.
    s.trims = {{TrimCurve{.points = {{2, 0.2}, {3, 0.2}, {3, 0.8}}},
                TrimCurve{.points = {{3 + 1e-8, 0.8}, {2, 0.8}, {2, 0.2 - 1e-8}}}}};
    EXPECT_EQ(findings(s), "");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
