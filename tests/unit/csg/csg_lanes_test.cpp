// Eight rays in lanes have the results of single rays in CSG solids of a few leaves, bit for bit.

#include "alhazen/csg/csg_lanes.h"

#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include "alhazen/simd/targets.h"
#include "csg_random_trees.h"
#include "support/any_ray.h"
#include "support/random_shapes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::any_ray;
using testing::Random;
using testing::RandomSolids;
using testing::same_bits;
using testing::SceneMaker;
using testing::solid_of;

constexpr double kInf = std::numeric_limits<double>::infinity();

// ---- one leaf: entry and exit of a line

/// Returns the number of rays that the kernel resolved.
template <class S>
int check_spans(const S& shape, CsgLanesSolid::Kind kind, const void* kernels_shape,
                Random& random) {
    CsgLanesSolid solid;
    solid.leaf_count = 1;
    solid.leaves[0] = {PrimitiveId{0}, kind, kernels_shape, true, 1};
    RayLanes rays;
    for (std::size_t i = 0; i < kRayLanes; ++i) rays.set(i, any_ray(shape.box(), random));
    LaneHits found;
    CsgLanesReport report;
    const std::uint32_t hit_lanes =
        csg_lanes_kernel().first(solid, rays, kAllRayLanes, found, report);
    EXPECT_EQ(hit_lanes & report.unsure, 0u);
    int sure = 0;
    for (std::size_t i = 0; i < kRayLanes; ++i) {
        if ((report.unsure >> i & 1) != 0) continue;
        ++sure;
        const Ray ray = rays.ray(i);
        Ray line = ray;
        line.t_min = -kInf;
        line.t_max = kInf;
        ShapeHit hits[2];
        const int count = shape.intersect(line, hits);
        const ShapeHit* first =
            std::find_if(hits, hits + count, [&](const ShapeHit& h) { return ray.covers(h.t); });
        const bool hit = first != hits + count;
        EXPECT_EQ(hit, (hit_lanes >> i & 1) != 0) << S::kName;
        if (!hit || (hit_lanes >> i & 1) == 0) continue;
        EXPECT_TRUE(same_bits(*first, found.hit(i)))
            << S::kName << " t " << first->t << " became " << found.t[i];
    }
    return sure;
}

template <class S, class KernelsShape>
void check_spans_of(CsgLanesSolid::Kind kind, KernelsShape&& kernels_shape) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(5);
        int sure = 0;
        for (int i = 0; i < 300 && !::testing::Test::HasFailure(); ++i) {
            SCOPED_TRACE(target + ", shape " + std::to_string(i));
            S shape = testing::random_shape<S>({random, i % 2 == 1});
            if (!shape.closed()) continue;
            for (int block = 0; block < 20; ++block) {
                sure += check_spans(shape, kind, kernels_shape(shape), random);
            }
        }
        // Without fused operations all cylinders and cones are left to the scalar code.
        const bool known = kind != CsgLanesSolid::Kind::Frustum || csg_lanes_kernel().knows_frusta;
        EXPECT_EQ(sure > 15000, known) << target << " " << sure;
        EXPECT_EQ(sure > 0, known) << target;
    }
}

TEST(CsgLanes, LinesEnterAndLeaveSpheresWhereEachDoesAlone) {
    check_spans_of<Sphere>(CsgLanesSolid::Kind::Sphere, [](const Sphere& s) { return &s; });
}
TEST(CsgLanes, LinesEnterAndLeaveBoxesWhereEachDoesAlone) {
    check_spans_of<BoxShape>(CsgLanesSolid::Kind::Box, [](const BoxShape& s) { return &s; });
}
TEST(CsgLanes, LinesEnterAndLeaveCylindersWhereEachDoesAlone) {
    check_spans_of<Cylinder>(CsgLanesSolid::Kind::Frustum,
                             [](const Cylinder& s) { return &s.frustum; });
}
TEST(CsgLanes, LinesEnterAndLeaveConesWhereEachDoesAlone) {
    check_spans_of<Cone>(CsgLanesSolid::Kind::Frustum, [](const Cone& s) { return &s.frustum; });
}

// ---- solids

