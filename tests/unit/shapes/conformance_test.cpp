// Requirements of every shape in the list. A new shape is tested by its line in the list.

#include <gtest/gtest.h>

#include <functional>

#include "alhazen/geometry/bounds_source.h"
#include "support/any_ray.h"
#include "support/random_shapes.h"
#include "support/thorough.h"
#include "tested_shape.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::cases;
using testing::line;
using testing::Random;
using testing::random_shape;
using testing::ShapeSource;
using testing::TestedShape;
using testing::to_text;

constexpr double kUlp = 0x1p-52;
/// A type of shape and the makers of random ones.
struct ShapeType {
    const char* name;
    int max_hits;
    bool always_closed;
    int rays_per_shape;
    TestedShape (*make)(const ShapeSource& from);         ///< prepared
    TestedShape (*make_fields)(const ShapeSource& from);  ///< fields only, as read from a file
};

/// Rays for a shape in tests of many shapes; a surface of many patches takes as long to prepare as
/// a hundred rays to trace.
template <class S>
constexpr int kRaysPerShape =
    std::is_same_v<S, PatchMesh> || std::is_same_v<S, NurbsSurface> ? 5 : 1;

template <class S>
ShapeType shape_type() {
    return {
        S::kName,
        S::kMaxHits,
        S::kClosed,
        kRaysPerShape<S>,
        [](const ShapeSource& from) { return TestedShape(random_shape<S>(from)); },
        [](const ShapeSource& from) { return TestedShape(testing::RandomShape<S>::make(from)); }};
}

template <class... S>
std::vector<ShapeType> shape_types(const ShapeTypes<S...>*) {
    return {shape_type<S>()...};
}

Vec3 point_near(const TestedShape& shape, Random& random) {
    const Box3 box = shape.box();
    Vec3 p = random.in_cube(30);
    for (int k = 0; k < 3; ++k) {
        if (!std::isfinite(box.lo[k]) || !std::isfinite(box.hi[k])) continue;
        p[k] = random.uniform(box.lo[k], box.hi[k]);
    }
    return p;
}

/// Aimed at the shape's box, from inside it, from close by or from far away.
Ray random_ray(const TestedShape& shape, Random& random) {
    const double far[] = {0.0, 1.0, 10.0, 1e3, 1e6};
    const Vec3 target = point_near(shape, random);
    const Vec3 direction = random.log_uniform(0.01, 100) * random.unit_vector();
    const Vec3 origin = target - far[random.below(5)] * direction;
    return line(origin, direction);
}

Ray lattice_ray(Random& random) {
    return line(random.on_lattice(5, 0.25), random.lattice_direction());
}

/// Replaces `hits` by the crossings and returns their number.
int count_hits(const TestedShape& shape, const Ray& ray, ShapeHits& hits) {
    hits.clear();
    shape.intersect(ray, hits);
    return static_cast<int>(hits.size());
}

/// Returns whether the number of crossings of a solid agrees with the sides on which its line
/// begins and ends.
bool parity_is_right(const TestedShape& shape, const Ray& line, int count) {
    Ray back = line;
    back.direction = -back.direction;
    const bool turned = shape.begins_inside(line) != shape.begins_inside(back);
    return (count % 2 != 0) == turned;
}

/// Every day an eighth of the shapes, and of the crossings that they must have.
const int kShapes = cases(50, 400);

/// Calls check(shape, ray, hits, count) for random shapes and rays and for those on a lattice.
using Check = std::function<void(const TestedShape&, Ray, const ShapeHit*, int)>;
void for_random_rays(const ShapeType& type, std::uint64_t seed, const Check& check) {
    Random random(seed);
    for (int i = 0; i < kShapes; ++i) {
        const bool lattice = i % 2 == 1;
        const TestedShape shape = type.make(ShapeSource{random, lattice});
        for (int k = 0; k < 200; ++k) {
            const Ray ray = lattice && k % 8 != 0 ? lattice_ray(random) : random_ray(shape, random);
            ShapeHits hits;
            const int count = count_hits(shape, ray, hits);
            check(shape, ray, hits.data(), count);
            if (!::testing::Test::HasFailure()) continue;
            FAIL() << "seed " << seed << ", shape " << i << ", ray " << k << ": " << to_text(ray);
        }
    }
}

