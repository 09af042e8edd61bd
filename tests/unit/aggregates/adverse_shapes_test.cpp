// Round bodies and polygons in the blocks of `wide_bvh`, and rays that graze them, pass corners and
// begin on surfaces: every schedule gives the hits of the list.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/math/constants.h"
#include "alhazen/simd/targets.h"
#include "support/random_shapes.h"
#include "unit/aggregates/answers.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// Coordinates of a scene, possibly tiny, huge or far from the origin.
struct World {
    double scale = 1;
    Vec3 at{};
    [[nodiscard]] Vec3 point(const Vec3& p) const { return at + scale * p; }
};

World some_world(Random& random) {
    World world;
    if (random.below(3) == 0) world.scale = random.log_uniform(1e-7, 1e7);
    if (random.below(4) == 0) {
        world.at = world.scale * random.log_uniform(1, 1e6) * random.unit_vector();
    }
    return world;
}

template <class S>
void add(PrimitiveTable& table, S shape, bool opaque) {
    shape.prepare();
    auto& column = std::get<ShapeColumn<S>>(table.columns);
    column.shapes.push_back(shape);
    column.placements.push_back(kNoPlacement);
    column.materials.push_back(MaterialId{opaque ? 0u : 1u});
}

/// Spheres, cylinders, cones and discs, many of them thin, at one place, or end to end.
void add_round_bodies(PrimitiveTable& table, Random& random, const World& world, bool lattice) {
    Vec3 center, along{0, 0, 1};
    double radius = 0.1;
    for (int i = 10 + random.below(100); i > 0; --i) {
        const int same = random.below(8);
        const Vec3 before = center;
        center = lattice ? random.on_lattice(4, 0.25) : random.in_cube(1);
        if (same < 3) center = before;
        if (same == 3) center = before + along;
        if (same != 1 && same != 2) radius = lattice ? 0.25 : random.log_uniform(0.001, 0.3);
        if (same != 2) {
            along = lattice ? 0.5 * random.lattice_direction()
                            : random.log_uniform(0.01, 1.5) * random.unit_vector();
        }
        const Vec3 base = world.point(center), top = world.point(center + along);
        const double size = world.scale * radius;
        switch (random.below(6)) {
            case 0:
            case 1:
                add(table, Sphere{base, size}, random.coin());
                break;
            case 2:
            case 3:
                add(table,
                    Cylinder{.base = base, .top = top, .radius = size, .capped = random.coin()},
                    random.coin());
                break;
            case 4:
                add(table,
                    Cone{.base = base,
                         .top = top,
                         .base_radius = size,
                         .top_radius = random.coin() ? 0.0 : 2 * size,
                         .capped = random.coin()},
                    random.coin());
                break;
            default:
                add(table, Disc{.center = base, .normal = along, .radius = size}, random.coin());
        }
    }
}

/// Squares, gears and stars, some with a hole, some bent out of their plane.
void add_polygons(PrimitiveTable& table, Random& random, const World& world, bool lattice) {
    for (int i = 3 + random.below(12); i > 0; --i) {
        Vec3 middle = random.in_cube(1), x = random.unit_vector(), y = perpendicular(x);
        if (lattice) {
            const int k = random.below(3);
            x = y = {};
            x[k] = y[(k + 1) % 3] = 1;
            middle = random.on_lattice(4, 0.25);
        }
        const int kind = random.below(3);
        const int count = kind == 0 ? 4 : kind == 1 ? 144 : 3 + random.below(60);
        const double size = lattice ? 0.5 : random.log_uniform(0.05, 1);
        const double bend = random.below(3) == 0 ? random.log_uniform(1e-12, 0.3) : 0.0;
        Polygon polygon;
        for (int loop = random.below(4) == 0 ? 2 : 1; loop > 0; --loop) {
            for (int k = 0; k < count; ++k) {
                double r = size * (loop == 2 ? 0.3 : 1.0);
                if (kind == 1 && k % 4 >= 2) r *= 0.9;
                if (kind == 2) r *= random.uniform(0.4, 1);
                const double angle = 2 * kPi * k / count;
                const double off = bend * size * random.uniform(-1, 1);
                polygon.vertices.push_back(world.point(middle + r * std::cos(angle) * x +
                                                       r * std::sin(angle) * y +
                                                       off * cross(x, y)));
            }
            polygon.loop_ends.push_back(static_cast<std::uint32_t>(polygon.vertices.size()));
        }
        add(table, polygon, random.coin());
    }
}

PrimitiveTable some_shapes(Random& random, const World& world, int kind) {
    const bool lattice = random.below(3) == 0;
    PrimitiveTable table;
    if (kind != 1) add_round_bodies(table, random, world, lattice);
    if (kind != 0) add_polygons(table, random, world, lattice);
    table.material_opacity = {Opacity::Opaque, Opacity::Transparent};
    table.finish();
    return table;
}

