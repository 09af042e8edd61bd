// The cached colour equals that of shading the surface, and exists only for surfaces of one colour.

#include "alhazen/renderers/core/unlit_cache.h"

#include <gtest/gtest.h>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/sampling/random.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::glowing;
using testing::SceneMaker;

/// Expects for random rays around the origin that the cached colour is that of the surface, and
/// exists exactly for the materials marked in `flat` by index. Returns the number of such hits.
int check(const Scene& scene, const std::vector<bool>& flat) {
    const std::vector<Rgb> ambient = ambient_terms(scene.lights);
    UnlitCache cache(scene, ambient);
    RandomStream random(7);
    const auto number = [&] { return random.uniform(-1, 1); };
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 origin{6 * number(), 6 * number(), 6 * number()};
        const Ray ray{origin, normalize(Vec3{number(), number(), number()} - origin)};
        Hit hit;
        if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
        ShadingPoint point;
        set_shading_point(scene, ray, hit, {}, {}, point);
        const Rgb* look = cache.find(hit);
        const auto material = static_cast<std::size_t>(point.surface.materials[0]);
        EXPECT_EQ(look != nullptr, flat[material]) << "material " << material;
        if (look == nullptr) continue;
        ++found;
        EXPECT_EQ(*look, unshadowed_terms(scene.conventions.shading, ambient, point));
        EXPECT_EQ(point.material->coverage, 1.0);
        if (::testing::Test::HasFailure()) break;
    }
    return found;
}

TEST(UnlitCache, OfLightsOfTheirOwnAreTheirColour) {
    SceneMaker maker;
    Material glass = glowing({0.1, 0.2, 0.3}), single = glass, thin = glass, dull;
    glass.transmissive.color = {0.5, 0.5, 0.5};
    single.double_sided = false;
    thin.alpha_mode = AlphaMode::Blend;
    thin.alpha.value = 0.5;
    dull.diffuse.color = {0.4, 0.5, 0.6};
    dull.ambient.color = {0.7, 0.8, 0.9};
    maker.add(Sphere{{1, 0, 0}, 0.5}, maker.material(glowing({1, 2, 3})));
    maker.add(Sphere{{-1, 0, 0}, 0.5}, maker.material(glass));
    maker.add(Sphere{{0, 1, 0}, 0.5}, maker.material(single));
    maker.add(Sphere{{0, -1, 0}, 0.5}, maker.material(thin));
    maker.add(Sphere{{0, 0, 1}, 0.5}, maker.material(dull));
    maker.light(AmbientLight{{0.3, 0.2, 0.1}});
    EXPECT_GT(check(maker.compile(), {true, false, false, false, true}), 100);
    // A matt surface shows no other light.
    maker.light(PointLight{.position = {3, 4, 5}});
    EXPECT_GT(check(maker.compile(), {true, false, false, false, false}), 100);
}

TEST(UnlitCache, OfMeshesWithColoursAreNone) {
    SceneMaker maker;
    const MaterialId glow = maker.material(glowing({1, 2, 3}));
    TriangleMesh plain = testing::tetrahedron(), coloured = plain;
    coloured.colors.assign(coloured.positions.size(), {1, 0, 0, 1});
    maker.add(maker.mesh(plain), glow, Affine::translate({2, 0, 0}));
    const MaterialId other = maker.material(glowing({1, 2, 3}));
    maker.add(maker.mesh(coloured), other, Affine::translate({-2, 0, 0}));
    EXPECT_GT(check(maker.compile(), {true, false}), 50);
}

TEST(UnlitCache, OfSolidsAreThoseOfTheLeafUnlessTheMinuendIsShown) {
    for (const CutMaterial cut : {CutMaterial::Own, CutMaterial::Minuend}) {
        SceneMaker maker;
        const MaterialId skin = maker.material(glowing({1, 0, 0}));
        const MaterialId hole = maker.material(glowing({0, 1, 0}));
        const ObjectIndex object = maker.object("drilled");
        ObjectDescription& o = maker.description().objects[static_cast<std::size_t>(object)];
        o.combine = Combine::Difference;
        o.cut_material = cut;
        maker.add(Sphere{{0, 0, 0}, 1}, skin, {}, object);
        maker.add(Cylinder{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = 0.6}, hole, {}, object);
        maker.add(object);
        const bool own = cut == CutMaterial::Own;
        const int found = check(maker.compile(), {own, own});
        EXPECT_EQ(found > 100, own);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
