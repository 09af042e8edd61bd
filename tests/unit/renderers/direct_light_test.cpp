// The light of many points in lanes equals that of one shadow ray after the other.

#include "alhazen/renderers/direct_light/direct_light.h"

#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "alhazen/sampling/random.h"
#include "alhazen/simd/targets.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

/// The light at a point and its shadow rays, one after the other.
Rgb light_at(const Scene& scene, const ShadingPoint& point, RayCount& count) {
    const ShadingConventions& conventions = scene.conventions.shading;
    Rgb sum;
    for (const Light& light : scene.lights) {
        if (!illuminates(light)) continue;
        const LightSample l = sample(light, point.surface.point, conventions.clamp_attenuation);
        const double cosine = dot(point.normal, l.to_light);
        if (!(cosine > 0.0) || l.intensity.is_black()) continue;
        const Ray ray = onward_ray(conventions, point.surface, l.to_light, l.distance);
        ++count.cast;
        if (scene.aggregate->occluded(ray, {nullptr, mask_of(RayKind::Shadow)})) {
            ++count.hit;
        } else {
            sum += l.intensity * reflected_fraction(conventions, point, l, cosine);
        }
    }
    return sum;
}

/// Compares random points of the scene, in batches of different sizes. Returns the number of points
/// that have light.
int check(const Scene& scene, std::size_t points) {
    EXPECT_TRUE(DirectLight::covers(scene));
    RayCounters counters;
    RayCount expected_count;
    DirectLight direct(scene, counters, nullptr);
    RandomStream random(7);
    const auto number = [&] { return random.uniform(-1, 1); };
    int lit = 0;
    for (const std::size_t size : {std::size_t{1}, std::size_t{37}, points}) {
        std::deque<ShadingPoint> met;
        std::vector<Rgb> expected;
        while (met.size() < size) {
            const Vec3 origin{6 * number(), 6 * number(), 6 * number()};
            const Ray ray{origin, normalize(Vec3{number(), number(), number()} - origin)};
            Hit hit;
            if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
            set_shading_point(scene, ray, hit, {}, {}, met.emplace_back());
            expected.push_back(light_at(scene, met.back(), expected_count));
        }
        std::vector<Rgb> found(size);
        for (std::size_t i = 0; i < size; ++i) direct.add(met[i], found[i]);
        direct.finish();
        for (std::size_t i = 0; i < size; ++i) {
            EXPECT_EQ(found[i], expected[i]) << i << " of " << size;
            lit += !found[i].is_black();
        }
    }
    EXPECT_EQ(counters[RayKind::Shadow].cast, expected_count.cast);
    EXPECT_EQ(counters[RayKind::Shadow].hit, expected_count.hit);
    return lit;
}

Material shiny(const Rgb& diffuse, double exponent) {
    Material m;
    m.diffuse.color = diffuse;
    m.specular.color = {0.9, 0.8, 0.7};
    m.shininess.value = exponent;
    return m;
}

/// Lights of all kinds and matt and shining bodies that shade each other.
void furnish(SceneMaker& maker) {
    maker.light(AmbientLight{{0.3, 0.2, 0.1}});
    maker.light(PointLight{.position = {3, 4, 5}, .ambient = {0.1, 0.1, 0.1}});
    maker.light(PointLight{
        .position = {-5, 1, 2}, .color = {3, 2, 1}, .attenuation = {0.1, 0.2, 0.3}, .range = 7});
    maker.light(PointLight{.position = {0.5, 0.5, 0.5}, .glints = false});
    maker.light(DirectionalLight{.to_light = {1, -2, 3}, .color = {0.2, 0.3, 0.4}});
    maker.light(SpotLight{.position = {0, -4, 0}, .direction = {0, 1, 0}});
    Material matt;
    matt.diffuse.color = {0.3, 0.6, 0.9};
    for (int i = 0; i < 40; ++i) {
        const Vec3 center{double(i % 4) - 1.5, double(i / 4 % 4) - 1.5, double(i / 16) - 1.5};
        const Material own = i % 3 == 0 ? matt : shiny({0.1 * (i % 5), 0.4, 0.2}, 1.0 + i);
        maker.add(Sphere{center, 0.4}, maker.material(own));
    }
    maker.add(maker.mesh(testing::tetrahedron()), maker.material(shiny({1, 1, 1}, 500)));
}

TEST(DirectLight, IsThatOfOneShadowRayAfterTheOther) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        SCOPED_TRACE(target);
        SceneMaker maker;
        furnish(maker);
        EXPECT_GT(check(maker.compile(), 700), 100);
    }
}

TEST(DirectLight, FollowsTheConventions) {
    using Highlight = ShadingConventions::Highlight;
    for (const Highlight highlight : {Highlight::Phong, Highlight::Schlick}) {
        SceneMaker maker;
        furnish(maker);
        ShadingConventions& conventions = maker.description().conventions.shading;
        conventions.highlight = highlight;
        conventions.clamp_attenuation = !conventions.clamp_attenuation;
        conventions.min_distance = 0.5;
        EXPECT_GT(check(maker.compile(), 300), 50);
    }
}

TEST(DirectLight, OfTransparentMaterialsThatBlockLight) {
    using ShadowTint = ShadingConventions::ShadowTint;
    SceneMaker maker;
    furnish(maker);
    Material glass = shiny({0.2, 0.2, 0.2}, 30);
    glass.transmissive.color = {0.5, 0.6, 0.7};
    maker.add(Sphere{{0, 0, 2.5}, 1}, maker.material(glass));
    EXPECT_FALSE(DirectLight::covers(maker.compile()));
    maker.description().conventions.shading.shadow_tint = ShadowTint::Opaque;
    EXPECT_GT(check(maker.compile(), 300), 50);
    maker.description().conventions.shading.shadow_tint = ShadowTint::None;
    EXPECT_FALSE(DirectLight::covers(maker.compile()));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
