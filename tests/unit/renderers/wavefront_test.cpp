/// For any number of rays traced together: the same picture, bounded memory, and an end on request.

#include "alhazen/renderers/core/wavefront.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <thread>
#include <vector>

#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/random.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

Material shiny(double kd, double kr) {
    Material m;
    m.diffuse.color = {kd, 0.9 * kd, 0.7 * kd};
    m.specular.color = {0.3, 0.3, 0.3};
    m.shininess.value = 20;
    m.reflective.color = {kr, kr, 0.8 * kr};
    return m;
}

Material glass() {
    Material m = shiny(0.1, 0.3);
    m.transmissive.color = {0.9, 0.8, 0.7};
    m.index.value = 1.5;
    return m;
}

/// A material with an alpha: partly transparent, or invisible.
Material partly_there(double alpha) {
    Material m = shiny(0.6, 0.2);
    m.alpha_mode = AlphaMode::Blend;
    m.alpha.value = alpha;
    return m;
}

/// Mirrors, glass and partly transparent surfaces at random; two lights and ambient light.
Scene mixed_scene(bool transparent, const std::string& accelerator = "wide_bvh") {
    SceneMaker maker;
    const MaterialId wall = maker.material(shiny(0.7, 0.0));
    std::vector<MaterialId> some{wall, maker.material(shiny(0.4, 0.5))};
    if (transparent) {
        some.push_back(maker.material(glass()));
        some.push_back(maker.material(partly_there(0.5)));
        some.push_back(maker.material(partly_there(0.0)));
    }
    testing::Random random(5);
    for (int i = 0; i < 40; ++i) {
        const Vec3 center{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-4, 2)};
        maker.add(Sphere{.center = center, .radius = random.uniform(0.2, 0.6)},
                  some[static_cast<std::size_t>(i) % some.size()]);
    }
    maker.add(Rectangle{.corner = {-9, -9, -6}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}}, wall);
    maker.light(AmbientLight{{0.1, 0.1, 0.2}});
    maker.light(PointLight{.position = {3, 4, 5}});
    maker.light(DirectionalLight{.to_light = normalize(Vec3{-1, 2, 1}), .color = {0.5, 0.4, 0.3}});
    maker.description().picture.background = Rgb{0.2, 0.3, 0.4};
    return maker.compile(accelerator);
}

struct Picture {
    Film film{24, 18, {0, 0, 24, 18}};
    RayCounters counters;
};

Picture picture_of(const Scene& scene, const TiledRenderer& renderer, int tile = 24) {
    Picture picture;
    const RenderJob job{scene, scene.cameras[0].camera, 2, 11, false};
    for (const PixelBox& box : tiles_of(picture.film.crop(), tile)) {
        renderer.render_tile(job, box, picture.film, picture.counters);
    }
    return picture;
}

void expect_same(const Picture& a, const Picture& b, std::size_t rays_at_once) {
    for (int y = 0; y < 18; ++y) {
        for (int x = 0; x < 24; ++x) {
            ASSERT_EQ(a.film.at(x, y), b.film.at(x, y))
                << x << ',' << y << " with " << rays_at_once << " rays at once";
        }
    }
    for (std::size_t kind = 0; kind < a.counters.rays.size(); ++kind) {
        EXPECT_EQ(a.counters.rays[kind].cast, b.counters.rays[kind].cast) << kRayKindNames[kind];
        EXPECT_EQ(a.counters.rays[kind].hit, b.counters.rays[kind].hit) << kRayKindNames[kind];
    }
    EXPECT_EQ(a.counters.total_internal, b.counters.total_internal);
}

TEST(Wavefront, ThePictureIsTheSameForAnyNumberOfRaysAtOnce) {
    for (const bool transparent : {false, true}) {
        const Scene scene = mixed_scene(transparent);
        const Picture one_by_one = picture_of(scene, Whitted(1));
        EXPECT_GT(one_by_one.counters[RayKind::Reflection].hit, 50u);
        EXPECT_EQ(one_by_one.counters[RayKind::Refraction].hit > 50u, transparent);
        for (const std::size_t rays : {2, 7, 64, 256, 5000}) {
            expect_same(one_by_one, picture_of(scene, Whitted(rays)), rays);
        }
    }
}

