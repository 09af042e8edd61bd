// Nearest points against rays: the distance to a shape is the least distance of the first crossings
// over all directions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "alhazen/math/unit_vector.h"
#include "alhazen/shapes/exact_surface.h"
#include "support/random_shapes.h"
#include "unit/shapes/nearest_on.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::nearest_on;
using testing::Random;
using testing::random_shape;

/// A placed shape with queries for first crossings and nearest points.
class Placed {
  public:
    template <class S>
    Placed(const S& shape, const Affine& place)
        : any_(shape), world_{place, inverse(place)}, surface_(any_, world_) {}

    [[nodiscard]] PointOnSurface nearest(const Vec3& from) const { return surface_.nearest(from); }
    /// The distance to the first crossing.
    [[nodiscard]] double first(const Vec3& from, const Vec3& direction) const {
        const Ray ray{world_.inner_from_outer.point(from),
                      world_.inner_from_outer.vector(direction), 0.0, kInfinity};
        ShapeHits hits;
        std::visit([&](const auto& s) { append_hits(s, ray, hits); },
                   static_cast<const AnalyticShapes::Variant&>(any_));
        return hits.size() > 0 ? hits[0].t : kInfinity;
    }
    /// The normal of the first crossing at about `t`; 0 if there is none.
    [[nodiscard]] Vec3 normal_at(const Vec3& from, const Vec3& direction, double t,
                                 double slack) const {
        const Ray ray{world_.inner_from_outer.point(from),
                      world_.inner_from_outer.vector(direction), 0.0, kInfinity};
        ShapeHits hits;
        return std::visit(
            [&](const auto& s) {
                append_hits(s, ray, hits);
                if (hits.size() == 0 || !(std::abs(hits[0].t - t) < slack)) return Vec3{};
                return normalize(transpose_times(world_.inner_from_outer.linear,
                                                 s.surface(ray, hits[0]).normal));
            },
            static_cast<const AnalyticShapes::Variant&>(any_));
    }
    [[nodiscard]] bool closed() const {
        return std::visit([](const auto& s) { return s.closed(); },
                          static_cast<const AnalyticShapes::Variant&>(any_));
    }
    [[nodiscard]] Box3 box() const {
        Box3 box;
        const Box3 own = std::visit([](const auto& s) { return s.box(); },
                                    static_cast<const AnalyticShapes::Variant&>(any_));
        for (int i = 0; i < 8; ++i) {
            const Vec3 corner{(i & 1 ? own.hi : own.lo).x, (i & 2 ? own.hi : own.lo).y,
                              (i & 4 ? own.hi : own.lo).z};
            Vec3 p = world_.outer_from_inner.point(corner);
            for (int k = 0; k < 3; ++k)
                p[k] = std::isfinite(p[k]) ? std::clamp(p[k], -50.0, 50.0) : 0.0;
            box.include(p);
        }
        return box;
    }

  private:
    AnyShape any_;
    Placement world_;
    ExactSurface surface_;
};

/// The least first crossing over directions near to `start`, found by smaller and smaller turns.
double refined(const Placed& shape, const Vec3& from, Vec3 direction, double size) {
    double best = shape.first(from, direction), step = 0.1;
    for (int round = 0; round < 60 && step > 1e-8; ++round) {
        const Vec3 x = perpendicular(direction), y = cross(direction, x);
        const double before = best;
        Vec3 next = direction;
        for (int i = 0; i < 8; ++i) {
            const double a = i * 0.7854 + step;
            const Vec3 d = normalize(direction + step * (std::cos(a) * x + std::sin(a) * y));
            const double t = shape.first(from, d);
            if (!(t < best)) continue;
            best = t;
            next = d;
        }
        direction = next;
        if (!(best < before - 1e-12 * size)) step *= 0.3;
    }
    return best;
}

/// Whether some ray from aside crosses the surface at the point; at corners most do not.
bool is_there(const Placed& shape, const Vec3& point, Random& random, double size) {
    const double away = 1e-3 * size;
    for (int i = 0; i < 10000; ++i) {
        const Vec3 out = random.unit_vector();
        const Vec3 aim = point + random.log_uniform(1e-9, 1e-5) * size * random.unit_vector();
        const double t = shape.first(aim + away * out, -out);
        if (std::abs(t - away) < 1e-4 * size) return true;
    }
    return false;
}

/// True if rays next to the point, from both sides, have one normal; expects that of the found
/// point.
bool check_normal(const Placed& shape, const PointOnSurface& found, Random& random, double size) {
    const double away = 1e-4 * size;
    Vec3 normal;
    for (int i = 0; i < 12; ++i) {
        const Vec3 out = i % 2 == 0 ? found.normal : -found.normal;
        const Vec3 aim = found.point + 1e-6 * size * random.unit_vector();
        const Vec3 n = shape.normal_at(aim + away * out, -out, away, 0.1 * away);
        if (n == Vec3{} || (i > 0 && length(n - normal) > 1e-2)) return false;
        normal = n;
    }
    const double cosine = dot(normal, found.normal);
    EXPECT_GT(shape.closed() ? cosine : std::abs(cosine), 0.999);
    return true;
}

