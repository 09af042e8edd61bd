/// Every accelerator of the table, with every kind of setting that changes how it works, has the
/// results of brute force. A new accelerator is tested by its line in the table; its settings are
/// added here.

#include <gtest/gtest.h>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "support/thorough.h"
#include "unit/aggregates/conformance_scenes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

std::vector<std::string> accelerators_to_compare() {
    std::vector<std::string> names{
        "bounding_volumes:bound=sphere",
        "bounding_volumes:bound=ellipsoid",
        "bounding_volumes:bound=slabs7",
        "bounding_volumes:bound=slabs13",
        "hierarchy:bound=sphere,order=stored",
        "hierarchy:bound=slabs13",
        "kay_kajiya:slabs=3",
        "kay_kajiya:slabs=13",
        "goldsmith_salmon:orders=3,reinsert=1,order=stored",
        "uniform_grid:density=0.1",
        "uniform_grid:density=20,mailbox=off",
        "nested_grid:leaf_size=2,max_depth=2",
        "nested_grid:planes=balanced,density=1,mailbox=off",
        "octree:walk=point_location",
        "octree:walk=neighbor_finding,mailbox=off",
        "octree:walk=smart,max_depth=6",
        "octree:walk=parametric,leaf_size=4",
        "kd_tree:mailbox=off,max_depth=30",
        "kd_tree:build=n2",
        "list:transform=z",
        "uniform_grid:nx=7,ny=1,nz=30",
        "uniform_grid:lists=boxes",
        "bsp:planes=directions3,mailbox=off",
        "bsp:planes=directions7,candidates=3",
        "bsp:planes=polygons",
        "ray_classification:leaf_size=1,max_depth=12",
        "ray_classification:memory_mib=0",
        "light_buffer:resolution=5,others=kd_tree",
        "light_buffer:density=0.1",
        "light_buffer:full_cells=off,shadow_cache=off,others=list",
        "ray_coherence:resolution=1,others=list",
        "ray_coherence:resolution=20,others=kd_tree",
        "ray_coherence:memory_mib=0",
    };
    for (const AcceleratorEntry& entry : accelerator_table()) {
        if (std::string(entry.name) != "list") names.emplace_back(entry.name);
    }
    return names;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& tested) {
    std::string name = tested.param;
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

class EveryAccelerator : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Table, EveryAccelerator, ::testing::ValuesIn(accelerators_to_compare()),
                         test_name);

/// A scene with rays and the results of brute force.
struct Expected {
    ConformanceScene scene;
    std::vector<Ray> rays;
    std::vector<Answer> answers;
    Box3 box;
};

const std::vector<Expected>& expected() {
    static const std::vector<Expected> all = [] {
        std::vector<Expected> made;
        for (ConformanceScene& scene : conformance_scenes()) {
            const auto list = make_aggregate("list", scene.table);
            Expected& e = made.emplace_back(Expected{std::move(scene), {}, {}, list->box()});
            RandomEngine random(7);
            for (int i = 0; i < cases(100, 300); ++i) {
                e.rays.push_back(e.scene.rays(random));
                e.answers.push_back(ask(*list, e.rays.back()));
            }
        }
        return made;
    }();
    return all;
}

TEST(ConformanceScenes, AreHit) {
    for (const Expected& e : expected()) {
        const auto hits = std::count_if(e.answers.begin(), e.answers.end(),
                                        [](const Answer& answer) { return answer.found; });
        EXPECT_TRUE(e.scene.table.size() == 0 || hits > cases(1, 5))
            << e.scene.name << ": " << hits;
    }
}

TEST_P(EveryAccelerator, FindsTheHitsOfBruteForce) {
    for (const Expected& e : expected()) {
        const auto tested = make_aggregate(GetParam(), e.scene.table);
        EXPECT_EQ(e.box, tested->box()) << e.scene.name;
        for (std::size_t i = 0; i < e.rays.size(); ++i) {
            ASSERT_EQ(difference(e.answers[i], ask(*tested, e.rays[i])), "")
                << e.scene.name << ", ray " << i << ": " << show(e.rays[i]);
        }
    }
}