/// Turns a ray towards the silhouette of a shape, by up to 50 bisections.
void graze(Ray& ray, const PrimitiveTable& table, PrimitiveId id, Random& random) {
    const Box3 box = table.box(static_cast<std::uint32_t>(id));
    const auto meets = [&](const Ray& r) {
        return table.occluded(id, r, RayShear(r.direction), NoStats{}, kAllRays);
    };
    Ray hit = ray;
    for (int i = 0; i < 30; ++i) {
        hit.direction = box.center() + random.in_cube(0.5) * box.size() - ray.origin;
        if (meets(hit)) break;
    }
    Ray miss = hit;
    miss.direction = box.center() + 2 * length(box.size()) * random.unit_vector() - ray.origin;
    for (int i = random.below(50); i > 0; --i) {
        Ray between = hit;
        between.direction = 0.5 * (hit.direction + miss.direction);
        (meets(between) ? hit : miss) = between;
    }
    ray.direction = random.coin() ? hit.direction : miss.direction;
}

/// A ray at something that filters find hard.
Ray some_ray(Random& random, const World& world, const PrimitiveTable& table,
             const Aggregate& list) {
    Ray ray{world.point(random.in_cube(1.5)), {}, 0, kInfinity};
    if (random.below(6) == 0) {
        ray.origin = world.point(random.log_uniform(2, 1e5) * random.unit_vector());
    }
    if (random.below(6) == 0) ray.origin = world.point(random.on_lattice(8, 0.25));
    const PrimitiveId id{static_cast<std::uint32_t>(random.below(static_cast<int>(table.size())))};
    const Box3 box = table.box(static_cast<std::uint32_t>(id));
    ray.direction = box.center() + random.in_cube(0.5) * box.size() - ray.origin;
    const auto& polygons = std::get<ShapeColumn<Polygon>>(table.columns).shapes;
    const int aim = random.below(4);
    if (aim == 0) ray.direction = world.scale * random.lattice_direction();
    if (aim == 1) graze(ray, table, id, random);
    if (aim == 2 && !polygons.empty()) {
        const Polygon& p =
            polygons[static_cast<std::size_t>(random.below(static_cast<int>(polygons.size())))];
        const auto k = static_cast<std::size_t>(random.below(static_cast<int>(p.vertices.size())));
        const Vec3 &a = p.vertices[k], &b = p.vertices[(k + 1) % p.vertices.size()];
        ray.direction = a + (random.coin() ? 0.0 : random.uniform()) * (b - a) - ray.origin;
    }
    Hit hit;
    if (random.below(3) == 0 && list.closest(ray, hit, nullptr)) {
        ray.origin += hit.t * ray.direction;
        if (random.coin()) ray.direction = world.scale * random.unit_vector();
        if (random.coin()) ray.t_min = 1e-9;
    }
    return ray;
}

/// Rays near one, some of which end or begin at a hit.
std::vector<Ray> bundle_around(const Ray& ray, Random& random, const World& world,
                               const Aggregate& list) {
    const double spread = random.below(3) == 0 ? 0.0 : random.log_uniform(1e-17, 0.5);
    const double aside = random.coin() ? spread * world.scale : 0.0;
    std::vector<Ray> rays(40, ray);
    for (Ray& r : rays) {
        r.origin += aside * random.in_cube(1);
        r.direction += spread * length(ray.direction) * random.in_cube(1);
        if (!(length(r.direction) > 0)) r.direction = {0, 0, 1};
        Hit hit;
        if (random.below(8) != 0 || !list.closest(r, hit, nullptr)) continue;
        const int end = random.below(4);
        if (end == 0) r.t_max = hit.t;
        if (end == 1) r.t_max = std::nextafter(hit.t, -kInfinity);
        if (end == 2) r.t_min = hit.t;
        if (end == 3) r.t_min = std::nextafter(hit.t, kInfinity);
    }
    return rays;
}

void expect_hits_of(const Aggregate& list, const WideBvhAggregate& tested,
                    const std::vector<Ray>& rays, const std::string& name) {
    std::vector<Hit> any(rays.size()), coherent(rays.size());
    const auto met = std::make_unique<bool[]>(rays.size());
    const auto met_coherent = std::make_unique<bool[]>(rays.size());
    tested.closest_batch(rays, any, nullptr);
    tested.closest_batch(rays, coherent, nullptr, Coherence::Coherent);
    tested.occluded_batch(rays, {met.get(), rays.size()}, nullptr);
    tested.occluded_batch(rays, {met_coherent.get(), rays.size()}, nullptr, Coherence::Coherent);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Answer answer = ask(list, rays[i]);
        ASSERT_EQ(difference(answer, ask(tested, rays[i])), "") << name << ": " << show(rays[i]);
        ASSERT_TRUE(same(any[i], answer.closest)) << name << ", batch: " << show(rays[i]);
        ASSERT_TRUE(same(coherent[i], answer.closest)) << name << ", packet: " << show(rays[i]);
        ASSERT_EQ(met[i], answer.found) << name << ", batch: " << show(rays[i]);
        ASSERT_EQ(met_coherent[i], answer.found) << name << ", packet: " << show(rays[i]);
    }
}