TEST(Wavefront, ThePictureIsTheSameForAnyTileAndAccelerator) {
    const Picture picture = picture_of(mixed_scene(true), Whitted());
    expect_same(picture, picture_of(mixed_scene(true), Whitted(), 5), 256);
    expect_same(picture, picture_of(mixed_scene(true, "list"), Whitted(), 7), 256);
    const Picture cast = picture_of(mixed_scene(true), RayCasting());
    expect_same(cast, picture_of(mixed_scene(true, "list"), RayCasting(), 1), 256);
}

TEST(Wavefront, ThreadsThatShareARendererGiveTheSamePicture) {
    const Scene scene = mixed_scene(true);
    const Whitted renderer;
    const Picture alone = picture_of(scene, renderer);
    std::array<Picture, 3> pictures;
    std::vector<std::jthread> threads;
    for (Picture& picture : pictures) {
        threads.emplace_back([&] { picture = picture_of(scene, renderer, 8); });
    }
    threads.clear();
    for (const Picture& picture : pictures) expect_same(alone, picture, 256);
}

/// Forwards to another aggregate and observes its queries.
class Watched final : public Aggregate {
  public:
    explicit Watched(std::shared_ptr<const Aggregate> inner) : inner_(std::move(inner)) {}

    mutable std::vector<std::size_t> generations;  ///< rays of each, in the order of the calls
    mutable std::size_t single_rays = 0;
    mutable std::vector<Coherence> shadows;  ///< the hints of batches of shadow rays
    StopFlag* stop = nullptr;                ///< requested by call number `stop_at`
    std::size_t stop_at = 0;

    const PrimitiveTable& primitives() const override { return inner_->primitives(); }
    Box3 box() const override { return inner_->box(); }
    std::size_t memory_bytes() const override { return inner_->memory_bytes(); }
    bool closest(const Ray& ray, Hit& hit, RayQuery query) const override {
        ++single_rays;
        return inner_->closest(ray, hit, query);
    }
    bool occluded(const Ray& ray, RayQuery query) const override {
        return inner_->occluded(ray, query);
    }
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const override {
        inner_->all_hits(ray, hits, query);
    }
    bool shadowed(const Ray& ray, std::vector<Hit>& crossings, RayQuery query) const override {
        return inner_->shadowed(ray, crossings, query);
    }
    void closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                       Coherence coherence) const override {
        if (stop != nullptr && generations.size() == stop_at) stop->request();
        generations.push_back(rays.size());
        inner_->closest_batch(rays, hits, query, coherence);
    }
    void occluded_batch(std::span<const Ray> rays, std::span<bool> occluded, RayQuery query,
                        Coherence coherence) const override {
        shadows.push_back(coherence);
        inner_->occluded_batch(rays, occluded, query, coherence);
    }

  private:
    std::shared_ptr<const Aggregate> inner_;
};

/// Every ray that meets one of two facing walls of glass sends on two.
Scene doubling_scene(int depth, std::shared_ptr<Watched>& watched) {
    SceneMaker maker;
    Material m = shiny(0.1, 1.0);
    m.reflective.color = m.transmissive.color = {1, 1, 1};
    m.emission.color = {0.1, 0.1, 0.1};
    const MaterialId both = maker.material(m);
    for (const double z : {0.0, 6.0, -6.0, 12.0}) {
        maker.add(Rectangle{.corner = {-99, -99, z}, .edge_u = {198, 0, 0}, .edge_v = {0, 198, 0}},
                  both);
    }
    maker.light(PointLight{.position = {1, 1, 3}});
    maker.description().conventions.shading.max_depth = depth;
    maker.description().conventions.shading.min_contribution = 0;
    Scene scene = maker.compile();
    watched = std::make_shared<Watched>(scene.aggregate);
    scene.aggregate = watched;
    return scene;
}

TEST(Wavefront, MirrorsAndGlassThatDoubleTheRaysTwelveTimesKeepGenerationsSmall) {
    std::shared_ptr<Watched> watched;
    const Scene scene = doubling_scene(12, watched);
    const RenderJob job{scene, scene.cameras[0].camera};
    Film film(8, 8, {0, 0, 8, 8});
    RayCounters counters;
    Whitted(32).render_tile(job, {0, 0, 8, 8}, film, counters);
    std::size_t rays = 0;
    for (const std::size_t n : watched->generations) {
        ASSERT_LE(n, 32u);
        rays += n;
    }
    EXPECT_EQ(watched->single_rays, 0u);
    EXPECT_EQ(rays + counters[RayKind::Shadow].cast, counters.total_cast());
    EXPECT_GT(rays, 64u * 1000);
    // They are together all the same: a ray has others with it.
    EXPECT_GT(rays, 16 * watched->generations.size());
}

