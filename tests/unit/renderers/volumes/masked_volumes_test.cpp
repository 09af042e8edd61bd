// Volumes whose parts only some kinds of rays see.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/renderers/volumes/media_finder.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

constexpr RayMask kEye = mask_of(RayKind::Eye), kShadow = mask_of(RayKind::Shadow);
const std::string kRenderers[] = {"whitted",
                                  "distributed",
                                  "path_tracing",
                                  "bidirectional",
                                  "light_tracing",
                                  "photon_mapping:photons=10,caustics=0",
                                  "sppm:photons=10,radius=0.1",
                                  "vcm:photons=10,radius=0.1,pilot=off"};

/// A wide box, of index 1, that absorbs half of the red light on a unit of length.
void add_absorber(SceneMaker& maker, double bottom, double top, RayMask mask) {
    Material m;
    m.index.value = 1;
    m.dielectric = Dielectric{{std::log(2.0), 0, 0}};
    maker.add(BoxShape{{-20, -20, bottom}, {20, 20, top}}, maker.material(m));
    maker.description().objects[0].parts.back().visible_to = mask;
}

/// Few of its paths end in the picture, which is wider then.
bool is_of_light(const std::string& renderer) {
    return renderer == "light_tracing";
}

/// Red over green light: what the volumes let through.
double passes(SceneMaker& maker, const std::string& renderer, double eye) {
    maker.description().conventions.shading.optics = {true, true};
    maker.description().cameras[0].camera = look_along({0.013, 0.007, eye}, {0, 0, -1}, {0, 1, 0},
                                                       is_of_light(renderer) ? 0.1 : 0.01, 1.0);
    const Rgb mean =
        mean_of(picture_of(maker.compile(), renderer, 2, is_of_light(renderer) ? 1 << 13 : 4));
    EXPECT_GT(mean.g, 0.0) << renderer;
    return mean.r / mean.g;
}

TEST(MaskedVolumes, AnEyeIsInNoVolumeThatEyeRaysDoNotSee) {
    for (const RayMask mask : {kShadow, kRaysOfAllKinds & ~kEye}) {
        for (const double bottom : {2.0, -3.0}) {
            for (const std::string& renderer : kRenderers) {
                SceneMaker maker;
                maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}),
                          maker.material(shining({1, 1, 1})));
                add_absorber(maker, bottom, 4, mask);
                EXPECT_NEAR(passes(maker, renderer, 3), 1, 1e-9) << renderer << mask << bottom;
            }
        }
    }
}

/// The floor is at z = -2, the light above it.
TEST(MaskedVolumes, LightIsInNoVolumeThatShadowRaysDoNotSee) {
    struct {
        double bottom, top, eye, light, passed;
    } const cases[] = {
        {-3, -1, 3, 4, 0.5},                // around the floor
        {-3, 5, 6, 4, 1.0 / 128},           // around the floor and the light
        {3, 5, 2, 4, 1},                    // around the light
        {-3, -1, -1.5, 4, std::sqrt(0.5)},  // around the floor and the eye
    };
    for (const auto& c : cases) {
        for (const RayMask mask : {kEye, kRaysOfAllKinds & ~kShadow}) {
            for (const std::string& renderer : kRenderers) {
                if (is_of_light(renderer) && c.eye < 0) continue;
                SceneMaker maker;
                maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}),
                          maker.material(matt({0.5, 0.5, 0.5})));
                add_absorber(maker, c.bottom, c.top, mask);
                maker.light(PointLight{
                    .position = {0, 0, c.light}, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
                EXPECT_NEAR(passes(maker, renderer, c.eye), c.passed,
                            is_of_light(renderer) ? 2e-3 : 1e-4)
                    << renderer << mask << c.bottom << c.top;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
