// The light of hits in lanes equals that of shading each surface.

#include "alhazen/renderers/direct_light/lit_batch.h"

#include <gtest/gtest.h>

#include <vector>

#include "alhazen/sampling/random.h"
#include "alhazen/simd/targets.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

/// Shades random rays around the origin by a batch and one by one. Returns the hits taken of each
/// material.
std::vector<int> check(const Scene& scene, int rays = 600) {
    std::vector<int> taken(scene.materials.size());
    const std::vector<Rgb> ambient = ambient_terms(scene.lights);
    LitBatch batch(scene, ambient);
    RandomStream random(7);
    const auto number = [&] { return random.uniform(-1, 1); };
    constexpr std::size_t kRays = 50;
    for (int i = 0; i < rays && !::testing::Test::HasFailure(); i += kRays) {
        std::vector<Ray> cast(kRays);
        std::vector<Rgb> radiance(kRays, Rgb{0.5, 0.25, 0.125}), expected = radiance;
        for (std::size_t k = 0; k < kRays; ++k) {
            const Vec3 origin{6 * number(), 6 * number(), 6 * number()};
            cast[k] = {origin, normalize(Vec3{number(), number(), number()} - origin)};
            Hit hit;
            if (!scene.aggregate->closest(cast[k], hit, nullptr)) continue;
            if (!batch.take(k, cast[k], hit, radiance)) continue;
            ShadingPoint point;
            set_shading_point(scene, cast[k], hit, {}, {}, point);
            EXPECT_EQ(point.material->coverage, 1.0);
            ++taken[static_cast<std::size_t>(point.surface.materials[0])];
            expected[k] += unhindered_light(scene, ambient, point);
        }
        batch.finish(radiance);
        for (std::size_t k = 0; k < kRays; ++k) EXPECT_EQ(radiance[k], expected[k]) << k;
    }
    return taken;
}

Material matt(const Rgb& color) {
    Material m;
    m.diffuse.color = color;
    m.emission.color = {0.1, 0.02, 0.3};
    m.ambient.color = {0.4, 0.5, 0.6};
    return m;
}
Material shiny(double exponent) {
    Material m = matt({0.3, 0.4, 0.5});
    m.specular.color = {0.9, 0.8, 0.7};
    m.shininess.value = exponent;
    return m;
}

void add_lights(SceneMaker& maker) {
    maker.light(AmbientLight{{0.3, 0.2, 0.1}});
    maker.light(PointLight{.position = {3, 4, 5}, .ambient = {0.1, 0.1, 0.1}});
    maker.light(PointLight{
        .position = {-5, 1, 2}, .color = {3, 2, 1}, .attenuation = {0.1, 0.2, 0.3}, .range = 7});
    maker.light(DirectionalLight{.to_light = {1, -2, 3}, .color = {0.2, 0.3, 0.4}});
    maker.light(SpotLight{.position = {0, -4, 0}, .direction = {0, 1, 0}});
}

Torus torus() {
    return {.center = {0.1, 0.2, -0.3}, .axis = {1, 2, 3}, .major_radius = 1, .minor_radius = 0.4};
}
Algebraic quartic() {
    return {.expression = "x^4 + y^4 + z^4 - 1.5*(x^2 + y^2 + z^2) + 0.3*x*y*z + 0.9"};
}
Blob blob() {
    return {.components = {{.base = {0.2, 0, 0}, .radius = 1.2},
                           {.base = {-0.5, 0.4, 0.3}, .radius = 0.9},
                           {.base = {0, -0.6, 0.1}, .radius = 1, .strength = -0.3}},
            .threshold = 0.3};
}

template <class F>
void for_each_target(F&& f) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        SCOPED_TRACE(target);
        f();
    }
}

