// Single-sided meshes.

#include <gtest/gtest.h>

#include <string>

#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::floor_from_above;
using testing::fog;
using testing::mean_of;
using testing::picture_of;
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

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
