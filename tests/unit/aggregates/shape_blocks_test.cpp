#include <gtest/gtest.h>

#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "support/random_shapes.h"
#include "support/thorough.h"
#include "unit/aggregates/answers.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using namespace testing;

constexpr double kInf = std::numeric_limits<double>::infinity();

template <class S>
void add(PrimitiveTable& table, const S& shape, bool opaque, std::uint32_t placement) {
    auto& column = std::get<ShapeColumn<S>>(table.columns);
    column.shapes.push_back(shape);
    column.placements.push_back(placement);
    column.materials.push_back(MaterialId{opaque ? 0u : 1u});
}

/// A rotated, sheared and translated frame.
Placement some_placement(Random& random) {
    Placement placement;
    Affine& outer = placement.outer_from_inner;
    outer = Affine::rotate(random.unit_vector(), random.uniform(0, 6));
    outer.linear.x_axis += 0.3 * outer.linear.y_axis;
    outer.linear.z_axis = random.uniform(0.2, 2) * outer.linear.z_axis;
    outer.translation = random.in_cube(5);
    placement.inner_from_outer = inverse(outer);
    return placement;
}

PrimitiveTable finished(PrimitiveTable table) {
    table.material_opacity = {Opacity::Opaque, Opacity::Transparent};
    table.finish();
    return table;
}

template <class S>
PrimitiveTable shapes_of(Random& random, int count, bool lattice, double placed) {
    PrimitiveTable table;
    for (int i = 0; i < 4; ++i) table.placements.push_back(some_placement(random));
    for (int i = 0; i < count; ++i) {
        S shape = random_shape<S>(ShapeSource{random, lattice});
        const bool is_placed = random.uniform() < placed;
        add(table, shape, random.coin(),
            is_placed ? static_cast<std::uint32_t>(random.below(4)) : kNoPlacement);
    }
    return finished(std::move(table));
}

Ray random_ray(Random& random, bool lattice) {
    Ray ray{lattice ? random.on_lattice(6, 0.5) : random.in_cube(60), {}, 0, kInf};
    ray.direction = lattice ? random.lattice_direction() : random.in_cube(30) - ray.origin;
    if (random.below(4) == 0) ray.t_max = random.uniform(0, lattice ? 5 : 1);
    if (random.below(4) == 0) ray.t_min = random.uniform(0, lattice ? 2 : 0.5);
    return ray;
}

/// A ray at the limit of hitting a primitive: between one that hits and one that misses.
Ray grazing_ray(Random& random, const PrimitiveTable& table) {
    const auto id =
        PrimitiveId{static_cast<std::uint32_t>(random.below(static_cast<int>(table.size())))};
    const auto meets = [&](const Ray& ray) {
        return table.occluded(id, ray, RayShear(ray.direction), NoStats{}, kAllRays);
    };
    const Box3 box = table.box(static_cast<std::uint32_t>(id));
    const Vec3 middle = box.bounded() ? box.center() : Vec3{};
    const double size = box.bounded() ? length(box.size()) : 10.0;
    // Some from so far away that float has the position of the shape only coarsely.
    const double away = random.log_uniform(1, random.below(4) == 0 ? 1e5 : 30);
    Ray hit{middle + away * size * random.unit_vector(), {}, 0, kInf}, miss = hit;
    for (int i = 0; i < 100; ++i) {
        // Within the box, not within a cube: a shape may be a sliver.
        Vec3 target = random.in_cube(0.5 * size);
        if (box.bounded()) target = random.in_cube(0.5) * box.size();
        hit.direction = middle + target - hit.origin;
        if (meets(hit)) break;
    }
    miss.direction = middle + 2 * size * random.unit_vector() - miss.origin;
    for (int i = random.below(55); i > 0; --i) {
        Ray between = hit;
        between.direction = 0.5 * (hit.direction + miss.direction);
        (meets(between) ? hit : miss) = between;
    }
    return hit;
}