void check_beside_rays(const Placed& shape, const Vec3& from, Random& random, double size) {
    const PointOnSurface found = shape.nearest(from);
    const double distance = std::sqrt(found.squared);
    if (!std::isfinite(distance)) {
        // A quadric without real points.
        for (int i = 0; i < 2000; ++i) {
            ASSERT_EQ(shape.first(from, random.unit_vector()), kInfinity);
        }
        return;
    }
    EXPECT_NEAR(length(found.point - from), distance, 1e-12 * size);
    EXPECT_NEAR(length(found.normal), 1.0, 1e-14);
    EXPECT_TRUE(is_there(shape, found.point, random, size));
    check_normal(shape, found, random, size);
    // No other point is nearer.
    const Box3 box = shape.box();
    std::vector<std::pair<double, Vec3>> starts;
    for (int i = 0; i < 200; ++i) {
        Vec3 d = random.unit_vector();
        if (i % 2 == 0) {
            const Vec3 u{random.uniform(), random.uniform(), random.uniform()};
            d = unit_or(box.lo + u * box.size() - from, d);
        }
        starts.emplace_back(shape.first(from, d), d);
    }
    std::sort(starts.begin(), starts.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    double least = kInfinity;
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(starts[i].first)) break;
        least = std::min(least, refined(shape, from, starts[i].second, size));
    }
    EXPECT_GT(least, distance - 1e-9 * size) << "something is nearer";
}

Affine random_place(Random& random, int kind) {
    if (kind == 0) return {};
    const Affine turned = Affine::translate(random.in_cube(5)) *
                          Affine::rotate(random.unit_vector(), random.uniform(0, 6));
    if (kind == 1) {
        const double s = random.log_uniform(0.5, 2);
        return turned * Affine::scale({s, s, s});
    }
    return turned * Affine::scale({random.log_uniform(0.4, 2), random.log_uniform(0.4, 2),
                                   random.sign() * random.log_uniform(0.4, 2)});
}

struct Known {
    int shapes = 0, refused = 0;
};

template <class S>
Known check_type(std::uint64_t seed, int rounds) {
    Known known;
    Random random(seed);
    for (int i = 0; i < rounds; ++i) {
        const S shape = random_shape<S>({random, i % 3 == 2});
        const Affine place = random_place(random, i % 3);
        ++known.shapes;
        if (const std::string why = nearest_refusal(shape, place); !why.empty()) {
            ++known.refused;
            continue;
        }
        const Placed placed(shape, place);
        const Box3 box = placed.box();
        const double size = 1.0 + length(box.size()) + length(box.center());
        for (int k = 0; k < 4; ++k) {
            const Vec3 u{random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5),
                         random.uniform(-0.5, 1.5)};
            // Also its middle, from where many points are as near.
            const Vec3 from = k == 3 ? box.center() : box.lo + u * box.size();
            SCOPED_TRACE(std::string(S::kName) + " " + std::to_string(i) + " " + std::to_string(k));
            check_beside_rays(placed, from, random, size);
            if (::testing::Test::HasFailure()) return known;
        }
    }
    return known;
}

template <class S>
class NearestOf : public ::testing::Test {};
using Exact = ::testing::Types<Sphere, Plane, Disc, Rectangle, BoxShape, Cylinder, Cone, Polygon,
                               HalfSpace, Polyhedron, Ellipsoid, EllipticCylinder, EllipticCone,
                               Paraboloid, Hyperboloid, TwoSheetHyperboloid, Quadric>;
TYPED_TEST_SUITE(NearestOf, Exact);

TYPED_TEST(NearestOf, NoFirstCrossingIsNearer) {
    EXPECT_EQ(check_type<TypeParam>(1, 60).refused, 0);
}

