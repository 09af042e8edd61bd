// Single-sided meshes, and thin sheets that light passes straight.

#include <gtest/gtest.h>

#include <string>

#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::floor_from_above;
using testing::fog;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

/// A square of two triangles at height z, which faces up.
TriangleMesh card(double half, double z) {
    TriangleMesh mesh;
    mesh.positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A lit floor below a single-sided card of triangles that covers the picture.
Scene below_a_card(const Rgb& radiance, const Affine& placement, bool with_fog) {
    SceneMaker maker = floor_from_above(0.2, {0.5, 0.5, 0.5});
    maker.light(
        PointLight{.position = {0.1, 0, 0.2}, .color = {10, 10, 10}, .attenuation = {0, 0, 1}});
    Material surface = shining(radiance);
    surface.double_sided = false;
    maker.add(maker.mesh(card(0.3, 0.3)), maker.material(surface), placement);
    // Volumes that scatter are followed along connections.
    if (with_fog) maker.add(ball({8, 0, 1}, 0.1), maker.material(fog({}, {1, 1, 1})));
    return maker.compile("wide_bvh");
}

constexpr const char* kRenderers[] = {"path_tracing",      "light_tracing",
                                      "bidirectional",     "vcm:photons=2000,pilot=off",
                                      "sppm:photons=2000", "photon_mapping:photons=2000"};

/// Light paths reach the picture rarely.
int samples_of(const std::string& renderer, int others) {
    return renderer.starts_with("light_tracing") ? 2048 : others;
}

TEST(SingleSidedMeshes, HideFromTheEyeWhatIsBehindTheirFront) {
    for (const std::string renderer : kRenderers) {
        for (const bool with_fog : {false, true}) {
            const Scene scene = below_a_card({1, 1, 1}, {}, with_fog);
            // Light of the floor would add 4.
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 64)).g, 1.0, 0.1)
                << renderer << (with_fog ? " with fog" : "");
        }
    }
}

TEST(SingleSidedMeshes, ShowTheEyeWhatIsBeforeTheirBack) {
    SceneMaker maker = floor_from_above(0.2, {0.5, 0.5, 0.5});
    maker.light(
        PointLight{.position = {0.1, 0, 0.2}, .color = {10, 10, 10}, .attenuation = {0, 0, 1}});
    const double bare = mean_of(picture_of(maker.compile(), "path_tracing", 4, 64)).g;
    ASSERT_GT(bare, 4.0);
    const Affine down = Affine::translate({0, 0, 0.6});
    const Affine turned = down * Affine::scale({1, -1, -1}),
                 mirrored = down * Affine::scale({1, 1, -1});
    for (const std::string renderer : kRenderers) {
        for (const bool with_fog : {false, true}) {
            const Scene scene = below_a_card({}, with_fog ? turned : mirrored, with_fog);
            const int samples = samples_of(renderer, 64);
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, samples)).g, bare, 0.05 * bare)
                << renderer << (with_fog ? " with fog" : "");
        }
    }
}

/// A sheet that passes this share of light, straight; the rest is a matt reflection.
Material sheet(double share, const Rgb& radiance = {}) {
    Material m = shining(radiance);
    m.metallic_roughness.emplace();
    m.metallic_roughness->metallic.value = 0;
    m.metallic_roughness->roughness.value = 0;
    m.metallic_roughness->specular.value = 0;
    m.metallic_roughness->transmission.value = share;
    return m;
}

Rectangle wide(double z) {
    return rectangle({-9, -9, z}, {18, 0, 0}, {0, 18, 0});
}

/// A lamp over a floor between two walls, with sheets across the middle of the walls.
Scene below_sheets(int count, double share) {
    SceneMaker maker = floor_from_above(1.2, {0.5, 0.5, 0.5});
    const MaterialId white = maker.material(matt({0.9, 0.9, 0.9}));
    maker.add(rectangle({-0.7, -1, 0}, {0, 2, 0}, {0, 0, 1}), white);
    maker.add(rectangle({0.7, -1, 0}, {0, 2, 0}, {0, 0, 1}), white);
    Material lamp = shining({1, 1, 1});
    lamp.double_sided = false;
    maker.add(rectangle({-0.6, -1, 1.5}, {0, 2, 0}, {1.2, 0, 0}), maker.material(lamp));
    for (int i = 0; i < count; ++i) maker.add(wide(0.6 + 0.1 * i), maker.material(sheet(share)));
    return maker.compile();
}

