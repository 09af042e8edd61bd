#include "alhazen/explain/tree/ray_tree.h"

#include <gtest/gtest.h>

#include <string>

#include "alhazen/base/error.h"
#include "alhazen/explain/explanation.h"
#include "alhazen/explain/page/explanation_json.h"
#include "alhazen/laboratory/traversal_trace.h"
#include "alhazen/renderers/core/local_shading.h"
#include "support/scene_maker.h"
#include "support/test_data.h"
#include "unit/laboratory/small_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using testing::small_scene;

LoadedScene loaded_of(SceneDescription description) {
    LoadedScene loaded;
    loaded.description = std::move(description);
    loaded.scene = compile(loaded.description);
    return loaded;
}
LoadedScene loaded_file(const std::string& name) {
    return load(testing::source_folder() / "scenes" / name);
}

/// The radiance of every ray of the tree is that of its terms.
void expect_sums(const RayNode& ray, const Rgb& background, int& rays) {
    ++rays;
    EXPECT_EQ(radiance_of(ray, background), ray.radiance);
    for (const SurfaceNode& surface : ray.surfaces) {
        Rgb direct;
        for (const LightTerm& light : surface.lights) {
            if (light.blocked()) continue;
            direct += light.through * light.intensity * (light.diffuse + light.highlight);
        }
        EXPECT_EQ(direct, surface.direct);
        for (const RayNode& child : surface.reflected) expect_sums(child, background, rays);
        for (const RayNode& child : surface.refracted) expect_sums(child, background, rays);
    }
}

/// Explains pixels of a small picture; the sums and the picture of the renderer agree bit for bit.
void expect_pixels_of_whitted(const LoadedScene& loaded, int samples = 1) {
    ExplainOptions options;
    options.render.width = 20;
    options.render.height = 15;
    options.render.samples_per_pixel = samples;
    options.accelerator = "";
    options.with_picture = false;
    const RenderResult picture = render(loaded, options.render);
    int rays = 0, children = 0;
    for (int y = 1; y < 15; y += 3) {
        for (int x = 1; x < 20; x += 3) {
            options.x = x;
            options.y = y;
            const Explanation e = explain_pixel(loaded, options);
            EXPECT_EQ(e.pixel, picture.film.at(x, y)) << x << "," << y;
            const int before = rays;
            expect_sums(e.tree, e.background, rays);
            children += rays - before - 1;
        }
    }
    EXPECT_EQ(picture.film.crop().area(), 300u);
    EXPECT_GT(children, 0) << "the scene has no mirror and no glass in view";
}