/// A point from far away is at the end of a normal, and no crossing near the shape is nearer.
template <class S>
void check_from_far(std::uint64_t seed, int rounds) {
    Random random(seed);
    for (int i = 0; i < rounds; ++i) {
        const S shape = random_shape<S>({random, i % 3 == 2});
        const Affine place = random_place(random, i % 3);
        const Placed placed(shape, place);
        const Box3 box = placed.box();
        const double size = 1.0 + length(box.size()) + length(box.center());
        std::vector<Vec3> crossings;
        for (int k = 0; k < 200; ++k) {
            const Vec3 at = box.lo + Vec3{random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5),
                                          random.uniform(-0.5, 1.5)} *
                                         box.size();
            const Vec3 d = random.unit_vector();
            const double t = placed.first(at, d);
            if (std::isfinite(t)) crossings.push_back(at + t * d);
        }
        for (double far = 10; far < 2e8; far *= 10) {
            const Vec3 from = box.center() + far * size * random.unit_vector();
            SCOPED_TRACE(std::string(S::kName) + " " + std::to_string(i) + " " +
                         std::to_string(far));
            const PointOnSurface found = placed.nearest(from);
            const double distance = std::sqrt(found.squared);
            if (crossings.empty()) break;
            ASSERT_TRUE(std::isfinite(distance));
            const double tolerance =
                1e-12 * (size + length(found.point)) + 1e-15 * (length(from) + distance);
            EXPECT_NEAR(length(found.point - from), distance, tolerance);
            EXPECT_NEAR(length(found.normal), 1.0, 1e-14);
            for (const Vec3& x : crossings) ASSERT_GT(length(x - from), distance - tolerance);
            EXPECT_LT(std::sqrt(placed.nearest(found.point).squared),
                      1e-12 * (size + length(found.point)));
            // It is also the nearest point from a place on the connecting segment.
            const Vec3 out = (from - found.point) / distance;
            const double by = std::min(size, 0.5 * distance);
            EXPECT_NEAR(std::sqrt(placed.nearest(found.point + by * out).squared), by,
                        1e-12 * (size + length(found.point)));
            if (::testing::Test::HasFailure()) return;
        }
    }
}

TYPED_TEST(NearestOf, PointsFarAwayAreAsExact) {
    check_from_far<TypeParam>(5, 60);
}

TEST(Nearest, ATorusIsKnownWhereAnglesAreKept) {
    const Known torus = check_type<Torus>(2, 30);
    EXPECT_EQ(torus.refused, 10);
    const Known tgc = check_type<Tgc>(3, 30);
    EXPECT_GT(tgc.refused, 0);
    EXPECT_LT(tgc.refused, 30);
}

void check_at_random_places(const auto& shape, std::uint64_t seed) {
    Random random(seed);
    for (int i = 0; i < 12; ++i) {
        const Affine place = random_place(random, i % 3);
        const Placed placed(shape, place);
        const Box3 box = placed.box();
        for (int k = 0; k < 6; ++k) {
            const Vec3 u{random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5),
                         random.uniform(-0.5, 1.5)};
            SCOPED_TRACE(std::to_string(i) + " " + std::to_string(k));
            check_beside_rays(placed, box.lo + u * box.size(), random, 1 + length(box.size()));
            if (::testing::Test::HasFailure()) return;
        }
    }
}

/// Loops of lines.
Profile outline(const std::vector<std::vector<Vec2>>& loops, bool closed) {
    Profile profile;
    for (const std::vector<Vec2>& loop : loops) {
        for (std::size_t i = 0; i + (closed ? 0 : 1) < loop.size(); ++i) {
            profile.curves.push_back(line_curve(loop[i], loop[(i + 1) % loop.size()]));
        }
        profile.loop_ends.push_back(static_cast<std::uint32_t>(profile.curves.size()));
    }
    return profile;
}

TEST(Nearest, SweptOutlinesOfStraightLinesAreKnown) {
    const std::vector<Vec2> around{{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}};
    const std::vector<Vec2> hole{{1, 0.25}, {1.5, 0.25}, {1.5, 0.75}, {1, 0.75}};
    for (const double scale : {1.0, 0.5, 0.0}) {
        Prism prism;
        prism.profile = outline({around, hole}, true);
        prism.h1 = 2;
        prism.top_scale = scale;
        prism.prepare();
        ASSERT_EQ(nearest_refusal(prism, Affine::scale({1, 2, 3})), "");
        check_at_random_places(prism, 7);
        // Outside, in the hole, and within the body the normals lead outward.
        const ExactSurface surface(prism, {});
        EXPECT_LT(surface.nearest({0.5, -0.125, 0.125}).normal.y, -0.8);
        EXPECT_GT(surface.nearest({1.03125, 0.5, 0.0625}).normal.x, 0.8);
    }
    Lathe vase;
    vase.profile = outline({{{0, 0}, {2, 0}, {1, 2}, {1, 3}, {2, 4}, {0, 4}}}, false);
    vase.prepare();
    ASSERT_EQ(nearest_refusal(vase, Affine::scale({1, 2, 3})), "");
    check_at_random_places(vase, 8);
    vase.profile.curves[1] = cubic_curve({2, 0}, {2, 1}, {1, 1}, {1, 2});
    EXPECT_NE(nearest_refusal(vase, {}), "");
}

