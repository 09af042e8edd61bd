#include "alhazen/aggregates/wide_bvh/leaves/flat_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/recent_occluders.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/math/constants.h"
#include "alhazen/simd/targets.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// By the odd-even rule.
bool is_inside(const std::vector<SlabPoint>& corners, const std::vector<std::uint32_t>& ends,
               const SlabPoint& p) {
    bool inside = false;
    std::size_t first = 0;
    for (const std::size_t end : ends) {
        for (std::size_t i = first; i < end; ++i) {
            const SlabPoint &a = corners[i], &b = corners[i + 1 < end ? i + 1 : first];
            if ((a.v > p.v) == (b.v > p.v)) continue;
            inside ^= a.u + (p.v - a.v) / (b.v - a.v) * (b.u - a.u) > p.u;
        }
        first = end;
    }
    return inside;
}

double area_of(const SlantedBounds& bounds) {
    return length(bounds.edge[0]) * length(bounds.edge[1]);
}

/// Opaque shapes of one kind, in this order.
template <class Shape>
PrimitiveTable table_of(std::vector<Shape> shapes) {
    PrimitiveTable table;
    auto& column = std::get<ShapeColumn<Shape>>(table.columns);
    for (Shape& shape : shapes) {
        shape.prepare();
        column.shapes.push_back(std::move(shape));
        column.placements.push_back(kNoPlacement);
        column.materials.push_back(MaterialId{0});
    }
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return table;
}

TEST(FlatShapes, ARectangleFillsItsSlabs) {
    const std::vector<SlabPoint> corners{{-2, -1}, {2, -1}, {2, 1}, {-2, 1}};
    const std::vector<std::uint32_t> ends{4};
    EXPECT_EQ(inset_of(corners, ends, 2, 1), 0.0);
    EXPECT_NEAR(inset_of(corners, ends, 2.5, 1.25), 0.5, 1e-12);
}

/// An edge along the normal leaves nothing but rounding in the plane.
TEST(FlatShapes, BoxesOfPolygonsWithNeedlesAlongTheirNormalsStandOnThem) {
    Random random(5);
    for (int i = 0; i < 300; ++i) {
        const Vec3 x = random.unit_vector(), y = perpendicular(x), n = cross(x, y);
        Polygon p;
        const Vec3 corner = x + y, tip = corner + random.log_uniform(0.01, 2) * n;
        p.vertices = {Vec3{} - x - y, x - y, corner, tip, corner, y - x};
        p.prepare();
        const SlantedBounds box = bounds_of(p);
        EXPECT_NEAR(dot(box.direction[0], box.direction[2]), 0, 1e-9) << i;
        EXPECT_NEAR(length(box.direction[1]), 1, 1e-9) << i;
        const WideBvhAggregate tree(table_of<Polygon>({p}));
        int hits = 0;
        for (int k = 0; k < 20; ++k) {
            Ray ray{3 * random.unit_vector(), {}, 0, kInfinity};
            ray.direction =
                0.9 * (random.uniform(-1, 1) * x + random.uniform(-1, 1) * y) - ray.origin;
            Hit hit;
            hits += tree.closest(ray, hit, nullptr);
            EXPECT_TRUE(tree.occluded(ray, nullptr)) << i << " " << k;
        }
        EXPECT_EQ(hits, 20) << i;
    }
}