class ShapeConformance : public ::testing::TestWithParam<ShapeType> {};
INSTANTIATE_TEST_SUITE_P(, ShapeConformance,
                         ::testing::ValuesIn(shape_types(static_cast<AnalyticShapes*>(nullptr))),
                         [](const auto& type) { return std::string(type.param.name); });

/// Rounding of a point at t, as a length per component.
Vec3 point_slack(const Ray& ray, double t) {
    return 64 * kUlp * (abs(ray.origin) + std::abs(t) * abs(ray.direction));
}

bool near(const Vec3& a, const Vec3& b, const Vec3& slack) {
    const Vec3 d = abs(a - b);
    return d.x <= slack.x && d.y <= slack.y && d.z <= slack.z;
}

Box3 grown(const Box3& box, const Vec3& by) {
    return {box.lo - by, box.hi + by};
}

TEST_P(ShapeConformance, RandomShapesAreValid) {
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const auto shape = GetParam().make_fields({random, i % 2 == 1});
        Diagnostics diagnostics;
        shape.validate(diagnostics);
        ASSERT_EQ(diagnostics.error_count(), 0u) << diagnostics.all().front().message;
    }
}

TEST_P(ShapeConformance, MostAimedRaysHit) {
    // Guards against a shape that is never hit, which would pass the tests below.
    Random random(2);
    int hit = 0;
    auto shape = GetParam().make({random});
    for (int i = 0; i < 2000; ++i) {
        if (i > 0 && i % GetParam().rays_per_shape == 0) shape = GetParam().make({random});
        ShapeHits hits;
        hit += count_hits(shape, random_ray(shape, random), hits) > 0;
    }
    // A triangle fills half of the box at most that a quadrilateral fills.
    EXPECT_GT(hit, std::string_view(GetParam().name) == SteinerPatch::kName ? 200 : 400);
}

TEST_P(ShapeConformance, HitsAscendAndSolidsAreEnteredAndLeftByTurns) {
    int closed_hits = 0;
    for_random_rays(GetParam(), 3,
                    [&](const auto& shape, const Ray& ray, const ShapeHit* hits, int n) {
                        ASSERT_LE(n, GetParam().max_hits);
                        for (int i = 0; i < n; ++i) ASSERT_TRUE(std::isfinite(hits[i].t));
                        for (int i = 1; i < n; ++i) ASSERT_LE(hits[i - 1].t, hits[i].t);
                        if (!shape.closed()) return;
                        ASSERT_TRUE(parity_is_right(shape, ray, n)) << n;
                        closed_hits += n;
                    });
    if (GetParam().always_closed) {
        EXPECT_GT(closed_hits, 25 * kShapes);
    }
}

TEST_P(ShapeConformance, ARangeOfTSelectsFromTheCrossingsOfTheLine) {
    Random limits(4);
    for_random_rays(
        GetParam(), 5, [&](const auto& shape, const Ray& line, const ShapeHit* all, int n) {
            if (n == 0) return;
            Ray ray = line;
            // Limits exactly at a crossing are included.
            const double a = all[limits.below(n)].t;
            const double b = limits.coin() ? all[limits.below(n)].t : a + limits.uniform(-10, 10);
            ray.t_min = std::min(a, b);
            ray.t_max = std::max(a, b);
            ShapeHits some;
            const int count = count_hits(shape, ray, some);
            int expected = 0;
            for (int i = 0; i < n; ++i) {
                if (!ray.covers(all[i].t)) continue;
                ASSERT_LT(expected, count);
                ASSERT_EQ(some[expected].t, all[i].t);
                ASSERT_EQ(some[expected].part, all[i].part);
                ++expected;
            }
            ASSERT_EQ(count, expected);
            // A query for only the first crossing finds the same one.
            ShapeHits first(1);
            shape.intersect(ray, first);
            ASSERT_EQ(first.empty(), some.empty());
            if (some.empty()) return;
            ASSERT_EQ(first.front().t, some.front().t);
            ASSERT_EQ(first.front().part, some.front().part);
        });
}