TEST(ThinSheets, PassedStraightTakeNoDepth) {
    for (const char* depth : {"1", "2"}) {
        const auto with_depth = [&](const char* name) {
            return std::string(name) + "depth=" + depth;
        };
        const double bare =
            mean_of(picture_of(below_sheets(0, 1), with_depth("path_tracing:"), 8, 512)).g;
        ASSERT_GT(bare, 0.05);
        for (const char* name :
             {"path_tracing:", "light_tracing:", "bidirectional:", "vcm:photons=500,pilot=off,",
              "sppm:photons=1000,", "photon_mapping:photons=20000,"}) {
            const std::string renderer = with_depth(name);
            const auto seen = [&](int count, double share) {
                const Scene scene = below_sheets(count, share);
                return mean_of(picture_of(scene, renderer, 8, samples_of(renderer, 128))).g;
            };
            EXPECT_NEAR(seen(3, 1.0), bare, 0.04 * bare) << renderer;
            // Whether a sheet is passed is left to chance.
            EXPECT_NEAR(seen(1, 0.5), 0.5 * bare, 0.04 * 0.5 * bare) << renderer;
        }
    }
}

TEST(ThinSheets, AtTheLargestDepthLightIsSeenThroughThem) {
    Material mirror;
    mirror.reflective.color = {0.5, 0.5, 0.5};
    for (const std::string renderer :
         {"path_tracing:depth=1", "bidirectional:depth=1", "vcm:photons=100,pilot=off,depth=1",
          "sppm:photons=100,depth=1", "photon_mapping:photons=100,depth=1"}) {
        SceneMaker maker = testing::looking_down();
        maker.add(wide(0.0), maker.material(mirror));
        maker.add(wide(6.0), maker.material(sheet(1)));
        maker.add(wide(7.0), maker.material(shining({2, 2, 2})));
        EXPECT_NEAR(mean_of(picture_of(maker.compile(), renderer, 2, 16)).g, 1.0, 1e-6) << renderer;
    }
}

TEST(ThinSheets, LightsAreSeenThroughSheetsThatShine) {
    for (const std::string renderer :
         {"path_tracing", "light_tracing", "bidirectional", "vcm:photons=100,pilot=off",
          "sppm:photons=100", "photon_mapping:photons=100"}) {
        SceneMaker maker = testing::looking_down();
        maker.add(wide(0.0), maker.material(shining({1, 1, 1})));
        maker.add(wide(1.0), maker.material(sheet(1)));
        maker.add(wide(2.0), maker.material(sheet(1, {0.3, 0.3, 0.3})));
        EXPECT_NEAR(mean_of(picture_of(maker.compile(), renderer, 4, 1024)).g, 1.3, 0.03)
            << renderer;
    }
}

/// Sheets that let nearly all light pass straight: a part of the paths that do not pass would have
/// all their emission.
TEST(ThinSheets, ThatShineAreSeenHoweverClear) {
    Material clear = sheet(1, {0.3, 0.3, 0.3}), dim = clear, coated = clear;
    clear.index.value = dim.index.value = coated.index.value = 1;
    clear.metallic_roughness->specular.value = 1;
    dim.index.value = 1.5;
    dim.metallic_roughness->specular.value = 0.01;
    coated.metallic_roughness->coat.strength.value = 0.01;
    for (const Material& material : {clear, dim, coated}) {
        SceneMaker maker = floor_from_above(0.2);
        maker.description().cameras[0].camera =
            OrthographicCamera{{-0.2, 0, 2}, normalize(Vec3{0.2, 0, -1}), {0.1, 0, 0}, {0, 0.1, 0}};
        maker.add(wide(1.0), maker.material(material));
        const Scene scene = maker.compile();
        const double seen = mean_of(picture_of(scene, "path_tracing", 4, 1024)).g;
        EXPECT_GT(seen, 0.4);
        for (const std::string renderer : {"bidirectional", "vcm:photons=500,pilot=off"}) {
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 1024)).g, seen, 0.02)
                << renderer << " " << &material - &clear;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