TEST(FlatShapes, TheMiddleMayBeOutside) {
    const std::vector<SlabPoint> bent{{-1, -1},     {1, -1},   {1, -0.9},
                                      {-0.9, -0.9}, {-0.9, 1}, {-1, 1}};
    const std::vector<std::uint32_t> one{6};
    EXPECT_EQ(inset_of(bent, one, 1, 1), kInfinity);
    const std::vector<SlabPoint> holed{{-1, -1},     {1, -1},     {1, 1},     {-1, 1},
                                       {-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
    const std::vector<std::uint32_t> two{4, 8};
    EXPECT_EQ(inset_of(holed, two, 1, 1), kInfinity);
}

TEST(FlatShapes, TheRectangleInsideHasNoPointOutsideAndTouchesAnEdge) {
    Random random(311);
    int found = 0, touched = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<SlabPoint> corners;
        const int count = 3 + random.below(40);
        for (int k = 0; k < count; ++k) {
            const double angle = 2 * kPi * (k + 0.4 * random.uniform()) / count;
            const double r = random.uniform(0.3, 1);
            corners.push_back({r * std::cos(angle), 0.6 * r * std::sin(angle)});
        }
        const std::vector<std::uint32_t> ends{static_cast<std::uint32_t>(count)};
        const double inset = inset_of(corners, ends, 1, 0.6);
        if (!(inset < 0.6)) continue;
        ++found;
        const double u = 1 - inset, v = 0.6 - inset;
        for (int k = 0; k < 200; ++k) {
            const SlabPoint p{0.999999 * random.uniform(-u, u), 0.999999 * random.uniform(-v, v)};
            ASSERT_TRUE(is_inside(corners, ends, p)) << i;
        }
        // A little wider, some point of its sides is outside.
        bool outside = false;
        for (int k = 0; k < 4000 && !outside; ++k) {
            const double at = -1 + k / 2000.0, wide = 1.02;
            for (const SlabPoint& p :
                 {SlabPoint{wide * u, at * wide * v}, SlabPoint{-wide * u, at * wide * v},
                  SlabPoint{at * wide * u, wide * v}, SlabPoint{at * wide * u, -wide * v}}) {
                outside = outside || !is_inside(corners, ends, p);
            }
        }
        touched += outside;
    }
    EXPECT_GT(found, 200);
    EXPECT_GT(touched, found * 9 / 10);
}

TEST(FlatShapes, TheDiscInsideHasNoPointOutsideAndTouchesAnEdge) {
    const std::vector<SlabPoint> square{{-2, -1}, {2, -1}, {2, 1}, {-2, 1}};
    EXPECT_EQ(inner_radius_of(square, std::vector<std::uint32_t>{4}), 1.0);
    const std::vector<SlabPoint> holed{{-1, -1},     {1, -1},     {1, 1},     {-1, 1},
                                       {-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
    EXPECT_EQ(inner_radius_of(holed, std::vector<std::uint32_t>{4, 8}), 0.0);
    Random random(313);
    int touched = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<SlabPoint> corners;
        const int count = 3 + random.below(40);
        for (int k = 0; k < count; ++k) {
            const double angle = 2 * kPi * (k + 0.4 * random.uniform()) / count;
            const double r = random.uniform(0.3, 1);
            corners.push_back({r * std::cos(angle), r * std::sin(angle)});
        }
        const std::vector<std::uint32_t> ends{static_cast<std::uint32_t>(count)};
        const double radius = inner_radius_of(corners, ends);
        bool outside = false;
        for (int k = 0; k < 4000; ++k) {
            const double angle = 2 * kPi * k / 4000;
            const SlabPoint p{radius * std::cos(angle), radius * std::sin(angle)};
            ASSERT_TRUE(radius == 0 || is_inside(corners, ends, {0.999999 * p.u, 0.999999 * p.v}))
                << i;
            outside = outside || !is_inside(corners, ends, {1.02 * p.u, 1.02 * p.v});
        }
        touched += outside && radius > 0;
    }
    EXPECT_GT(touched, 200);
}

TEST(FlatShapes, TheBoxAroundATurnedRectangleIsThatRectangle) {
    Random random(312);
    for (int i = 0; i < 50; ++i) {
        const Affine turn = Affine::rotate(random.unit_vector(), random.uniform(0, 6));
        Polygon polygon;
        for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{3, 0, 0}, Vec3{3, 1, 0}, Vec3{0, 1, 0}}) {
            polygon.vertices.push_back(turn.point(p));
        }
        polygon.prepare();
        const SlantedBounds bounds = bounds_of(polygon);
        EXPECT_NEAR(area_of(bounds), 3.0, 1e-9);
        EXPECT_NEAR(length(bounds.edge[2]), 0.0, 1e-9);
        EXPECT_TRUE(bounds.flat);
    }
}

PrimitiveTable two_squares() {
    std::vector<Polygon> squares(2);
    for (const double z : {0.0, 1.0}) {
        // Turned, so that the sides lie along no axis.
        squares[z == 1.0].vertices = {{-1, 0, z}, {0, -1, z}, {1, 0, z}, {0, 1, z}};
    }
    return table_of(std::move(squares));
}