TEST(Wavefront, DeepTreesAreTracedFewRaysAtATime) {
    std::shared_ptr<Watched> watched;
    Scene scene = doubling_scene(200, watched);
    scene.conventions.shading.trace_refractions = false;
    const RenderJob job{scene, scene.cameras[0].camera};
    Film film(8, 8, {0, 0, 8, 8});
    RayCounters counters;
    Whitted(64).render_tile(job, {0, 0, 8, 8}, film, counters);
    EXPECT_EQ(watched->generations[0], 64u);
    for (std::size_t i = 16; i < watched->generations.size(); ++i) {
        ASSERT_LE(watched->generations[i], 16u) << i;
    }
}

TEST(Wavefront, AStopEndsTheWorkWithTheGenerationAtHand) {
    for (const std::size_t call : {0, 1, 5, 100}) {
        std::shared_ptr<Watched> watched;
        const Scene scene = doubling_scene(30, watched);
        StopFlag stop;
        watched->stop = &stop;
        watched->stop_at = call;
        RenderJob job{scene, scene.cameras[0].camera};
        job.control.stop = &stop;
        Film film(8, 8, {0, 0, 8, 8});
        RayCounters counters;
        Whitted(16).render_tile(job, {0, 0, 8, 8}, film, counters);
        EXPECT_EQ(watched->generations.size(), call + 1);
        EXPECT_EQ(film.at(0, 0), Rgb{}) << "a pixel that was given up was written";
    }
}

TEST(Wavefront, ShadowRaysToAPointAndParallelOnesAreCoherent) {
    for (const bool parallel : {false, true}) {
        SceneMaker maker;
        const MaterialId matte = maker.material(shiny(0.5, 0.0));
        maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  matte);
        if (parallel) {
            maker.light(DirectionalLight{.to_light = {0.1, 0.2, 1}});
        } else {
            maker.light(PointLight{.position = {1, 1, 3}});
        }
        Scene scene = maker.compile();
        const auto watched = std::make_shared<Watched>(scene.aggregate);
        scene.aggregate = watched;
        Film film(8, 8, {0, 0, 8, 8});
        RayCounters counters;
        Whitted(64).render_tile({scene, scene.cameras[0].camera}, {0, 0, 8, 8}, film, counters);
        ASSERT_FALSE(watched->shadows.empty());
        EXPECT_EQ(watched->shadows.front(), Coherence::Coherent) << parallel;
    }
}

/// Compares with a plain recursion of single rays, reimplemented here for mirrors alone.
TEST(Wavefront, MirrorsInARowMultiplyAsTheRecursionDoes) {
    SceneMaker maker;
    Material m;
    m.emission.color = {0.1, 0.2, 0.3};
    m.reflective.color = {0.5, 0.7, 0.9};
    const MaterialId mirrors = maker.material(m);
    for (const double z : {0.0, 10.0}) {
        maker.add(Rectangle{.corner = {-9, -9, z}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  mirrors);
    }
    maker.description().conventions.shading.max_depth = 12;
    maker.description().conventions.shading.min_contribution = 0;
    const Scene scene = maker.compile();
    Rgb expected = m.emission.color;
    for (int i = 0; i < 12; ++i) {
        expected = m.emission.color + m.reflective.color * expected;
    }
    Film film(1, 1, {0, 0, 1, 1});
    RayCounters counters;
    Whitted(4).render_tile({scene, scene.cameras[0].camera}, {0, 0, 1, 1}, film, counters);
    EXPECT_EQ(film.at(0, 0), expected);
    EXPECT_EQ(counters[RayKind::Reflection].cast, 12u);
}

TEST(Wavefront, AGenerationKeepsItsRaysAndTheirLightInOrder) {
    Generation generation;
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(generation.add(Ray{.direction = {0, 0, double(i)}}, {}),
                  static_cast<std::uint32_t>(i));
    }
    generation.make_ready();
    const GenerationPart part = generation.part(3, 2);
    ASSERT_EQ(part.size(), 2u);
    EXPECT_EQ(part.rays[0].direction.z, 3.0);
    part.radiance[1] = {1, 2, 3};
    EXPECT_EQ(generation.radiance(4), (Rgb{1, 2, 3}));
    EXPECT_EQ(generation.radiance(3), Rgb{});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
