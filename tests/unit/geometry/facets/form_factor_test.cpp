#include "alhazen/geometry/facets/form_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "alhazen/math/constants.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Loop = std::vector<Vec3>;

FacetPlane plane_of(std::span<const Vec3> loop) {
    const Vec3 n = normalize(cross(loop[1] - loop[0], loop[2] - loop[0]));
    return {n, dot(n, loop[0])};
}

FacetTree tree_of(const std::vector<Loop>& loops) {
    FacetPool pool;
    std::vector<FacetPiece> pieces;
    for (const Loop& loop : loops) {
        pool.planes.push_back(plane_of(loop));
        pieces.push_back(pool.add(static_cast<std::uint32_t>(pieces.size()), loop));
    }
    return FacetTree(std::move(pool), std::move(pieces));
}

/// A rectangle that runs counter-clockwise around u x v.
Loop rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
    return {corner, corner + u, corner + u + v, corner + v};
}

/// Equal rectangles of sides x and y that face each other at distance 1 (Howell, "A Catalog of
/// Radiation Heat Transfer Configuration Factors", C-11).
double facing_rectangles(double x, double y) {
    const double a = 1 + x * x, b = 1 + y * y;
    const double sum =
        0.5 * std::log(a * b / (a + y * y)) + x * std::sqrt(b) * std::atan(x / std::sqrt(b)) +
        y * std::sqrt(a) * std::atan(y / std::sqrt(a)) - x * std::atan(x) - y * std::atan(y);
    return 2 / (kPi * x * y) * sum;
}

const Loop kFloor = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
const Loop kCeiling = rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
const Loop kWall = rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1});

void expect_factor(double exact, const FormFactor& f, const FormFactorOptions& options = {}) {
    EXPECT_TRUE(f.converged(options)) << f.error;
    EXPECT_NEAR(f.value, exact, options.tolerance);
    EXPECT_LE(std::abs(f.value - exact), f.error + 1e-12) << "of " << f.points << " points";
}

TEST(FormFactor, OfFacingUnitSquaresIsTheClosedForm) {
    const FacetTree alone = tree_of({kFloor, kCeiling});
    EXPECT_NEAR(facing_rectangles(1, 1), 0.1998248957, 1e-10);
    expect_factor(facing_rectangles(1, 1), form_factor(alone, kFloor, kCeiling));
    const FormFactorOptions fine{.tolerance = 1e-9};
    expect_factor(facing_rectangles(1, 1), form_factor(alone, kFloor, kCeiling, fine), fine);
    const Loop away(kCeiling.rbegin(), kCeiling.rend());
    EXPECT_EQ(form_factor(alone, kFloor, away).value, 0.0);
}

TEST(FormFactor, OfSquaresThatMeetAtARightAngleIsTheClosedForm) {
    // Howell, C-14, of two unit squares.
    const double value = (kPi / 2 - std::sqrt(2.0) * std::atan(std::sqrt(0.5)) +
                          0.25 * std::log((2.0 * 2.0 / 3.0) * (3.0 / 4.0) * (3.0 / 4.0))) /
                         kPi;
    EXPECT_NEAR(value, 0.2000437762, 1e-9);
    expect_factor(value, form_factor(tree_of({kFloor, kWall}), kFloor, kWall));
}

TEST(FormFactor, AScreenAcrossTheMiddleLeavesEachHalfItsOwn) {
    const Loop screen = rectangle({0.5, -0.1, 0}, {0, 1.2, 0}, {0, 0, 1});
    expect_factor(facing_rectangles(0.5, 1),
                  form_factor(tree_of({kFloor, kCeiling, screen}), kFloor, kCeiling));
}

TEST(FormFactor, AScreenBelowTheCeilingHidesWhatIsAboveIt) {
    // Nearly on the ceiling: half of it is left. By symmetry that half gets half of the whole.
    const Loop screen = rectangle({0, 0, 1 - 1e-9}, {0.5, 0, 0}, {0, 1, 0});
    const FormFactorOptions options{.tolerance = 1e-6};
    expect_factor(0.5 * facing_rectangles(1, 1),
                  form_factor(tree_of({kFloor, kCeiling, screen}), kFloor, kCeiling, options),
                  {.tolerance = 2e-6});
    const Loop lid = rectangle({-1, -1, 0.5}, {3, 0, 0}, {0, 3, 0});
    EXPECT_EQ(form_factor(tree_of({kFloor, kCeiling, lid}), kFloor, kCeiling).value, 0.0);
}

TEST(FormFactor, OfAPointIsExact) {
    // A corner of a rectangle above the point (Howell, B-3): sides a and b at distance 1.
    const double a = 0.7, b = 1.9;
    const Loop loop = rectangle({0, 0, 1}, {0, b, 0}, {a, 0, 0});
    const double exact = (a / std::sqrt(1 + a * a) * std::atan(b / std::sqrt(1 + a * a)) +
                          b / std::sqrt(1 + b * b) * std::atan(a / std::sqrt(1 + b * b))) /
                         (2 * kPi);
    EXPECT_NEAR(form_factor({0, 0, 0}, {0, 0, 1}, loop), exact, 1e-15);
    // A screen at half the height of half the size hides it from there, whatever is its number of
    // pieces.
    const FacetTree hidden = tree_of({loop, rectangle({0, 0, 0.5}, {a / 2, 0, 0}, {0, b / 4, 0}),
                                      rectangle({0, b / 4, 0.5}, {a / 2, 0, 0}, {0, b / 4, 0})});
    EXPECT_NEAR(form_factor(hidden, {0, 0, 0}, {0, 0, 1}, loop), 0.0, 1e-15);
    EXPECT_NEAR(solid_angle({0.5, 0.5, 0.5}, kCeiling), 2 * kPi / 3, 1e-14);
    EXPECT_NEAR(form_factor({0.5, 0.5, 0}, {0, 0, -1}, kCeiling), 0.0, 0.0);
}