/// A ray that leaves one square and certainly hits the other is occluded without a test of the one
/// that it leaves.
TEST(FlatShapes, ASureHitIsNotTestedInDouble) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const WideBvhAggregate tested(two_squares());
        Ray ray{{0.1, 0.2, 0}, {0.01, 0.02, 1}, 0, kInfinity};
        TraversalStats stats;
        EXPECT_TRUE(tested.occluded(ray, {&stats})) << target;
        EXPECT_EQ(stats.primitive_hits, 1u) << target;
        EXPECT_EQ(stats.primitive_tests, 1u) << target;
        // Beside the squares, in their boxes along the axes.
        TraversalStats missed;
        ray.origin = {0.8, 0.8, -1};
        EXPECT_FALSE(tested.occluded(ray, {&missed}));
        EXPECT_EQ(missed.primitive_tests, 2u) << target;
        EXPECT_EQ(missed.primitive_hits, 0u) << target;
    }
}

/// A body that the ray passes closer than the filter can tell, before one that it meets in the
/// middle: the sure one is taken without a test of the other.
template <class Shape>
void expect_sure_one_first(const Shape& grazed, const Shape& met) {
    const WideBvhAggregate tested(table_of<Shape>({grazed, met}));
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const Ray ray{{-5, 0.25, 0}, {1, 0, 0}, 0, kInfinity};
        TraversalStats stats;
        EXPECT_TRUE(tested.occluded(ray, {&stats})) << target;
        EXPECT_EQ(stats.primitive_hits, 1u) << target;
        EXPECT_EQ(stats.primitive_tests, 1u) << target;
    }
}

/// A wheel with teeth, whose middle is at x, y.
Polygon gear(double x, double y, double z) {
    Polygon polygon;
    for (int i = 0; i < 96; ++i) {
        const double r = i % 4 < 2 ? 1.0 : 0.9, angle = 2 * kPi * i / 96;
        polygon.vertices.push_back({x + r * std::cos(angle), y + r * std::sin(angle), z});
    }
    return polygon;
}

/// The disc inside a gear is larger than the rectangle inside it.
TEST(FlatShapes, ASureGearIsNotTestedInDouble) {
    for (int i = 0; i < 12; ++i) {
        const double x = 0.85 * std::cos(0.5 * i), y = 0.85 * std::sin(0.5 * i);
        // The ray passes a corner of the first closer than the filter can tell.
        const Polygon grazed = gear(x + 1 + 1e-9, y, 0);
        EXPECT_NEAR(grazed.vertices[48].x, x, 1e-8);
        const WideBvhAggregate tested(table_of<Polygon>({grazed, gear(0, 0, 1)}));
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride use(target);
            const Ray ray{{x, y, -1}, {0, 0, 1}, 0, kInfinity};
            TraversalStats stats;
            EXPECT_TRUE(tested.occluded(ray, {&stats})) << target;
            EXPECT_EQ(stats.primitive_hits, 1u) << target;
            EXPECT_EQ(stats.primitive_tests, 1u) << target;
        }
    }
}

TEST(FlatShapes, RaysOfABatchTryTheLastOccludersBeforeTheTree) {
    std::vector<Polygon> gears;
    for (int i = 0; i < 40; ++i) gears.push_back(gear(2.5 * (i % 8), 2.5 * (i / 8), i % 3));
    std::vector<Ray> rays;
    for (int i = 0; i < 64; ++i) {
        rays.push_back({{5 + 0.005 * i, 2.5, -1}, {0, 0, 1}, 0, kInfinity});
    }
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const WideBvhAggregate tested(table_of<Polygon>(gears));
        TraversalStats one, all;
        EXPECT_TRUE(tested.occluded(rays[0], {&one}));
        RecentOccluders recent;
        WideBvhScene scene(tested.primitives(), tested.layout());
        scene.recent = &recent;
        const WideBvhKernelPair kernels = wide_bvh_kernels(8);
        bool occluded[64] = {};
        kernels.counting.occluded_batch(scene, rays, std::span<bool>(occluded), &all);
        for (const bool met : occluded) EXPECT_TRUE(met) << target;
        EXPECT_GT(one.node_visits, 0u);
        EXPECT_EQ(all.node_visits, one.node_visits) << target;
        EXPECT_EQ(all.primitive_hits, 64u) << target;
    }
}

