// Treeless packets: batches against few shapes have the hits of the list.

#include <gtest/gtest.h>

#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "support/random_shapes.h"
#include "unit/aggregates/answers.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

constexpr double kInf = std::numeric_limits<double>::infinity();

template <class S>
void add(PrimitiveTable& table, const S& shape, std::uint32_t placement, RayMask mask) {
    auto& column = std::get<ShapeColumn<S>>(table.columns);
    column.shapes.push_back(shape);
    column.placements.push_back(placement);
    column.materials.push_back(MaterialId{0});
    column.visible_to.push_back(mask);
}

Placement some_placement(Random& random) {
    Placement placement;
    Affine& outer = placement.outer_from_inner;
    outer = Affine::rotate(random.unit_vector(), random.uniform(0, 6));
    outer.linear.x_axis += 0.3 * outer.linear.y_axis;
    outer.translation = random.in_cube(5);
    placement.inner_from_outer = inverse(outer);
    return placement;
}

/// `count` shapes supported by treeless packets, sometimes with a plane below them.
PrimitiveTable few_shapes(Random& random, int count) {
    PrimitiveTable table;
    table.placements.push_back(some_placement(random));
    const RayMask masks[] = {kAllRays, 1, 3};
    for (int i = 0; i < count; ++i) {
        const std::uint32_t placement = random.below(3) == 0 ? 0 : kNoPlacement;
        const RayMask mask = masks[random.below(3)];
        const ShapeSource from{random, false};
        switch (random.below(4)) {
            case 0:
                add(table, random_shape<Torus>(from), placement, mask);
                break;
            case 1:
                add(table, random_shape<Sphere>(from), placement, mask);
                break;
            case 2:
                add(table, random_shape<Algebraic>(from), placement, mask);
                break;
            default:
                add(table, random_shape<Blob>(from), placement, mask);
        }
    }
    if (random.coin()) add(table, Plane{.point = {0, 0, -2}}, kNoPlacement, kAllRays);
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return table;
}

Ray random_ray(Random& random, const PrimitiveTable& table) {
    const Box3 box =
        table.box(static_cast<std::size_t>(random.below(static_cast<int>(table.size()))));
    const Vec3 middle = box.bounded() ? box.center() : Vec3{};
    const double size = box.bounded() ? length(box.size()) : 10.0;
    Ray ray{middle + random.log_uniform(0.1, 1e4) * size * random.unit_vector(), {}, 0, kInf};
    ray.direction = middle + random.in_cube(0.5 * size) - ray.origin;
    if (random.below(4) == 0) ray.t_max = random.uniform(0, 2);
    if (random.below(4) == 0) ray.t_min = random.uniform(0, 1);
    if (random.below(20) == 0) ray.direction = {};           // invalid
    if (random.below(20) == 0) ray.origin.x = std::nan("");  // invalid
    if (random.below(20) == 0) ray.direction = 1e-300 * ray.direction;
    return ray;
}

TEST(SideBySide, BatchesHaveTheHitsOfTheList) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        Random random(1);
        int hit_count = 0;
        for (int scene = 0; scene < 60; ++scene) {
            const PrimitiveTable table = few_shapes(random, 1 + scene % 5);
            const auto list = make_aggregate("list", table);
            const WideBvhAggregate tested(table);
            std::vector<Ray> rays(static_cast<std::size_t>(random.below(40)));
            for (Ray& ray : rays) ray = random_ray(random, table);
            for (const RayMask mask : {kAllRays, RayMask{1}, RayMask{2}}) {
                TraversalStats counted;
                const RayQuery query{&counted, mask};
                std::vector<Hit> batch(rays.size()), coherent(rays.size());
                tested.closest_batch(rays, batch, query);
                tested.closest_batch(rays, coherent, query, Coherence::Coherent);
                const auto occluded = std::make_unique<bool[]>(rays.size());
                tested.occluded_batch(rays, {occluded.get(), rays.size()}, query);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const Answer answer = ask(*list, rays[i], mask);
                    hit_count += answer.found;
                    const std::string where = target + ", scene " + std::to_string(scene) +
                                              ", ray " + std::to_string(i) + ": " + show(rays[i]);
                    ASSERT_TRUE(same(batch[i], answer.closest)) << where << show(batch[i]);
                    ASSERT_TRUE(same(coherent[i], answer.closest)) << where;
                    ASSERT_EQ(occluded[i], answer.occluded) << where;
                }
            }
        }
        EXPECT_GT(hit_count, 500);
    }
}

TEST(SideBySide, EveryTestIsCounted) {
    PrimitiveTable table;
    add(table, Torus{}, kNoPlacement, kAllRays);
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    const WideBvhAggregate tested(table);
    const Ray hits{{1, 0, 5}, {0, 0, -1}}, misses{{5, 5, 5}, {0, 0, -1}}, invalid{{0, 0, 0}, {}};
    const std::vector<Ray> rays{hits, misses, invalid, hits};
    TraversalStats counted;
    std::vector<Hit> batch(rays.size());
    tested.closest_batch(rays, batch, &counted);
    EXPECT_EQ(counted.primitive_tests, 3u);
    EXPECT_EQ(counted.primitive_hits, 2u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