/// Returns the number of `wanted` rays that hit.
int compare(const CsgAggregate& solid, const RayLanes& rays, std::uint32_t wanted,
            const std::string& at) {
    LaneHits hits;
    const std::uint32_t hit = solid.lane_solid()->closest_of_lanes(rays, wanted, hits, nullptr);
    EXPECT_EQ(hit & ~wanted, 0u) << at;
    for_each_lane(wanted, [&](std::size_t i) {
        Hit alone;
        const bool found = solid.closest(rays.ray(i), alone, nullptr);
        EXPECT_EQ(found, (hit >> i & 1) != 0) << at << " ray " << i;
        if (!found || (hit >> i & 1) == 0) return;
        EXPECT_TRUE(same_bits(alone, hits.hit(i)) && alone.primitive == hits.id(i))
            << at << " ray " << i << " t " << alone.t << " became " << hits.t[i];
    });
    return std::popcount(hit);
}

TEST(CsgLanes, RaysFindInASmallSolidWhatEachFindsAlone) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        int small = 0, hit_count = 0;
        for (std::uint64_t seed = 1; seed <= 300 && !::testing::Test::HasFailure(); ++seed) {
            RandomStream random(seed);
            SceneMaker maker;
            maker.material({});
            RandomSolids solids(maker, random, seed % 2 == 1);
            maker.add(solids.tree(1 + static_cast<int>(seed % 6)));
            const Scene scene = testing::compiled(maker, "event_heap");
            const CsgAggregate* solid = solid_of(scene);
            if (solid == nullptr || solid->lane_solid() == nullptr) continue;
            ++small;
            for (int block = 0; block < 120; ++block) {
                RayLanes rays;
                const Ray first = solids.ray();
                for (std::size_t i = 0; i < kRayLanes; ++i) {
                    Ray ray = block % 2 == 0 ? first : solids.ray();
                    if (block % 4 == 0) {
                        ray.direction += 0.02 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1),
                                                     random.uniform(-1, 1)};
                    }
                    if (block % 3 == 0) ray.t_min = random.uniform(-2, 2);
                    if (block % 5 == 0) ray.t_max = ray.t_min + random.uniform(0, 3);
                    rays.set(i, ray);
                }
                const std::uint32_t wanted = block % 7 == 0 ? 0x5Bu : kAllRayLanes;
                hit_count += compare(
                    *solid, rays, wanted,
                    target + " seed " + std::to_string(seed) + " block " + std::to_string(block));
            }
        }
        // Without frusta only spheres and boxes.
        const bool most = csg_lanes_kernel().knows_frusta;
        EXPECT_GT(small, most ? 40 : 4) << target;
        EXPECT_GT(hit_count, most ? 2000 : 200) << target;
    }
}

/// A sphere around the origin minus other shapes.
std::unique_ptr<CsgAggregate> sphere_without(std::size_t others, auto&& add_others) {
    PrimitiveTable table;
    const auto add = [&](auto shape) {
        auto& column = std::get<ShapeColumn<decltype(shape)>>(table.columns);
        column.shapes.push_back(shape);
        column.placements.push_back(kNoPlacement);
        column.materials.push_back(MaterialId{0});
    };
    add(Sphere{{0, 0, 0}, 1});
    add_others(add);
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    CsgExpression expression;
    expression.nodes = {{Combine::Difference, {}}};
    for (std::uint32_t i = 0; i <= others; ++i) {
        expression.leaves.push_back(PrimitiveId{i});
        expression.nodes[0].operands.push_back(CsgOperand::leaf(i));
    }
    return std::make_unique<CsgAggregate>(std::move(table), std::move(expression), "event_heap");
}