TEST(LitBatch, OfShapesIsThatOfEachSurface) {
    for_each_target([] {
        SceneMaker maker;
        add_lights(maker);
        const Affine turned = Affine::translate({0.3, 1, 2}) * Affine::rotate({1, 2, 3}, 0.7) *
                              Affine::scale({0.5, -0.8, 1.2});
        for (const Affine& place : {Affine::translate({-1, -1, -1}), turned}) {
            maker.add(torus(), maker.material(matt({1, 0.5, 0.2})), place);
            maker.add(quartic(), maker.material(shiny(20)), place);
            maker.add(blob(), maker.material(matt({0.3, 0.4, 0.5})), place);
            maker.add(Sphere{{1, 0, 0}, 0.7}, maker.material(shiny(3)), place);
            maker.add(Cylinder{.base = {0, 2, 0}, .top = {1, 3, 1}, .radius = 0.6},
                      maker.material(matt({1, 1, 1})), place);
            maker.add(Cone{.base = {0, -2, 0}, .top = {1, -3, 1}, .base_radius = 0.6},
                      maker.material(shiny(1e4)), place);
        }
        for (const int count : check(maker.compile(), 6000)) EXPECT_GT(count, 5);
    });
}

TEST(LitBatch, OfHighlightsFollowsTheConventions) {
    using Highlight = ShadingConventions::Highlight;
    for (const Highlight highlight : {Highlight::Phong, Highlight::Schlick}) {
        SceneMaker maker;
        add_lights(maker);
        maker.description().conventions.shading.highlight = highlight;
        maker.description().conventions.shading.clamp_attenuation = false;
        maker.add(torus(), maker.material(shiny(8)));
        EXPECT_GT(check(maker.compile())[0], 50);
    }
}

TEST(LitBatch, OfSolidsAndInstancesIsThatOfEachSurface) {
    for_each_target([] {
        SceneMaker maker;
        add_lights(maker);
        const MaterialId skin = maker.material(matt({1, 0, 0.5}));
        const MaterialId hole = maker.material(shiny(5));
        const ObjectIndex object = maker.object("drilled");
        maker.description().objects[static_cast<std::size_t>(object)].combine = Combine::Difference;
        maker.add(Sphere{{0, 0, 0}, 1}, skin, {}, object);
        maker.add(Cylinder{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = 0.6}, hole, {}, object);
        maker.add(object);
        maker.add(object, {}, Affine::translate({1, 2, 1}) * Affine::rotate({0, 1, 2}, 1.1));
        const std::vector<int> taken = check(maker.compile("wide_bvh"), 1500);
        EXPECT_GT(taken[0], 100);
        EXPECT_GT(taken[1], 20);
    });
}

TEST(LitBatch, LeavesOtherMaterialsAndMediaToTheCaller) {
    SceneMaker maker;
    add_lights(maker);
    Material glass = matt({0.1, 0.2, 0.3}), single = glass, thin = glass;
    glass.transmissive.color = {0.5, 0.5, 0.5};
    single.double_sided = false;
    thin.alpha_mode = AlphaMode::Blend;
    thin.alpha.value = 0.5;
    maker.add(Sphere{{1, 0, 0}, 0.5}, maker.material(glass));
    maker.add(Sphere{{0, 1, 0}, 0.5}, maker.material(single));
    maker.add(Sphere{{0, -1, 0}, 0.5}, maker.material(thin));
    const MaterialId last = maker.material(matt({1, 1, 1}));
    maker.add(maker.mesh(testing::tetrahedron()), last);
    const ObjectIndex object = maker.object("cut");
    ObjectDescription& o = maker.description().objects[static_cast<std::size_t>(object)];
    o.combine = Combine::Difference;
    o.cut_material = CutMaterial::Minuend;
    maker.add(Sphere{{0, 0, 2}, 1}, last, {}, object);
    maker.add(Sphere{{0, 0, 3}, 1}, last, {}, object);
    maker.add(object);
    EXPECT_EQ(check(maker.compile()), (std::vector<int>{0, 0, 0, 0}));
    maker.add(Sphere{{-1, 0, 0}, 0.5}, last);
    EXPECT_GT(check(maker.compile())[3], 10);
    // Ambient light from the eye depends on the direction.
    maker.description().conventions.shading.ambient_from_eye = true;
    EXPECT_EQ(check(maker.compile())[3], 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