TEST_P(ShapeConformance, BoxAndExtentsHoldTheCrossings) {
    Random axes(6);
    for_random_rays(
        GetParam(), 7, [&](const auto& shape, const Ray& ray, const ShapeHit* hits, int n) {
            const Vec3 axis = axes.coin() ? axes.unit_vector() : axes.lattice_direction();
            for (int i = 0; i < n; ++i) {
                const Vec3 slack = point_slack(ray, hits[i].t);
                ASSERT_TRUE(grown(shape.box(), slack).contains(ray.at(hits[i].t)));
                const ShapeSurface surface = shape.surface(ray, hits[i]);
                const Vec3 error = surface.error;
                ASSERT_TRUE(grown(shape.box(), error).contains(surface.point));
                const Interval extent = shape.extent(axis);
                const double reach = dot(abs(axis), error + 4 * kUlp * abs(surface.point));
                ASSERT_LE(extent.lo - reach, dot(axis, surface.point));
                ASSERT_GE(extent.hi + reach, dot(axis, surface.point));
            }
        });
}

TEST_P(ShapeConformance, ExtentAlongAnAxisIsTheBoxAndElsewhereWithinIt) {
    Random random(8);
    for (int i = 0; i < 5 * kShapes; ++i) {
        const auto shape = GetParam().make({random, i % 2 == 1});
        const Box3 box = shape.box();
        for (int k = 0; k < 3; ++k) {
            Vec3 axis{};
            axis[k] = 1.0;
            const Interval extent = shape.extent(axis);
            const double a[] = {extent.lo, extent.hi}, b[] = {box.lo[k], box.hi[k]};
            for (int side = 0; side < 2; ++side) {
                if (!std::isfinite(b[side])) {
                    ASSERT_EQ(a[side], b[side]) << i << " " << k;
                    continue;
                }
                ASSERT_NEAR(a[side], b[side], 1e-14 * (2 * std::abs(b[side]) + 60))
                    << i << " " << k;
            }
        }
        const Vec3 axis = random.unit_vector();
        const Interval own = shape.extent(axis), of_box = extent(box, axis);
        ASSERT_GE(own.lo, of_box.lo - 1e-12) << i;
        ASSERT_LE(own.hi, of_box.hi + 1e-12) << i;
        ASSERT_FALSE(own.empty()) << i;
    }
}

TEST_P(ShapeConformance, SurfaceIsAtTheCrossing) {
    for_random_rays(
        GetParam(), 9, [](const auto& shape, const Ray& ray, const ShapeHit* hits, int n) {
            const Box3 box = shape.box();
            for (int i = 0; i < n; ++i) {
                const ShapeSurface surface = shape.surface(ray, hits[i]);
                const Vec3 p = ray.at(hits[i].t);
                double reach = max_component(abs(ray.origin)) + max_component(abs(p));
                if (box.bounded()) reach += max_component(abs(box.lo)) + max_component(abs(box.hi));
                const double slack = 128 * kUlp * reach;
                ASSERT_TRUE(near(surface.point, p, {slack, slack, slack}))
                    << surface.point.x - p.x << " " << surface.point.y - p.y << " "
                    << surface.point.z - p.z << " allowed " << slack;
                ASSERT_NEAR(length(surface.normal), 1.0, 1e-14);
                ASSERT_EQ(surface.shading_normal, surface.normal);
                ASSERT_TRUE(std::isfinite(surface.uv.x) && std::isfinite(surface.uv.y));
                // The bound is usable: not negative, and a few ulps of the magnitudes involved.
                const double magnitudes =
                    box.bounded() ? max_component(abs(box.lo)) + max_component(abs(box.hi))
                                  : 3 * max_component(abs(surface.point)) + 60;
                for (int k = 0; k < 3; ++k) {
                    ASSERT_GE(surface.error[k], 0.0);
                    ASSERT_LE(surface.error[k], 64 * kUlp * magnitudes);
                }
            }
        });
}

