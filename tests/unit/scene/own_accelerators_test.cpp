/// Objects with separate accelerators.

#include <gtest/gtest.h>

#include <cstring>

#include "alhazen/aggregates/accelerator_bytes.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/sampling/random.h"
#include "alhazen/scene/scene.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

/// A field of groups of balls, one of them placed once.
SceneMaker field(const std::string& inner, const std::string& middle) {
    SceneMaker maker;
    RandomStream random(1);
    const auto place = [&](double reach) {
        const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
        return Affine::translate({x, y, random.uniform(-reach, reach)});
    };
    const ObjectIndex clump = maker.object("clump");
    for (int i = 0; i < 30; ++i) {
        maker.add(Sphere{.center = {}, .radius = 0.3}, MaterialId{0}, place(1), clump);
    }
    const ObjectIndex once = maker.object("once");
    for (int i = 0; i < 20; ++i) maker.add(clump, MaterialId{0}, place(3), once);
    maker.add(once);
    maker.light(PointLight{.position = {0, 0, 9}});
    maker.description().objects[static_cast<std::size_t>(clump)].accelerator = inner;
    maker.description().objects[static_cast<std::size_t>(once)].accelerator = middle;
    return maker;
}

TEST(OwnAccelerators, OneStandsInsideAnotherAndTheHitsStay) {
    const Scene list = field("list", "list").compile("list");
    EXPECT_EQ(list.census.instances, 21u);  // objects placed once are not flattened
    for (const auto& [inner, middle, outer] :
         {std::tuple{"uniform_grid:nx=3,ny=2,nz=1", "list", "kd_tree"},
          std::tuple{"ray_classification", "nested_grid", "wide_bvh"},
          std::tuple{"bsp:planes=polygons", "light_buffer", "ray_coherence"}}) {
        const Scene scene = field(inner, middle).compile(outer);
        RandomStream random(2);
        int hits = 0;
        for (int i = 0; i < 500; ++i) {
            Ray ray;
            for (int k = 0; k < 3; ++k) {
                ray.origin[k] = random.uniform(-5, 5);
                ray.direction[k] = random.uniform(-1, 1);
            }
            Hit expected, found;
            hits += list.aggregate->closest(ray, expected, nullptr);
            (void)scene.aggregate->closest(ray, found, nullptr);
            EXPECT_EQ(std::memcmp(&expected.t, &found.t, sizeof(double)), 0) << outer << ", " << i;
            EXPECT_EQ(expected.primitive, found.primitive) << outer << ", " << i;
            EXPECT_EQ(expected.path, found.path) << outer << ", " << i;
        }
        EXPECT_GT(hits, 100);
    }
}

TEST(OwnAccelerators, AreLeftOutWhereEverythingIsToBeTracedAlike) {
    const SceneMaker maker = field("octree", "octree");
    SceneDescription description = SceneMaker(maker).description();
    description.materials.push_back({});
    const auto bytes = [&](bool own) {
        return compile(description, {.accelerator = "list",
                                     .csg = "event_heap",
                                     .build = {},
                                     .own_accelerators = own})
            .census.accelerator_bytes;
    };
    EXPECT_GT(bytes(true), 2 * bytes(false));
}

TEST(AcceleratorBytes, AreThoseOfTheCensusUntilRaysMakeLists) {
    for (const auto& [inner, outer, grows] :
         {std::tuple{"octree", "wide_bvh", false}, std::tuple{"bsp", "light_buffer", false},
          std::tuple{"ray_classification", "kd_tree", true},
          std::tuple{"list", "ray_coherence", true}}) {
        const Scene scene = field(inner, "hierarchy").compile(outer);
        const std::uint64_t built = accelerator_bytes(*scene.aggregate);
        EXPECT_EQ(built, scene.census.accelerator_bytes) << inner << " in " << outer;
        RandomStream random(3);
        for (int i = 0; i < 300; ++i) {
            Ray ray;
            for (int k = 0; k < 3; ++k) {
                ray.origin[k] = random.uniform(-3, 3);
                ray.direction[k] = random.uniform(-1, 1);
            }
            (void)scene.aggregate->occluded(ray, nullptr);
        }
        const std::uint64_t traced = accelerator_bytes(*scene.aggregate);
        EXPECT_EQ(traced > built, grows) << inner << " in " << outer;
    }
}

TEST(OwnAccelerators, OnesThatThereAreNotAreFindings) {
    const auto findings = [](const std::string& accelerator) {
        SceneMaker maker = field(accelerator, "");
        maker.material({});
        Diagnostics diagnostics;
        validate(maker.description(), diagnostics);
        std::string all;
        for (const Diagnostic& d : diagnostics.all()) all += to_string(d) + "\n";
        return all;
    };
    EXPECT_EQ(findings("octree:leaf_size=3"), "");
    EXPECT_NE(findings("quadtree").find("no accelerator 'quadtree'"), std::string::npos);
    EXPECT_NE(findings("octree:leaves=3").find("leaf_size"), std::string::npos);
    SceneMaker root = field("", "");
    root.material({});
    root.description().objects[0].accelerator = "list";
    Diagnostics diagnostics;
    validate(root.description(), diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 1u);
}

TEST(PrimitiveTable, TheLightsOfTheSceneAreKnownToItsOutermostTable) {
    SceneMaker maker = field("", "");
    maker.light(DirectionalLight{.to_light = {0, 0, 1}});
    maker.light(AmbientLight{});
    const auto ends = maker.compile().aggregate->primitives().known_ray_ends;
    ASSERT_EQ(ends.size(), 2u);
    EXPECT_EQ(ends[0].place, (Vec3{0, 0, 9}));
    EXPECT_FALSE(ends[0].at_infinity);
    EXPECT_TRUE(ends[1].at_infinity);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