/// Compares single rays and batches with the list, on every instruction set.
void compare(const std::string& name, const PrimitiveTable& table, const std::vector<Ray>& rays,
             int least_hits = 1) {
    const auto list = make_aggregate("list", table);
    std::vector<Answer> answers;
    int hits = 0;
    for (const Ray& ray : rays) {
        answers.push_back(ask(*list, ray));
        hits += answers.back().found;
    }
    EXPECT_GE(hits, least_hits) << name;
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const WideBvhAggregate tested(table);
        std::vector<Hit> batch(rays.size());
        tested.closest_batch(rays, batch, nullptr);
        const auto occluded = std::make_unique<bool[]>(rays.size());
        tested.occluded_batch(rays, {occluded.get(), rays.size()}, nullptr);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(difference(answers[i], ask(tested, rays[i])), "")
                << name << " on " << target << ", ray " << i << ": " << show(rays[i]);
            ASSERT_TRUE(same(batch[i], answers[i].closest)) << name << ", ray " << i;
            ASSERT_EQ(occluded[i], answers[i].occluded) << name << ", ray " << i;
        }
    }
}

/// A type of shape and what makes tables of it: these tests are compiled once, not once per type.
struct BlockType {
    const char* name;
    PrimitiveTable (*table)(Random& random, int count, bool lattice, double placed);
};
template <class... S>
std::vector<BlockType> block_types(const ShapeTypes<S...>*) {
    return {{S::kName, &shapes_of<S>}...};
}

class ShapeBlocks : public ::testing::TestWithParam<BlockType> {};
INSTANTIATE_TEST_SUITE_P(, ShapeBlocks,
                         ::testing::ValuesIn(block_types(static_cast<AnalyticShapes*>(nullptr))),
                         [](const auto& type) { return std::string(type.param.name); });

TEST_P(ShapeBlocks, GiveTheHitsOfTheListToRandomRays) {
    Random random(101);
    for (const bool lattice : {false, true}) {
        for (const double placed : {0.0, 0.5}) {
            const PrimitiveTable table = GetParam().table(random, 60, lattice, placed);
            std::vector<Ray> rays(300);
            for (Ray& ray : rays) ray = random_ray(random, lattice);
            compare(std::string(GetParam().name) + (lattice ? " on a lattice" : ""), table, rays);
        }
    }
}

TEST_P(ShapeBlocks, LoseNoHitOfARayThatJustSoMeetsAShape) {
    Random random(102);
    for (const double placed : {0.0, 1.0}) {
        const PrimitiveTable table = GetParam().table(random, 40, false, placed);
        std::vector<Ray> rays(thorough() ? 400 : 100);
        for (Ray& ray : rays) ray = grazing_ray(random, table);
        compare(GetParam().name, table, rays, cases(75, 300));
    }
}

/// One shape of each kind in one tree.
struct Mixture {
    PrimitiveTable table;
    Random& random;
    bool lattice;

    template <class... S>
    void add_all(ShapeTypes<S...>) {
        (add(table, random_shape<S>(ShapeSource{random, lattice}), random.coin(), kNoPlacement),
         ...);
    }
};

PrimitiveTable mixture(Random& random, int rounds, bool lattice) {
    Mixture mixture{{}, random, lattice};
    for (int i = 0; i < rounds; ++i) mixture.add_all(AnalyticShapes{});
    auto mesh = std::make_shared<TriangleMesh>();
    for (std::uint32_t i = 0; i < 60; ++i) {
        const ShapeSource from{random, lattice};
        mesh->positions.push_back(from.point());
        mesh->positions.push_back(mesh->positions.back() + from.vector());
        mesh->positions.push_back(mesh->positions.back() + from.vector());
        mesh->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    mixture.table.meshes.push_back({mesh, MaterialId{0}, 0, false});
    return std::move(mixture.table);
}

TEST(ShapeBlocksMixture, OfAllShapesGivesTheHitsOfTheList) {
    Random random(103);
    for (const bool lattice : {false, true}) {
        const PrimitiveTable table = finished(mixture(random, 12, lattice));
        std::vector<Ray> rays(600);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            rays[i] =
                i % 2 == 0 || lattice ? random_ray(random, lattice) : grazing_ray(random, table);
        }
        compare("mixture", table, rays);
    }
}