TEST(Nearest, WhatLoopsShareIsNoSurface) {
    // The hole's upper side lies on that of the square.
    const std::vector<Vec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const std::vector<Vec2> notch{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 1}, {-0.5, 1}};
    const double far = std::hypot(0.5, 0.25);
    Prism prism;
    prism.profile = outline({square, notch}, true);
    EXPECT_NEAR(std::sqrt(nearest_on(prism, {0, 1.25, 0.5}).squared), far, 1e-12);
    Polygon polygon;
    for (const auto& loop : {square, notch}) {
        for (const Vec2& p : loop) polygon.vertices.push_back({p.x, 2.0, p.y});
    }
    polygon.loop_ends = {4, 8};
    EXPECT_NEAR(std::sqrt(nearest_on(polygon, {0, 2, 1.25}).squared), far, 1e-12);
    Lathe lathe;
    lathe.profile = outline(
        {{{0, -1}, {2, -1}, {2, 1}, {0, 1}}, {{0, -1}, {0.5, -1}, {0.5, 1}, {0, 1}}}, false);
    EXPECT_NEAR(std::sqrt(nearest_on(lathe, {0, 0, 1.25}).squared), far, 1e-12);
}

TEST(Nearest, NormalsOfLathesLeadOutOfTheMaterial) {
    const std::vector<std::vector<Vec2>> profiles{
        {{1, 0}, {2, 0}, {2, 1}, {1, 1}},                                  // a pipe
        {{0, 0}, {2, 0}, {1, 2}, {0, 2}},                                  // with the axis
        {{0, 0}, {2, 0}, {2, 3}, {1.5, 3}, {1, 1}, {0, 0.5}},              // a cup
        {{1, 1}, {2, 1}, {2, 0}, {1, 0}},                                  // the other way round
        {{0.5, 0}, {3, 1}, {3, 4}, {2.5, 4}, {2.5, 2}, {1, 1.5}, {1, 5}},  // an undercut
    };
    Random random(4);
    for (const std::vector<Vec2>& profile : profiles) {
        for (const bool open : {false, true}) {
            // An axis may be left out of the profile.
            if (open && (profile.front().x > 0 || profile.back().x > 0)) continue;
            Lathe lathe;
            lathe.profile = outline({profile}, !open);
            lathe.prepare();
            ASSERT_TRUE(lathe.closed());
            for (int kind = 0; kind < 3; ++kind) {
                const Affine place = random_place(random, kind);
                const Placed placed(lathe, place);
                const Box3 box = placed.box();
                int seen = 0;
                for (int i = 0; i < 100; ++i) {
                    const Vec3 u{random.uniform(-0.2, 1.2), random.uniform(-0.2, 1.2),
                                 random.uniform(-0.2, 1.2)};
                    const PointOnSurface found = placed.nearest(box.lo + u * box.size());
                    seen += check_normal(placed, found, random, length(box.size())) ? 1 : 0;
                }
                EXPECT_GT(seen, 20);  // the others are edges
                if (::testing::Test::HasFailure()) return;
            }
        }
    }
    Lathe pipe;
    pipe.profile = outline({profiles[0]}, true);
    EXPECT_EQ(nearest_on(pipe, {0.25, 0, 0.5}).normal, (Vec3{-1, 0, 0}));
    EXPECT_EQ(nearest_on(pipe, {1.5, 0, 0.25}).normal, (Vec3{0, 0, -1}));
}

TEST(Nearest, ShapesWithoutNearestPointsSayWhy) {
    const Affine stretched = Affine::scale({1, 1, 2});
    EXPECT_EQ(nearest_refusal(Torus{}, {}), "");
    EXPECT_NE(nearest_refusal(Torus{}, stretched), "");
    EXPECT_EQ(nearest_refusal(Sphere{}, stretched), "");
    // A placement in which the axes of the function would lose all digits.
    const Affine turned = Affine::rotate(normalize(Vec3{1, 2, 3}), 1);
    const Affine aslant = Affine::scale({1, 1, 1e6}) * turned;
    Cone round;
    round.prepare();
    EllipticCone cone;
    cone.prepare();
    for (const AnyShape& shape : {AnyShape(round), AnyShape(cone)}) {
        EXPECT_NE(nearest_refusal(shape, aslant), "");
        EXPECT_EQ(nearest_refusal(shape, Affine::scale({1, 1, 1e3}) * turned), "");
        EXPECT_EQ(nearest_refusal(shape, turned * Affine::scale({1, 1, 1e6})), "");
    }
    EXPECT_EQ(nearest_refusal(Sphere{}, aslant), "");
    EXPECT_EQ(nearest_refusal(Cylinder{}, aslant), "");
    for (const AnyShape& shape : {AnyShape(Algebraic{}), AnyShape(Superellipsoid{}),
                                  AnyShape(Blob{}), AnyShape(BezierPatch{})}) {
        EXPECT_NE(nearest_refusal(shape, {}), "");
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
