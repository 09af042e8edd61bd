#include <gtest/gtest.h>

#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::center;
using testing::expect_near;
using testing::SceneMaker;
using RefractionTint = ShadingConventions::RefractionTint;
using ShadowTint = ShadingConventions::ShadowTint;

const Rgb kGlass{0.9, 0.95, 0.8};
const Rgb kWine{0.6, 0.1, 0.2};

MaterialId clear(SceneMaker& maker, const Rgb& kt) {
    Material m;
    m.transmissive.color = kt;
    m.index.value = 1.0;
    return maker.material(m);
}

/// Glass from z = 0 to 1 and from 3 to 3.5, wine from 1 to 3, in one solid; the medium named first
/// has priority in the overlap.
void add_tank(SceneMaker& maker, bool wine_first, const Affine& placement = {}) {
    const MaterialId glass = clear(maker, kGlass), wine = clear(maker, kWine);
    const ObjectIndex tank = maker.object("tank");
    maker.description().objects.back().combine = Combine::Union;
    if (wine_first) maker.add(BoxShape{{-4, -4, 1}, {4, 4, 3}}, wine, {}, tank);
    maker.add(BoxShape{{-4, -4, 0}, {4, 4, 1}}, glass, {}, tank);
    maker.add(BoxShape{{-4, -4, 3}, {4, 4, 3.5}}, glass, {}, tank);
    if (!wine_first) maker.add(BoxShape{{-4, -4, 0.5}, {4, 4, 3.2}}, wine, {}, tank);
    maker.add(tank, MaterialId{0}, placement);
}

/// Transmittance of the whole tank: by distances, or by its six surfaces, of which each wall counts
/// as one of either medium.
Rgb by_distance() {
    return power(kGlass, 1.5) * power(kWine, 2.0);
}
Rgb by_surface() {
    return power(kGlass, 4.0) * power(kWine, 2.0);
}

TEST(Media, EachTintsTheWayThroughIt) {
    for (const bool wine_first : {false, true}) {
        for (const auto tint : {RefractionTint::PerDistance, RefractionTint::PerEvent}) {
            SceneMaker maker;
            maker.description().picture.background = Rgb{1, 1, 1};
            maker.description().conventions.shading.refraction_tint = tint;
            add_tank(maker, wine_first);
            expect_near(center(maker.compile()),
                        tint == RefractionTint::PerDistance ? by_distance() : by_surface(), 1e-9);
        }
    }
}

TEST(Media, EachTintsTheLightThatReachesWhatLiesBehind) {
    for (const bool wine_first : {false, true}) {
        for (const auto tint : {ShadowTint::PerDistance, ShadowTint::PerCrossing}) {
            for (const double least : {0.0, 1e-6, 0.1}) {
                SceneMaker maker;
                Material white;
                white.diffuse.color = {1, 1, 1};
                maker.add(Rectangle{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, maker.material(white));
                maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
                maker.description().conventions.shading.shadow_tint = tint;
                maker.description().conventions.shading.min_distance = least;
                add_tank(maker, wine_first, Affine::translate({0, 0, 10}));  // above the camera
                expect_near(center(maker.compile()),
                            tint == ShadowTint::PerDistance ? by_distance() : by_surface(), 1e-9);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