TEST(ShapeBlocksMixture, OfTurnedInstancesGivesTheHitsOfNestedLists) {
    Random random(104);
    PrimitiveTable object = finished(mixture(random, 1, false));
    // A plane has no box, nor has an instance of one.
    auto& planes = std::get<ShapeColumn<Plane>>(object.columns);
    planes = {};
    object = finished(std::move(object));
    const auto outer_of = [&](const char* accelerator) {
        Random places(105);
        PrimitiveTable table;
        const std::shared_ptr<const Aggregate> inner = make_aggregate(accelerator, object);
        for (int i = 0; i < 30; ++i) {
            Placement placement = some_placement(places);
            placement.outer_from_inner.translation = places.in_cube(100);
            placement.inner_from_outer = inverse(placement.outer_from_inner);
            table.instances.push_back({.aggregate = inner, .placement = placement});
        }
        return finished(std::move(table));
    };
    const auto list = make_aggregate("list", outer_of("list"));
    const WideBvhAggregate tested(outer_of("wide_bvh"));
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        Ray ray{random.in_cube(150), {}, 0, kInf};
        ray.direction = random.in_cube(100) - ray.origin;
        const Answer answer = ask(*list, ray);
        hits += answer.found;
        ASSERT_EQ(difference(answer, ask(tested, ray)), "") << i << ": " << show(ray);
    }
    EXPECT_GT(hits, 100);
}

TEST(ShapeBlocksMixture, OfThinShapesIsPassedByRaysThatMissThem) {
    // The filters must reject most candidates before the tests in double.
    Random random(106);
    PrimitiveTable table;
    for (int i = 0; i < 400; ++i) {
        Cylinder c;
        c.base = random.in_cube(30);
        c.top = c.base + 20.0 * random.unit_vector();
        c.radius = 0.05;
        add(table, c, true, kNoPlacement);
        Rectangle r;
        r.corner = random.in_cube(30);
        r.edge_u = 10.0 * random.unit_vector();
        r.edge_v = 0.2 * perpendicular(normalize(r.edge_u));
        add(table, r, true, kNoPlacement);
    }
    const WideBvhAggregate tested(finished(std::move(table)));
    const WideBvhLayout& layout = tested.layout();
    EXPECT_GT(layout.frustums.size(), 0u);
    EXPECT_GT(layout.others.size(), 0u);
    EXPECT_LT(layout.frustums.size() + layout.others.size(), 500u) << "blocks are shared";
}

TEST(ShapeBlocksMixture, IsStoredRefittedAndMovedAlong) {
    Random random(107);
    PrimitiveTable table = mixture(random, 10, false);
    WideBvhAggregate tested(finished(table));
    const Vec3 step{3, -4, 5};
    for (auto& c : std::get<ShapeColumn<Cylinder>>(table.columns).shapes) {
        c.base += step;
        c.top += step;
    }
    for (auto& r : std::get<ShapeColumn<Rectangle>>(table.columns).shapes) r.corner += step;
    for (auto& d : std::get<ShapeColumn<Disc>>(table.columns).shapes) d.center += step;
    const PrimitiveTable moved = finished(std::move(table));
    (void)tested.refit(moved);
    const auto list = make_aggregate("list", moved);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        const Ray ray = i % 2 == 0 ? random_ray(random, false) : grazing_ray(random, moved);
        const Answer answer = ask(*list, ray);
        hits += answer.found;
        ASSERT_EQ(difference(answer, ask(tested, ray)), "") << i << ": " << show(ray);
    }
    EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