TEST_P(ShapeConformance, NormalsOfClosedShapesFaceOutward) {
    for_random_rays(GetParam(), 10,
                    [](const auto& shape, const Ray& ray, const ShapeHit* hits, int n) {
                        if (!shape.closed()) return;
                        const bool inside = shape.begins_inside(ray);
                        for (int i = 0; i < n; ++i) {
                            // Crossings at one distance, up to rounding, come in any order.
                            const double near = 1e-12 * (1.0 + std::abs(hits[i].t));
                            const bool alone = (i == 0 || hits[i].t - hits[i - 1].t > near) &&
                                               (i + 1 == n || hits[i + 1].t - hits[i].t > near);
                            if (!alone) continue;
                            const double cosine =
                                dot(shape.surface(ray, hits[i]).normal, normalize(ray.direction));
                            // Seen from far away, a grazing ray may round to the other side of the
                            // horizon.
                            const double outward = (i % 2 == 0) != inside ? -cosine : cosine;
                            ASSERT_GE(outward, -1e-3);
                        }
                    });
}

TEST_P(ShapeConformance, NormalsArePerpendicularToTheWayToNeighbours) {
    Random random(11);
    int checked = 0;
    auto shape = GetParam().make({random});
    for (int i = 0; i < 50 * kShapes; ++i) {
        if (i % (10 * GetParam().rays_per_shape) == 0) shape = GetParam().make({random});
        Ray ray = random_ray(shape, random);
        const double distance = length(ray.origin - point_near(shape, random));
        if (distance > 1e3) continue;
        ShapeHits hits, beside;
        const int n = count_hits(shape, ray, hits);
        const Vec3 across = perpendicular(normalize(ray.direction));
        const Vec3 step = 1e-6 * across;
        const Ray neighbour = line(ray.origin + step, ray.direction);
        if (n == 0 || count_hits(shape, neighbour, beside) != n) continue;
        for (int k = 0; k < n; ++k) {
            if (hits[k].part != beside[k].part) continue;
            const ShapeSurface a = shape.surface(ray, hits[k]);
            const ShapeSurface b = shape.surface(neighbour, beside[k]);
            if (std::abs(dot(a.normal, normalize(ray.direction))) < 0.2) continue;
            const Vec3 way = b.point - a.point;
            // Curvature turns the normal by the step over the smallest radius; rounding by 1e-13
            // over the step.
            if (length(way) > 1e-5 || length(a.normal - b.normal) > 1e-3) continue;
            ASSERT_LE(std::abs(dot(a.normal, way)), 1e-3 * length(way) + 1e-11)
                << i << ": " << to_text(ray);
            ++checked;
        }
    }
    EXPECT_GT(2 * checked, 5 * kShapes);
}

TEST_P(ShapeConformance, ScalingTheDirectionScalesT) {
    Random scales(12);
    for_random_rays(GetParam(), 13, [&](const auto& shape, Ray ray, const ShapeHit* hits, int n) {
        // A power of two, so that all bits stay the same.
        const double scale = std::ldexp(1.0, scales.below(21) - 10);
        ray.direction = scale * ray.direction;
        ShapeHits scaled;
        ASSERT_EQ(count_hits(shape, ray, scaled), n);
        for (int i = 0; i < n; ++i) {
            ASSERT_EQ(scaled[i].t * scale, hits[i].t);
            ASSERT_EQ(scaled[i].part, hits[i].part);
        }
    });
}

TEST_P(ShapeConformance, ExtremeRaysGiveFiniteHitsOrNone) {
    Random random(14);
    const double extremes[] = {0.0, -0.0, 1e-320, 1e-200, -1e-100, 1.0, -1.0, 1e100, -1e200, 1e308};
    auto shape = GetParam().make({random});
    for (int i = 0; i < 125 * kShapes; ++i) {
        if (i % (10 * GetParam().rays_per_shape) == 0) {
            shape = GetParam().make({random, random.coin()});
        }
        Ray ray = line({}, {});
        for (int k = 0; k < 3; ++k) {
            ray.origin[k] = random.coin() ? extremes[random.below(10)] : random.uniform(-5, 5);
            ray.direction[k] = extremes[random.below(10)];
        }
        if (!is_valid(ray)) continue;
        ShapeHits hits;
        const int n = count_hits(shape, ray, hits);
        if (shape.closed()) {
            ASSERT_TRUE(parity_is_right(shape, ray, n)) << to_text(ray);
        }
        for (int k = 0; k < n; ++k) {
            ASSERT_TRUE(std::isfinite(hits[k].t)) << to_text(ray);
            ASSERT_TRUE(is_finite(shape.surface(ray, hits[k]).normal)) << to_text(ray);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