TEST(FlatShapes, LastOccludersThatMissAreSeldomTried) {
    RecentOccluders recent;
    EXPECT_FALSE(recent.worth_trying(1));
    BoxBlock block{};
    block.ids[3] = BlockId(PrimitiveId{7}, true, false);
    block.ids[5] = BlockId(PrimitiveId{8}, true, false);
    recent.add(block, 3);
    EXPECT_EQ(recent.block().ids[0].id(), PrimitiveId{7});
    EXPECT_FALSE(recent.block().ids[1].used());
    for (std::size_t i = 1; i < kBlockWidth; ++i) recent.add(block, 5);
    EXPECT_EQ(recent.block().ids[0].id(), PrimitiveId{7});
    recent.add(block, 5);
    EXPECT_EQ(recent.block().ids[0].id(), PrimitiveId{8});
    int tries = 0;
    for (int i = 0; i < 1000; ++i) {
        if (!recent.worth_trying(1)) continue;
        ++tries;
        recent.tried(1, 0);
    }
    EXPECT_GT(tries, 20);
    EXPECT_LT(tries, 60);
    recent.tried(1, 1);
    EXPECT_TRUE(recent.worth_trying(8));
}

TEST(FlatShapes, AnOccluderInUseStays) {
    RecentOccluders recent;
    BoxBlock block{};
    block.ids[0] = BlockId(PrimitiveId{7}, true, false);
    block.ids[1] = BlockId(PrimitiveId{8}, true, false);
    recent.add(block, 0);
    for (std::size_t i = 1; i < kBlockWidth; ++i) recent.add(block, 1);
    recent.keep(0);
    recent.add(block, 1);
    EXPECT_EQ(recent.block().ids[0].id(), PrimitiveId{7});
    for (std::size_t i = 1; i < kBlockWidth; ++i) recent.add(block, 1);
    EXPECT_EQ(recent.block().ids[0].id(), PrimitiveId{8});
}

/// Rays of which some hit nothing, lie outside the range of float, or are occluded already.
TEST(FlatShapes, ABatchWithLastOccludersFindsWhatSingleRaysDo) {
    Random random(5);
    std::vector<Polygon> gears;
    for (int i = 0; i < 40; ++i) gears.push_back(gear(2.5 * (i % 8), 2.5 * (i / 8), i % 3));
    std::vector<Ray> rays;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 target{random.uniform(-1, 19), random.uniform(-1, 11), random.uniform(-1, 3)};
        const double away = random.below(50) == 0 ? 1e18 : 10;
        Vec3 direction = random.unit_vector();
        rays.push_back({target - away * direction, direction, 0, 2 * away});
        if (random.below(50) == 0) rays.back().direction = {};
    }
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const WideBvhAggregate tested(table_of<Polygon>(gears));
        RecentOccluders recent;
        WideBvhScene scene(tested.primitives(), tested.layout());
        scene.recent = &recent;
        bool occluded[1000] = {};
        for (std::size_t i = 0; i < 1000; i += 17) occluded[i] = true;
        wide_bvh_kernels(8).plain.occluded_batch(scene, rays, std::span<bool>(occluded), nullptr);
        for (std::size_t i = 0; i < 1000; ++i) {
            EXPECT_EQ(occluded[i], i % 17 == 0 || tested.occluded(rays[i], {nullptr}))
                << target << " " << i;
        }
    }
}

TEST(FlatShapes, ASureRoundBodyIsNotTestedInDouble) {
    // Grazed: its silhouette is at y = 0.25 + 1e-9.
    expect_sure_one_first(Sphere{{0, 1.25 + 1e-9, 0}, 1}, Sphere{{0.5, 0.5, 0}, 1});
    const auto rod = [](double x, double y) {
        Cylinder cylinder;
        cylinder.base = {x, y, -3};
        cylinder.top = {x, y, 3};
        cylinder.radius = 1;
        return cylinder;
    };
    expect_sure_one_first(rod(0, 1.25 + 1e-9), rod(0.5, 0.5));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