/// Instances of one accelerator inside another.
std::shared_ptr<const Aggregate> nest(const std::string& outer, const std::string& inner) {
    const std::shared_ptr<const Aggregate> placed =
        make_aggregate(inner, random_mixture(40, 1, 0.3, 22));
    RandomEngine random(23);
    TableBuilder builder;
    for (int i = 0; i < 20; ++i) {
        Placement placement;
        placement.outer_from_inner.linear = {{0.2, 0, 0}, {0, 0.1, 0.1}, {0, -0.1, 0.1}};
        placement.outer_from_inner.translation = uniform_point(random, 1);
        placement.inner_from_outer = inverse(placement.outer_from_inner);
        builder.table.instances.push_back({.aggregate = placed, .placement = placement});
    }
    builder.add_sphere({0, 0, 0}, 0.4);
    return make_aggregate(outer, builder.finish());
}

TEST_P(EveryAccelerator, WorksInsideAndOutsideOfInstancesOfEveryOther) {
    const auto list = nest("list", "list");
    for (const AcceleratorEntry& other : accelerator_table()) {
        const auto tested = nest(GetParam(), other.name);
        RandomEngine random(24);
        const MakeRay rays = random_rays(1);
        for (int i = 0; i < cases(30, 100); ++i) {
            const Ray ray = rays(random);
            ASSERT_EQ(difference(ask(*list, ray), ask(*tested, ray)), "")
                << "around " << other.name << ", ray " << i << ": " << show(ray);
        }
    }
}

TEST(UniformGrid, WithoutTheRuleThatAHitLiesInItsCellTheWrongOneIsFound) {
    // A long triangle lies in the first cells of the ray but is hit far behind the small one.
    TableBuilder builder;
    builder.add_triangle({-1, -1, 0}, {-1, 1, 0}, {20, 0, 8});
    builder.add_triangle({3, -0.5, 1.5}, {3, 0.5, 1.5}, {3, 0, 4});
    for (int i = 0; i < 100; ++i) {
        const double x = 0.2 * i;
        builder.add_triangle({x, 3, 0}, {x + 0.1, 3, 0}, {x, 3.1, 0.1});
    }
    const PrimitiveTable table = builder.finish();
    const Ray ray{{-0.5, 0, 2}, {1, 0, 0.05}};
    const auto closest = [&](const std::string& accelerator) {
        Hit hit;
        EXPECT_TRUE(make_aggregate(accelerator, table)->closest(ray, hit, nullptr));
        return hit.primitive;
    };
    EXPECT_EQ(closest("list"), PrimitiveId{1});
    EXPECT_EQ(closest("uniform_grid"), PrimitiveId{1});
    EXPECT_EQ(closest("uniform_grid:hit_in_cell=off"), PrimitiveId{0});
}

TEST(AcceleratorSettings, OnesThatAreUnknownOrOutOfRangeAreRefusedWithWhatIsValid) {
    const auto message = [](const std::string& text) -> std::string {
        try {
            check_accelerator(text);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage);
            return error.what();
        }
        return "taken";
    };
    EXPECT_EQ(message("uniform_grid:density=4"), "taken");
    EXPECT_NE(message("uniform_grid:dense=4").find("density"), std::string::npos);
    EXPECT_NE(message("uniform_grid:density=-1").find("1e-06 to 1000"), std::string::npos);
    EXPECT_NE(message("uniform_grid:density=nan").find("expected"), std::string::npos);
    EXPECT_NE(message("hierarchy:bound=ellipsoid").find("sphere, box"), std::string::npos);
    EXPECT_NE(message("hierarchy:bound").find("NAME=VALUE"), std::string::npos);
    EXPECT_NE(message("hierarchy:bound=box,bound=box").find("twice"), std::string::npos);
    EXPECT_NE(message("list:bound=box").find("transform"), std::string::npos);
    EXPECT_NE(message("wide_bvh:bound=box").find("no settings"), std::string::npos);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