TEST(AdverseShapes, HaveTheHitsOfTheListBySchedulesOfAllKinds) {
    Random random(401);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        for (int round = 0; round < 24; ++round) {
            const World world = some_world(random);
            const PrimitiveTable table = some_shapes(random, world, round % 3);
            const auto list = make_aggregate("list", table);
            const BuildQuality qualities[] = {BuildQuality::Default, BuildQuality::Fast,
                                              BuildQuality::High};
            const BuildOptions options{.quality = qualities[round / 3 % 3]};
            std::unique_ptr<StreamOverride> streams;
            if (round % 2 == 0) streams = std::make_unique<StreamOverride>();
            const WideBvhAggregate tested(table, options);
            for (int i = 0; i < 8; ++i) {
                const Ray ray = some_ray(random, world, table, *list);
                expect_hits_of(*list, tested, bundle_around(ray, random, world, *list),
                               target + ", round " + std::to_string(round));
                if (HasFatalFailure()) return;
            }
        }
    }
}

PrimitiveTable rods_and_balls(int rods, int balls) {
    Random random(402);
    PrimitiveTable table;
    for (int i = 0; i < std::max(rods, balls); ++i) {
        const Vec3 at = random.in_cube(2);
        if (i < balls) add(table, Sphere{at, 0.1}, true);
        if (i >= rods) continue;
        add(table, Cylinder{.base = at, .top = at + Vec3{0.3, 0.2, 0.1}, .radius = 0.02}, true);
    }
    table.material_opacity = {Opacity::Opaque, Opacity::Transparent};
    table.finish();
    return table;
}

TEST(AdverseShapes, SpheresShareTheBlocksOfCylindersUnlessTheseAreFew) {
    const WideBvhAggregate mixed(rods_and_balls(60, 60));
    EXPECT_TRUE(mixed.layout().spheres.empty());
    std::uint32_t balls = 0, shared = 0;
    for (const FrustumBlock& block : mixed.layout().frustums) {
        balls += static_cast<std::uint32_t>(std::popcount(block.balls));
        shared += block.balls != 0 && block.balls != block.lanes;
        for (std::uint32_t lane = 0; lane < used_lanes(block); ++lane) {
            const bool is_ball =
                mixed.primitives().kind(block.ids[lane].id()) == column_of<Sphere>();
            EXPECT_EQ(block.balls >> lane & 1, std::uint32_t{is_ball});
        }
    }
    EXPECT_EQ(balls, 60u);
    EXPECT_GT(shared, 5u);
    const WideBvhAggregate apart(rods_and_balls(5, 60));
    EXPECT_FALSE(apart.layout().spheres.empty());
    EXPECT_FALSE(apart.layout().frustums.empty());
}

/// The largest range that begins at 0 in the float of a tree of scale 1, below it -0.
TEST(AdverseShapes, RangesThatBeginAtMinusZeroInFloatAreThoseFromZero) {
    PrimitiveTable table;
    for (int i = 0; i < 200; ++i) {
        const Vec3 center{0.001 * i, 0.0007 * (i % 7), -0.0005 * (i % 11)};
        add(table, Sphere{center, 0.5 + 0.01 * (i % 13)}, true);
    }
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    const auto list = make_aggregate("list", table);
    const WideBvhAggregate tree(table, BuildOptions{});
    Ray ray{{0.05, 0.001, 0.002}, 0x1p41 * Vec3{1, 0.3, -0.2}, 0, kInfinity};
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        // Ends of ranges within 100 steps of the place where what is below them rounds to 0.
        ray.t_min = 0x1.000002000004p-141;
        for (int i = 0; i < 100; ++i) ray.t_min = std::nextafter(ray.t_min, 0.0);
        for (int i = 0; i < 200; ++i) {
            Hit expected, found;
            ASSERT_TRUE(list->closest(ray, expected, RayQuery{nullptr}));
            ASSERT_TRUE(tree.closest(ray, found, RayQuery{nullptr})) << target << ", step " << i;
            ASSERT_EQ(found.t, expected.t) << target << ", step " << i;
            ASSERT_EQ(found.primitive, expected.primitive) << target << ", step " << i;
            ray.t_min = std::nextafter(ray.t_min, 1.0);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
