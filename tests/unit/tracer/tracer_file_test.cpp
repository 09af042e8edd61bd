#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/tracer/tracer.h"
#include "support/scratch_folder.h"
#include "unit/tracer/tracer_cases.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mixed_scene;
using testing::random_rays;
using testing::same_hit;
using testing::ScratchFolder;

TEST(TracerFile, ALoadedTreeGivesTheSameHits) {
    const ScratchFolder folder;
    const auto path = folder.path() / "tree";
    const Tracer built(mixed_scene(3, 2000));
    built.save(path);
    const Tracer loaded = Tracer::load(mixed_scene(3, 2000), path);
    std::filesystem::remove(path);
    EXPECT_EQ(loaded.geometry_count(), built.geometry_count());
    EXPECT_EQ(loaded.box(), built.box());
    const std::vector<Ray> rays = random_rays(4, 5000);
    std::vector<Hit> hits(rays.size());
    loaded.intersect(rays, hits);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit one, other;
        built.intersect(rays[i], one);
        loaded.intersect(rays[i], other);
        ASSERT_TRUE(same_hit(one, other) && same_hit(one, hits[i])) << i;
        if (!one.found()) continue;
        ++found;
        const HitDetails a = built.details(rays[i], one), b = loaded.details(rays[i], other);
        ASSERT_EQ(a.geometry, b.geometry) << i;
        ASSERT_EQ(a.primitive, b.primitive) << i;
        ASSERT_EQ(a.point, b.point) << i;
    }
    EXPECT_GT(found, rays.size() / 4);
}

TEST(TracerFile, TreesOfEveryQualityAreStored) {
    const ScratchFolder folder;
    const TracerScene scene = mixed_scene(9, 3000);
    const Tracer list(scene, {.accelerator = "list"});
    for (const BuildQualityEntry& entry : build_quality_table()) {
        Tracer(scene, {.build = {.quality = entry.quality}}).save(folder.path() / entry.name);
        const Tracer loaded = Tracer::load(scene, folder.path() / entry.name);
        for (const Ray& ray : random_rays(10, 300)) {
            Hit one, other;
            list.intersect(ray, one);
            loaded.intersect(ray, other);
            ASSERT_TRUE(same_hit(one, other)) << entry.name;
        }
    }
}

TEST(TracerFile, ATreeOfFastPrecisionKeepsIt) {
    const ScratchFolder folder;
    const TracerScene scene = mixed_scene(11, 3000);
    const Tracer fast(scene, {.build = {.precision = Precision::Fast}});
    fast.save(folder.path() / "tree");
    const Tracer loaded = Tracer::load(scene, folder.path() / "tree");
    const Tracer robust(scene);
    std::size_t differ = 0;
    for (const Ray& ray : random_rays(12, 2000)) {
        Hit one, other, exact;
        fast.intersect(ray, one);
        loaded.intersect(ray, other);
        robust.intersect(ray, exact);
        ASSERT_TRUE(same_hit(one, other));
        differ += !same_hit(one, exact);
        if (!one.found()) continue;
        ASSERT_EQ(fast.details(ray, one).error, loaded.details(ray, other).error);
    }
    EXPECT_GT(differ, 10u);
}

TEST(TracerFile, ALoadedTracerIsAnInstanceLikeAnother) {
    const ScratchFolder folder;
    Tracer(mixed_scene(5)).save(folder.path() / "inner");
    const auto around = [](const Tracer& inner) {
        TracerScene scene;
        scene.add_instance(inner, {.world_from_geometry = Affine::scale({2, 1, 1})});
        return scene;
    };
    const TracerScene with_built = around(Tracer(mixed_scene(5)));
    const TracerScene with_loaded = around(Tracer::load(mixed_scene(5), folder.path() / "inner"));
    Tracer(with_built).save(folder.path() / "outer");
    const Tracer loaded = Tracer::load(with_loaded, folder.path() / "outer");
    const Tracer built(with_built);
    for (const Ray& ray : random_rays(6, 500)) {
        Hit one, other;
        built.intersect(ray, one);
        loaded.intersect(ray, other);
        ASSERT_TRUE(same_hit(one, other));
    }
}

TEST(TracerFile, OtherScenesAndAcceleratorsAreRefused) {
    const ScratchFolder folder;
    const auto path = folder.path() / "tree";
    Tracer(mixed_scene(1)).save(path);
    try {
        (void)Tracer::load(mixed_scene(2), path);
        FAIL() << "the tree of another scene was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("other geometry"), std::string::npos);
        EXPECT_EQ(error.kind(), ErrorKind::File);
    }
    EXPECT_THROW((void)Tracer::load(mixed_scene(1), folder.path() / "none"), Error);
    EXPECT_THROW((void)Tracer::load(mixed_scene(1), folder.path()), Error);
    EXPECT_THROW(Tracer(mixed_scene(1), {.accelerator = "list"}).save(path), Error);
    EXPECT_THROW(Tracer(mixed_scene(1)).save(folder.path() / "none" / "tree"), Error);
    EXPECT_NO_THROW((void)Tracer::load(mixed_scene(1), path)) << "still what it was";
}

/// The boxes and spheres around both are the same.
TEST(TracerFile, APlateIsNotTheSamePlateWithAHole) {
    const auto plate = [](bool with_hole) {
        Polygon p;
        p.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        p.loop_ends = {4};
        if (with_hole) {
            p.vertices.insert(p.vertices.end(),
                              {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}});
            p.loop_ends.push_back(8);
        }
        TracerScene scene;
        scene.add(AnyShape{p});
        scene.add_sphere({0, 0, -3}, 0.4);
        return scene;
    };
    const ScratchFolder folder;
    const auto path = folder.path() / "tree";
    Tracer(plate(false)).save(path);
    EXPECT_THROW((void)Tracer::load(plate(true), path), Error);
    EXPECT_NO_THROW((void)Tracer::load(plate(false), path));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