TEST(RayTree, TermsOfEveryRaySumToThePixelOfWhitted) {
    expect_pixels_of_whitted(loaded_of(small_scene()));
}
TEST(RayTree, TermsSumToThePixelInTheScenesOfTheRepository) {
    for (const char* name : {"showcase.alhazen", "cornell.alhazen", "glass_of_wine.alhazen",
                             "solids.alhazen", "lens_stack.alhazen"}) {
        SCOPED_TRACE(name);
        expect_pixels_of_whitted(loaded_file(name));
    }
}
/// The recorder's shadow rays start in the media of the estimator's rays.
TEST(RayTree, TermsSumToThePixelInNestedBodiesWhereKtActsByDistance) {
    SceneMaker maker;
    ShadingConventions& c = maker.description().conventions.shading;
    c.refraction_tint = ShadingConventions::RefractionTint::PerDistance;
    c.shadow_tint = ShadingConventions::ShadowTint::PerDistance;
    Material outer, inner, matt;
    outer.transmissive.color = {0.5, 0.8, 0.9};
    outer.diffuse.color = {0.1, 0.1, 0.1};
    inner.transmissive.color = {0.9, 0.6, 0.7};
    matt.diffuse.color = {0.7, 0.6, 0.5};
    maker.add(Sphere{.center = {0, 0, 0}, .radius = 1.2}, maker.material(outer));
    maker.add(Sphere{.center = {0.2, 0, 0.3}, .radius = 0.6}, maker.material(inner));
    maker.add(Sphere{.center = {0.2, 0.1, 0.2}, .radius = 0.3}, maker.material(matt));
    maker.light(PointLight{.position = {3, 2, 4}, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
    maker.light(
        PointLight{.position = {-0.5, 0, 0.6}, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
    expect_pixels_of_whitted(loaded_of(std::move(maker.description())));
}
TEST(RayTree, SeveralSamplesHaveTheMeanOfThePixel) {
    expect_pixels_of_whitted(loaded_of(small_scene()), 5);
}

TEST(RayTree, OfTooManyRaysIsThatOfTheLargestDepthWithFewer) {
    const LoadedScene loaded = loaded_file("showcase.alhazen");
    ExplainOptions options;
    options.render.width = 60;
    options.render.height = 34;
    options.x = 29;
    options.y = 25;
    options.accelerator = "";
    options.with_picture = false;
    const auto rays = [](const Explanation& e) {
        const RayCensus census = census_of(e.tree);
        return census.eye + census.shadow + census.reflection + census.refraction;
    };
    const Explanation whole = explain_pixel(loaded, options);
    ASSERT_EQ(whole.max_depth, whole.wished_depth);
    options.most_rays = rays(whole) - 1;
    const Explanation cut = explain_pixel(loaded, options);
    ASSERT_LT(cut.max_depth, whole.max_depth);
    EXPECT_LE(rays(cut), options.most_rays);
    options.most_rays = rays(whole);
    EXPECT_EQ(explain_pixel(loaded, options).pixel, whole.pixel);
    options.render.max_depth = cut.max_depth;
    EXPECT_EQ(explain_pixel(loaded, options).pixel, cut.pixel);
    options.render.max_depth = cut.max_depth + 1;
    EXPECT_GE(rays(explain_pixel(loaded, options)), rays(whole));
}

TEST(RayTree, OfAnExplanationThatIsStoppedIsNotComplete) {
    StopFlag stop;
    stop.request();
    ExplainOptions options;
    options.render.width = 20;
    options.render.height = 15;
    options.render.stop = &stop;
    EXPECT_FALSE(explain_pixel(loaded_of(small_scene()), options).complete);
}

/// Two facing mirrors and a light: the tree is a chain whose every number is known.
TEST(RayTree, BetweenTwoMirrorsIsAChainOfKnownNumbers) {
    SceneMaker scene;
    Material mirror;
    mirror.diffuse.color = {0, 0, 0};
    mirror.reflective.color = {0.5, 0.5, 0.5};
    mirror.emission.color = {0.25, 0, 0};
    scene.material(mirror);
    scene.add(Plane{.point = {0, 0, -3}, .normal = {0, 0, 1}});
    scene.add(Plane{.point = {0, 0, 9}, .normal = {0, 0, -1}});
    scene.description().conventions.shading.max_depth = 3;
    scene.description().conventions.shading.min_contribution = 0;
    ExplainOptions options;
    options.render.width = options.render.height = 1;
    options.accelerator = "";
    options.with_picture = false;
    const Explanation e = explain_pixel(loaded_of(scene.description()), options);
    const RayNode* ray = &e.tree;
    const double t[] = {8, 12, 12, 12};                   // the eye is at z = 5
    const double red[] = {0.46875, 0.4375, 0.375, 0.25};  // 1/4 (1 + 1/2 + ...)
    for (int depth = 0; depth <= 3; ++depth) {
        SCOPED_TRACE(depth);
        EXPECT_EQ(ray->depth, depth);
        EXPECT_EQ(ray->kind, depth == 0 ? RayKind::Eye : RayKind::Reflection);
        ASSERT_EQ(ray->surfaces.size(), 1u);
        const SurfaceNode& surface = ray->surfaces.front();
        EXPECT_NEAR(surface.t, t[depth], 1e-9);
        EXPECT_EQ(ray->radiance, (Rgb{red[depth], 0, 0}));
        EXPECT_EQ(surface.no_refracted, NotSent::NoCoefficient);
        EXPECT_EQ(surface.no_reflected, depth < 3 ? NotSent::Sent : NotSent::Deepest);
        ASSERT_EQ(surface.reflected.size(), depth < 3 ? 1u : 0u);
        if (depth < 3) ray = &surface.reflected.front();
    }
}

TEST(RayTree, TellsWhatBlocksALightAndWhatTintsIt) {
    SceneMaker scene;
    Material matt, glass;
    matt.diffuse.color = {0.5, 0.5, 0.5};
    glass.diffuse.color = {0, 0, 0};
    glass.transmissive.color = {0.5, 1, 1};
    const MaterialId matt_id = scene.material(matt), glass_id = scene.material(glass);
    scene.light(PointLight{.position = {0, 4, 0}, .color = {1, 1, 1}});
    scene.light(PointLight{.position = {4, 0, 3}, .color = {1, 1, 1}});
    scene.add(Plane{.point = {0, 0, -1}, .normal = {0, 0, 1}}, matt_id);
    scene.add(Sphere{{0, 2, -0.5}, 0.3}, matt_id);                      // before the first
    scene.add(Rectangle{{2, -1, -1}, {0, 2, 0}, {0, 0, 6}}, glass_id);  // before the second
    scene.description().conventions.shading.shadow_tint =
        ShadingConventions::ShadowTint::PerCrossing;
    ExplainOptions options;
    options.render.width = options.render.height = 1;
    options.accelerator = "";
    options.with_picture = false;
    const Explanation e = explain_pixel(loaded_of(scene.description()), options);
    ASSERT_EQ(e.tree.surfaces.size(), 1u);
    const SurfaceNode& surface = e.tree.surfaces.front();
    ASSERT_EQ(surface.lights.size(), 2u);
    EXPECT_TRUE(surface.lights[0].blocked());
    ASSERT_FALSE(surface.lights[0].crossings.empty());
    EXPECT_EQ(e.part_names[surface.lights[0].crossings[0].part], "sphere");
    EXPECT_EQ(surface.lights[1].through, (Rgb{0.5, 1, 1}));
    ASSERT_EQ(surface.lights[1].crossings.size(), 1u);
    EXPECT_EQ(e.part_names[surface.lights[1].crossings[0].part], "rectangle");
    EXPECT_NEAR(surface.lights[1].cosine, 4.0 / std::sqrt(32.0), 1e-12);
    const RayCensus census = census_of(e.tree);
    EXPECT_EQ(census.eye, 1u);
    EXPECT_EQ(census.shadow, 2u);
}

/// A wall behind more surfaces that cover in part than a ray may pass.
SceneDescription many_veils(double coverage, int count) {
    SceneMaker scene;
    Material veil, wall;
    veil.alpha.value = coverage;
    veil.alpha_mode = AlphaMode::Blend;
    veil.emission.color = wall.emission.color = {1, 1, 1};
    const MaterialId veil_id = scene.material(veil), wall_id = scene.material(wall);
    for (int i = 0; i < count; ++i) {
        scene.add(Rectangle{{-9, -9, -0.001 * i}, {18, 0, 0}, {0, 18, 0}}, veil_id);
    }
    scene.add(Plane{.point = {0, 0, -6}, .normal = {0, 0, 1}}, wall_id);
    return scene.description();
}

TEST(RayTree, SaysThatARayHasPassedTheMostSurfaces) {
    ExplainOptions options;
    options.render.width = options.render.height = 1;
    options.accelerator = "";
    options.with_picture = false;
    for (const int count : {10, kMaxPassedSurfaces, kMaxPassedSurfaces + 10}) {
        SCOPED_TRACE(count);
        const LoadedScene loaded = loaded_of(many_veils(1e-4, count));
        options.render.renderer = "whitted";
        const RayNode tree = explain_pixel(loaded, options).tree;
        const bool ends = count >= kMaxPassedSurfaces;
        EXPECT_EQ(tree.given_up, ends);
        EXPECT_FALSE(tree.escaped);
        EXPECT_EQ(tree.surfaces.size(), std::size_t(ends ? kMaxPassedSurfaces : count + 1));
        const double left = ends ? std::pow(1 - 1e-4, kMaxPassedSurfaces) : 0.0;
        EXPECT_NEAR(tree.left.g, left, 1e-9);
    }
    // A path passes a surface or ends there at random; nearly none ends at these.
    for (const int count : {10, kMaxPassedSurfaces + 10}) {
        SCOPED_TRACE(count);
        options.render.renderer = "path_tracing";
        const Explanation e = explain_pixel(loaded_of(many_veils(1e-9, count)), options);
        ASSERT_TRUE(e.path);
        const bool ends = count > kMaxPassedSurfaces;
        EXPECT_EQ(e.path->vertices.size(), std::size_t(ends ? kMaxPassedSurfaces : count + 1));
        EXPECT_EQ(e.path->vertices.front().step, PathStep::Straight);
        EXPECT_EQ(e.path->vertices.back().step, ends ? PathStep::PassedMost : PathStep::Absorbed);
    }
}

TEST(RayTree, SurfacesBehindVeilsCountTFromTheOriginOfTheRay) {
    ExplainOptions options;
    options.render.width = options.render.height = 3;
    options.accelerator = "";
    options.with_picture = false;
    const RayNode tree = explain_pixel(loaded_of(many_veils(0.3, 4)), options).tree;
    ASSERT_EQ(tree.surfaces.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        const SurfaceNode& surface = tree.surfaces[i];
        const Vec3 at = tree.ray.origin + surface.t * tree.ray.direction;
        EXPECT_LT(length(at - surface.point), 1e-9) << i;
        EXPECT_NEAR(at.z, i < 4 ? -0.001 * static_cast<double>(i) : -6.0, 1e-9);
    }
}

TEST(RayTree, ConesAreNamedByTheirLights) {
    SceneMaker scene;
    scene.light(PointLight{.position = {-4, 0, 4}, .color = {1, 1, 1}});
    scene.light(AmbientLight{{0.1, 0.1, 0.1}});
    scene.light(PointLight{.position = {-5, 0, 4}, .color = {1, 1, 1}});
    scene.description().lights[0].name = "lamp";
    scene.description().lights[2].name = "window";
    Material matt;
    matt.diffuse.color = {0.5, 0.5, 0.5};
    scene.material(matt);
    // Seen at a small angle: a long piece, which is queried in parts.
    scene.add(Rectangle{{-2, -9, -18}, {4, 0, 36}, {0, 18, 0}});
    ExplainOptions options;
    options.render.width = options.render.height = 1;
    options.render.renderer = "cone_tracing";
    options.accelerator = "";
    options.with_picture = false;
    const Explanation e = explain_pixel(loaded_of(scene.description()), options);
    ASSERT_TRUE(e.cones && e.cones->unavailable.empty());
    ASSERT_EQ(e.cones->tree.parts.size(), 1u);
    double weights[3] = {0, 0, 0};
    int counts[3] = {0, 0, 0};
    for (const ConeNode& cone : e.cones->tree.parts.front().cones) {
        ASSERT_EQ(cone.kind, RayKind::Shadow);
        EXPECT_EQ(cone.to.part, counts[cone.to.light]++);
        weights[cone.to.light] += cone.to.weight;
    }
    for (const std::size_t light : {0u, 2u}) {
        EXPECT_GT(counts[light], 1);
        EXPECT_NEAR(weights[light], 1.0, 1e-12);
    }
    EXPECT_EQ(counts[1], 0);
    const std::string json = explanation_json(e, 0);
    EXPECT_NE(json.find("\"light\": \"lamp\""), std::string::npos) << json;
    EXPECT_NE(json.find("\"light\": \"window\""), std::string::npos);
}

TEST(RayTree, StepsAndWorkAgreeForEveryTraceableAccelerator) {
    const LoadedScene loaded = loaded_of(small_scene());
    std::string names = traceable_accelerators() + ", ";
    for (std::size_t end; (end = names.find(", ")) != std::string::npos; names.erase(0, end + 2)) {
        ExplainOptions options;
        options.x = 20;
        options.y = 15;
        options.accelerator = names.substr(0, end);
        options.with_picture = false;
        SCOPED_TRACE(options.accelerator);
        const Explanation e = explain_pixel(loaded, options);
        ASSERT_EQ(e.candidates.size(), e.traversal.steps.size());
        std::uint64_t tested = 0;
        for (const TraversalStep& step : e.traversal.steps) {
            tested += step.kind == TraversalStep::Kind::Primitive;
        }
        ASSERT_GE(e.work.size(), 2u);
        EXPECT_EQ(e.work.front().accelerator, options.accelerator);
        EXPECT_EQ(e.work.front().stats.primitive_tests, tested);
        for (const AcceleratorWork& work : e.work) {
            EXPECT_EQ(work.unavailable, "");
            EXPECT_EQ(work.t, e.traversal.hit.t) << work.accelerator;
        }
    }
}

TEST(RayTree, WhatThereIsNotIsRefused) {
    const LoadedScene loaded = loaded_of(small_scene());
    const auto refuses = [&](auto&& change) {
        ExplainOptions options;
        options.with_picture = false;
        change(options);
        EXPECT_THROW((void)explain_pixel(loaded, options), Error);
    };
    refuses([](ExplainOptions& o) { o.x = 40; });
    refuses([](ExplainOptions& o) { o.y = -1; });
    refuses([](ExplainOptions& o) { o.sample = 1; });
    refuses([](ExplainOptions& o) { o.render.samples_per_pixel = 0; });
    refuses([](ExplainOptions& o) { o.accelerator = "wide_bvh"; });
    refuses([](ExplainOptions& o) { o.render.camera = "nobody's"; });
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
