#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "alhazen/formats/native/read/native_importer.h"
#include "alhazen/scene/scene.h"
#include "unit/tracer/tracer_cases.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mixed_scene;
using testing::random_rays;

TEST(TracerIds, AreThoseOfTheDetails) {
    const Tracer tracer(mixed_scene(5));
    const std::vector<Ray> rays = random_rays(7, 4000);
    std::vector<Hit> hits(rays.size());
    tracer.intersect(rays, hits);
    std::size_t in_instances = 0;
    Surface surface, scratch;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].found()) continue;
        const HitDetails details = tracer.details(rays[i], hits[i]);
        const HitIds ids = tracer.ids(hits[i]);
        EXPECT_EQ(ids.geometry, details.geometry);
        EXPECT_EQ(ids.primitive, details.primitive);
        EXPECT_EQ(ids.outermost,
                  details.instances.empty() ? details.geometry : details.instances[0]);
        in_instances += !details.instances.empty();
        tracer.surface(rays[i], hits[i], surface);
        EXPECT_EQ(surface.normal, details.normal);
        EXPECT_EQ(tracer.normal(rays[i], hits[i], scratch), details.normal);
        EXPECT_EQ(surface.point, details.point);
    }
    EXPECT_GT(in_instances, 10u);
    EXPECT_THROW((void)tracer.ids(Hit()), Error);
}

TEST(TracerNormal, OfAMirroredMeshIsThatOfTheSurface) {
    const std::vector<Vec3> positions{{0, 0, 1}, {1, 0, 2}, {0, 1, 3}};
    const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
    TracerScene scene;
    scene.add_mesh(positions, triangles, {.world_from_geometry = Affine::scale({-1, 1, 1})});
    const Tracer tracer(std::move(scene));
    const Ray ray{{-0.25, 0.25, 9}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(tracer.intersect(ray, hit));
    Surface surface, scratch;
    tracer.surface(ray, hit, surface);
    EXPECT_NE(surface.normal, Vec3{});
    EXPECT_EQ(tracer.normal(ray, hit, scratch), surface.normal);
}

TEST(TracerIds, OfACompiledSceneAreThePartsOfItsDescription) {
    const std::string text =
        "alhazen 1\n"
        "sphere { center = (10, 0, 0) }\n"
        "difference { box { lo = (-1, -1, -1); hi = (1, 1, 1) }  sphere { radius = 0.5 } }\n"
        "object \"pair\" { sphere { center = (0, 5, 0) }  sphere { center = (0, 8, 0) } }\n"
        "instance \"pair\" { transform = translate(0, 0, 20) }\n"
        "instance \"pair\" { transform = translate(0, 0, 40) }\n";
    Diagnostics diagnostics;
    const ImportOptions options;
    const SceneDescription description =
        NativeImporter().import({text, "scene.alhazen", options}, diagnostics);
    ASSERT_EQ(diagnostics.error_count(), 0u);
    const Scene scene = compile(description);
    const Tracer tracer = Tracer::of(scene);
    // Parts of the root: 0 sphere, 1 difference, 2 and 3 instances; then those of the objects.
    const auto expect_ids = [&](const Ray& ray, std::uint32_t outermost) {
        Hit hit;
        ASSERT_TRUE(tracer.intersect(ray, hit));
        const Surface surface = surface_at(tracer.aggregate(), ray, hit);
        Surface scratch;
        EXPECT_EQ(tracer.normal(ray, hit, scratch), surface.normal);
        const HitIds ids = tracer.ids(hit);
        EXPECT_EQ(ids.geometry, GeometryId{surface.part});
        EXPECT_EQ(ids.outermost, GeometryId{surface.instance});
        EXPECT_EQ(ids.outermost, GeometryId{outermost});
    };
    expect_ids({{10, 0, 9}, {0, 0, -1}}, 0);
    expect_ids({{0.9, 0, 9}, {0, 0, -1}}, 1);
    expect_ids({{0, 5, 30}, {0, 0, -1}}, 2);
    expect_ids({{0, 8, 50}, {0, 0, -1}}, 3);
    EXPECT_THROW((void)Tracer::of(compile_without_geometry(description)), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
