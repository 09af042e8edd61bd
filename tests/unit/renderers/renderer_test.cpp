/// The interface of renderers, with one that has neither tiles nor rays.

#include "alhazen/renderers/core/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <variant>

#include "alhazen/base/error.h"
#include "support/scene_maker.h"
#include "unit/renderers/stop_after.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using testing::StopAfter;

/// Fills the discs that spheres cover, one scan line after the other: seen by parallel rays along
/// -z, one unit of the scene per pixel. Reads the description; the last sphere is in front.
class DiscPainter final : public Renderer {
  public:
    [[nodiscard]] bool needs_aggregate() const override { return false; }
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override {
        const PixelBox& crop = film.crop();
        RenderReport report;
        report.parts = static_cast<std::size_t>(crop.height());
        for (int y = crop.y0; y < crop.y1 && !job.stop_requested(); ++y) {
            for (const Part& part : job.description->objects[0].parts) {
                const auto& sphere = std::get<Sphere>(std::get<AnyShape>(part.what));
                const auto material = static_cast<std::size_t>(part.material);
                const double up = y + 0.5 - sphere.center.y;
                for (int x = crop.x0; x < crop.x1; ++x) {
                    const double right = x + 0.5 - sphere.center.x;
                    if (right * right + up * up > sphere.radius * sphere.radius) continue;
                    film.set(x, y, job.scene.materials[material].diffuse.color);
                }
            }
            ++report.done;
            if (job.control.progress != nullptr) {
                job.control.progress->update("render", report.done, report.parts);
            }
        }
        return report;
    }
};

TEST(RendererList, DepthBecomesASettingOfWhatFollowsPaths) {
    EXPECT_EQ(with_depth("path_tracing", 8), "path_tracing:depth=9");
    EXPECT_EQ(with_depth("vcm:merge=off", 0), "vcm:merge=off,depth=1");
    EXPECT_EQ(with_depth("sppm:depth=3,alpha=0.5", 8), "sppm:depth=3,alpha=0.5");
    EXPECT_EQ(with_depth("whitted:beer=on", 8), "whitted:beer=on");
    EXPECT_EQ(with_depth("unknown", 8), "unknown");
    for (const RendererEntry& entry : renderers()) {
        EXPECT_NO_THROW(static_cast<void>(make_renderer(with_depth(entry.name, 1000))));
    }
}

TEST(Renderer, OneWithoutTilesRendersASceneWithoutAnAggregate) {
    SceneMaker maker;
    Material red, green;
    red.diffuse.color = {1, 0, 0};
    green.diffuse.color = {0, 1, 0};
    maker.add(Sphere{.center = {3, 3, 0}, .radius = 2}, maker.material(red));
    maker.add(Sphere{.center = {5, 5, 0}, .radius = 2}, maker.material(green));
    const Scene scene = compile_without_geometry(maker.description());
    ASSERT_EQ(scene.aggregate, nullptr);
    RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .description = &maker.description()};
    Film film(8, 8, {0, 0, 8, 8});
    const RenderReport report = DiscPainter().render(job, film);
    EXPECT_TRUE(report.complete());
    EXPECT_EQ(report.done, 8u);
    EXPECT_EQ(report.counters.total_cast(), 0u);
    EXPECT_EQ(film.at(0, 0), Rgb{});
    EXPECT_EQ(film.at(2, 2), red.diffuse.color);
    EXPECT_EQ(film.at(4, 4), green.diffuse.color);

    StopAfter sink(3);
    job.control = {.stop = &sink.stop, .progress = &sink};
    Film part(8, 8, {0, 0, 8, 8});
    const RenderReport stopped = DiscPainter().render(job, part);
    EXPECT_FALSE(stopped.complete());
    EXPECT_EQ(stopped.done, 3u);
    EXPECT_EQ(part.at(2, 2), red.diffuse.color);
    EXPECT_EQ(part.at(4, 4), Rgb{});
}

TEST(Renderer, ASceneCompiledInTwoStepsIsTheSceneCompiledInOne) {
    SceneMaker maker;
    Material glass;
    glass.transmissive.color = {1, 1, 1};
    maker.add(Sphere{.radius = 0.5}, maker.material(glass));
    const ObjectIndex pair = maker.object("pair");
    maker.add(Sphere{}, MaterialId{0}, {}, pair);
    maker.add(pair);
    maker.add(pair, MaterialId{0}, Affine::translate({3, 0, 0}));
    const Scene whole = maker.compile("wide_bvh");
    Scene scene = compile_without_geometry(maker.description());
    EXPECT_EQ(scene.census.effective_primitives, 0u);
    EXPECT_EQ(scene.all_opaque, whole.all_opaque);
    EXPECT_TRUE(scene.accelerator.empty());
    build_aggregate(maker.description(), {.accelerator = "wide_bvh"}, scene);
    EXPECT_EQ(scene.aggregate->box().lo, whole.aggregate->box().lo);
    EXPECT_EQ(scene.aggregate->box().hi, whole.aggregate->box().hi);
    EXPECT_EQ(scene.accelerator, whole.accelerator);
    EXPECT_EQ(scene.census.effective_primitives, 3u);
    EXPECT_EQ(scene.census.scene_bytes, whole.census.scene_bytes);
    EXPECT_EQ(scene.census.accelerator_bytes, whole.census.accelerator_bytes);
}

TEST(Renderer, EveryOneOfTheTableIsMadeByItsName) {
    for (const RendererEntry& entry : renderers()) {
        const std::string name = entry.name;
        const bool traces_rays = name != "lane_carpenter" && name != "clark" &&
                                 name != "cone_tracing" && name != "beam_tracing";
        EXPECT_EQ(make_renderer(name)->needs_aggregate(), traces_rays) << name;
    }
    EXPECT_THROW((void)make_renderer("wited"), Error);
}

TEST(RendererSettings, AreCheckedByTheirRenderer) {
    EXPECT_NO_THROW((void)make_renderer("lane_carpenter:flatness=0.5,cracks=show,split=both"));
    EXPECT_NO_THROW((void)make_renderer("clark"));
    for (const char* text :
         {"lane_carpenter:flatness=0", "lane_carpenter:flatness=x", "lane_carpenter:cracks=none",
          "lane_carpenter:flat=1", "lane_carpenter:flatness", "lane_carpenter:split=one,split=one",
          "whitted:flatness=1", "lane"}) {
        EXPECT_THROW((void)make_renderer(text), Error) << text;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