struct Dice {
    std::mt19937_64 engine;
    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53);
    }
    Vec3 point(double r) { return {(*this)(-r, r), (*this)(-r, r), (*this)(-r, r)}; }
};

bool within(const Loop& loop, const Vec3& p) {
    const Vec3 n = plane_of(loop).normal;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3& b = loop[(k + 1) % loop.size()];
        if (dot(cross(b - loop[k], p - loop[k]), n) < 0.0) return false;
    }
    return true;
}

bool hides(const Loop& loop, const Vec3& from, const Vec3& to) {
    const FacetPlane plane = plane_of(loop);
    const double a = plane.at(from), b = plane.at(to);
    return (a > 0) != (b > 0) && within(loop, from + (a / (a - b)) * (to - from));
}

/// Triangles and squares that cross each other below a square.
std::vector<Loop> clutter(int count, Dice& dice) {
    std::vector<Loop> loops;
    for (int k = 0; k < count; ++k) {
        const Vec3 at = dice.point(1.0), u = 0.3 * normalize(dice.point(1.0));
        const Vec3 v = cross(u, normalize(dice.point(1.0)));
        loops.push_back(k % 2 == 0 ? rectangle(at, u, v) : Loop{at, at + u, at + v});
    }
    return loops;
}

TEST(VisibleParts, AreThosePointsThatRaysReach) {
    Dice dice{std::mt19937_64(1978)};
    const Loop target = rectangle({-1, -1, 1.2}, {0, 2, 0}, {2, 0, 0});
    for (int scene = 0; scene < 12; ++scene) {
        const std::vector<Loop> loops = clutter(10 + 8 * scene, dice);
        const FacetTree tree = tree_of(loops);
        const Vec3 eye{dice(-1, 1), dice(-1, 1), -1.5};
        const std::vector<ConvexLoop> parts = visible_parts(tree, eye, target);
        int seen = 0;
        constexpr int kRays = 4000;
        for (int k = 0; k < kRays; ++k) {
            const Vec3 p{dice(-1, 1), dice(-1, 1), 1.2};
            const bool hidden = std::any_of(loops.begin(), loops.end(),
                                            [&](const Loop& loop) { return hides(loop, eye, p); });
            const auto holders = std::count_if(parts.begin(), parts.end(),
                                               [&](const Loop& part) { return within(part, p); });
            EXPECT_EQ(holders, hidden ? 0 : 1) << "scene " << scene << " at " << p.x << ' ' << p.y;
            seen += !hidden;
        }
        const VisibleAmount amount = visible_amount(tree, eye, target);
        const double share = amount.area / 4, spread = std::sqrt(0.25 / kRays);
        EXPECT_NEAR(share, double(seen) / kRays, 4 * spread);
    }
}

TEST(VisibleParts, SeeNothingBetweenFacetsThatShareAnEdge) {
    // A fan of triangles, whose shadow is one polygon.
    Dice dice{std::mt19937_64(7)};
    std::vector<Loop> fan;
    constexpr int kTriangles = 40;
    const auto corner = [](int k) {
        const double angle = 2 * kPi * k / kTriangles;
        return Vec3{0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.1 * std::sin(7 * angle)};
    };
    for (int k = 0; k < kTriangles; ++k) {
        fan.push_back({Vec3{0.02, 0.01, 0.03}, corner(k), corner((k + 1) % kTriangles)});
    }
    const FacetTree tree = tree_of(fan);
    const Loop small = rectangle({-0.1, -0.1, 0.5}, {0, 0.2, 0}, {0.2, 0, 0});
    for (int k = 0; k < 50; ++k) {
        const Vec3 eye{dice(-0.05, 0.05), dice(-0.05, 0.05), -4};
        EXPECT_LT(visible_amount(tree, eye, small).area, 1e-12);
    }
}

TEST(FormFactor, AmongClutterIsTheMeanOfRays) {
    Dice dice{std::mt19937_64(1760)};
    const Loop from = rectangle({-1, -1, -1.2}, {2, 0, 0}, {0, 2, 0});
    const Loop to = rectangle({-1, -1, 1.2}, {0, 2, 0}, {2, 0, 0});
    std::vector<Loop> loops = clutter(30, dice);
    const FormFactorOptions options{.tolerance = 2e-4};
    const FormFactor f = form_factor(tree_of(loops), from, to, options);
    EXPECT_TRUE(f.converged(options));
    double sum = 0, squares = 0;
    constexpr int kRays = 400'000;
    for (int k = 0; k < kRays; ++k) {
        const Vec3 a{dice(-1, 1), dice(-1, 1), -1.2}, b{dice(-1, 1), dice(-1, 1), 1.2};
        const bool hidden = std::any_of(loops.begin(), loops.end(),
                                        [&](const Loop& loop) { return hides(loop, a, b); });
        const Vec3 d = b - a;
        const double value =
            hidden ? 0.0 : 4 * d.z * d.z / (kPi * length_squared(d) * length_squared(d));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kRays;
    const double deviation = std::sqrt((squares / kRays - mean * mean) / kRays);
    EXPECT_LT(deviation, 1e-3);
    EXPECT_NEAR(f.value, mean, 4 * deviation + options.tolerance);
    // Reciprocity: the areas are equal.
    EXPECT_NEAR(form_factor(tree_of(loops), to, from, options).value, f.value,
                2 * options.tolerance);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