// Only the entry into the sphere matters unless a surface of the other shapes is near. All lanes
// hold the same ray, because lanes are resolved together or not at all.
TEST(CsgLanes, RaysThatEnterNearTheRimOfAHoleFindWhatEachFindsAlone) {
    for (const std::string& target : simd_targets()) {
        // Solids choose their kernels when they are built.
        const SimdTargetOverride forced(target);
        std::vector<std::unique_ptr<CsgAggregate>> solids;
        solids.push_back(sphere_without(1, [](auto&& add) {
            add(Cylinder{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = 0.6});
        }));
        // The sphere touches one box from inside and passes through a corner of another.
        solids.push_back(sphere_without(2, [](auto&& add) {
            add(BoxShape{{-2, -2, 1}, {2, 2, 2}});
            add(BoxShape{{0.6, 0, 0.8}, {2, 2, 2}});
        }));
        solids.push_back(sphere_without(1, [](auto&& add) { add(Sphere{{0, 0, 1.6}, 1}); }));
        Random random(11);
        const auto number = [&](double size) { return random.uniform(-size, size); };
        int hit_count = 0, asked = 0;
        for (int block = 0; block < 16000 && !::testing::Test::HasFailure(); ++block) {
            const double off = std::pow(10.0, -0.001 * block);
            const double turn = number(4);
            const Vec3 places[] = {
                {0, 0, 1}, {0.6, 0, 0.8}, {0.6 * std::cos(turn), 0.6 * std::sin(turn), 0.8}};
            const Vec3 place = places[block % 3] + Vec3{number(off), number(off), number(off)};
            const Vec3 from{number(2), number(2), 3};
            Ray ray{from, place - from, block % 5 == 0 ? 1.0 + number(off) : 0.0, kInf};
            if (block % 7 == 0) ray.t_max = std::max(ray.t_min, 1.0 + number(off));
            RayLanes rays;
            for (std::size_t i = 0; i < kRayLanes; ++i) rays.set(i, ray);
            for (std::size_t i = 0; i < solids.size(); ++i) {
                if (solids[i]->lane_solid() == nullptr) continue;
                ++asked;
                hit_count += compare(
                    *solids[i], rays, kAllRayLanes,
                    target + " block " + std::to_string(block) + " solid " + std::to_string(i));
            }
        }
        EXPECT_GT(hit_count, 2 * asked) << target;
        EXPECT_GT(asked, 30000) << target;
    }
}

// The larger a leaf, the larger the rounding of its crossings: here more than the distance between
// crossings.
TEST(CsgLanes, RaysFindBesideHugeLeavesWhatEachFindsAlone) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        for (const double radius : {1e3, 1e7, 1e8}) {
            const auto solid = sphere_without(1, [&](auto&& add) {
                add(Sphere{{0, 0, 0.5 + radius}, radius});
            });
            // Radius of the circle in which the spheres intersect.
            const double rim = (1.25 + radius) / (1 + 2 * radius);
            Random random(12);
            for (int i = 0; i < 20000 && !::testing::Test::HasFailure(); ++i) {
                const double off = std::pow(10.0, random.uniform(-13, -5));
                const double z = rim + random.uniform(-off, off);
                const double turn = random.uniform(0, 7), across = std::sqrt(1 - z * z);
                const Vec3 place{across * std::cos(turn), across * std::sin(turn), z};
                const Vec3 from = 3 * place + Vec3{random.uniform(-2, 2), random.uniform(-2, 2), 0};
                RayLanes rays;
                for (std::size_t k = 0; k < kRayLanes; ++k) {
                    rays.set(k, {from, place - from, 0, kInf});
                }
                compare(*solid, rays, kAllRayLanes, target + " ray " + std::to_string(i));
            }
        }
    }
}

TEST(CsgLanes, LeavesThatARayDoesNotSeeAreEmptyForIt) {
    PrimitiveTable table;
    const auto add = [&](auto& column, auto shape, RayMask visible_to) {
        column.shapes.push_back(shape);
        column.placements.push_back(kNoPlacement);
        column.materials.push_back(MaterialId{0});
        column.set_last_visible_to(visible_to);
    };
    const Cylinder hole{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = 0.4};
    add(std::get<ShapeColumn<Sphere>>(table.columns), Sphere{{0, 0, 0}, 1}, kAllRays);
    add(std::get<ShapeColumn<Cylinder>>(table.columns), hole, mask_of(RayKind::Shadow));
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    CsgExpression expression;
    expression.leaves = {PrimitiveId{0}, PrimitiveId{1}};
    expression.nodes = {{Combine::Difference, {CsgOperand::leaf(0), CsgOperand::leaf(1)}}};
    const CsgAggregate solid(std::move(table), std::move(expression), "event_heap");
    if (solid.lane_solid() == nullptr) GTEST_SKIP() << "no lanes for cylinders on this machine";
    RayLanes rays;
    for (std::size_t i = 0; i < kRayLanes; ++i) rays.set(i, {{0, 0, 5}, {0, 0, -1}, 0, kInf});
    LaneHits hits;
    EXPECT_EQ(
        solid.lane_solid()->closest_of_lanes(rays, 1, hits, {nullptr, mask_of(RayKind::Shadow)}),
        0u);
    EXPECT_EQ(solid.lane_solid()->closest_of_lanes(rays, 1, hits, {nullptr, mask_of(RayKind::Eye)}),
              1u);
    EXPECT_EQ(hits.t[0], 4.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
