#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "alhazen/renderers/core/material_cache.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "alhazen/shading/materials/texture_inputs.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

/// Mirrors, glass, partly transparent and single-sided surfaces over a floor: tiles that leave
/// every kind of state to the next one.
Scene mixed_scene() {
    SceneMaker maker;
    Material floor, mirror, glass, thin, single;
    floor.diffuse.color = {0.8, 0.7, 0.6};
    mirror.reflective.color = {0.7, 0.8, 0.9};
    glass.transmissive.color = {0.9, 0.8, 0.7};
    glass.index.value = 1.5;
    thin.diffuse.color = {1, 0, 0};
    thin.alpha_mode = AlphaMode::Blend;
    thin.alpha.value = 0.4;
    single.diffuse.color = {0, 1, 0};
    single.double_sided = false;
    maker.add(Plane{.point = {0, -1, 0}, .normal = {0, 1, 0}}, maker.material(floor));
    maker.add(Sphere{.center = {-1.2, 0, 0}}, maker.material(mirror));
    maker.add(Sphere{.center = {1.2, 0, 0}}, maker.material(glass));
    maker.add(Sphere{.center = {0, 1, 0.5}, .radius = 0.6}, maker.material(thin));
    TriangleMesh mesh;
    mesh.positions = {{-2, 1, -1}, {2, 1, -1}, {0, 3, -1}, {0, 1.5, -1.5}};
    mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
    mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 0.5f}};
    maker.add(maker.mesh(mesh), maker.material(single));
    maker.light(PointLight{.position = {3, 4, 5}});
    return maker.compile();
}

void expect_same_pixels(const Film& a, const Film& b) {
    const PixelBox& box = a.crop();
    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) ASSERT_EQ(a.at(x, y), b.at(x, y)) << x << ',' << y;
    }
}

/// Calls `use(renderer, name)` with each renderer of the table that works in tiles.
template <class Use>
void for_tiled_renderers(Use&& use) {
    int count = 0;
    for (const RendererEntry& entry : renderers()) {
        const auto renderer = make_renderer(entry.name);
        const auto* tiled = dynamic_cast<const TiledRenderer*>(renderer.get());
        if (tiled == nullptr) continue;
        use(*tiled, entry.name);
        ++count;
    }
    EXPECT_GE(count, 2);
}

TEST(TileRenderer, TilesDoNotDependOnThoseBefore) {
    const Scene scene = mixed_scene();
    const PixelBox all{0, 0, 44, 30};
    for (const int samples : {1, 3}) {
        const RenderJob job{scene, scene.cameras[0].camera, samples, 11, true};
        for_tiled_renderers([&](const TiledRenderer& renderer, const char* name) {
            const auto kept = renderer.begin(job);
            Film alone(44, 30, all), in_a_row(44, 30, all);
            RayCounters alone_sum, row_sum;
            std::vector<PixelBox> tiles = tiles_of(all, 9);
            std::reverse(tiles.begin(), tiles.end());
            for (const PixelBox& tile : tiles) {
                renderer.render_tile(job, tile, alone, alone_sum);
                kept->render(tile, in_a_row, row_sum);
                ASSERT_EQ(alone_sum.total_cast(), row_sum.total_cast()) << name;
                ASSERT_EQ(alone_sum.tests.node_visits, row_sum.tests.node_visits);
                ASSERT_EQ(alone_sum.tests.primitive_tests, row_sum.tests.primitive_tests);
            }
            expect_same_pixels(alone, in_a_row);
        });
    }
}

TEST(TileRenderer, APixelIsWhatItIsAloneInItsPicture) {
    const Scene scene = mixed_scene();
    const RenderJob job{scene, scene.cameras[0].camera};
    for_tiled_renderers([&](const TiledRenderer& renderer, const char*) {
        Film film(33, 21, {0, 0, 33, 21}), single(33, 21, {0, 0, 33, 21});
        RayCounters counters;
        renderer.render_tile(job, film.crop(), film, counters);
        for (int y = 0; y < 21; ++y) {
            for (int x = 0; x < 33; ++x) {
                renderer.render_tile(job, {x, y, x + 1, y + 1}, single, counters);
            }
        }
        expect_same_pixels(film, single);
    });
}

TEST(TiledRenderer, AnyThreadsAndTileSizeGiveTheSamePixelsAndCounts) {
    const Scene scene = mixed_scene();
    const PixelBox crop{5, 3, 40, 29};
    for (const int samples : {1, 3}) {
        RenderJob job{scene, scene.cameras[0].camera, samples, 11, true};
        for_tiled_renderers([&](const TiledRenderer& renderer, const char* name) {
            Film expected(44, 30, crop);
            RayCounters counters;
            renderer.render_tile(job, crop, expected, counters);
            for (const int size : {1, 9, 64}) {
                for (const int threads : {1, 2}) {
                    job.control = {.threads = threads, .tile_size = size};
                    Film film(44, 30, crop);
                    const RenderReport report = renderer.render(job, film);
                    expect_same_pixels(expected, film);
                    EXPECT_TRUE(report.complete());
                    EXPECT_EQ(report.parts, tiles_of(crop, size).size());
                    EXPECT_LE(report.threads, threads);
                    for (std::size_t kind = 0; kind < kRayKindCount; ++kind) {
                        EXPECT_EQ(report.counters.rays[kind].cast, counters.rays[kind].cast)
                            << name;
                        EXPECT_EQ(report.counters.rays[kind].hit, counters.rays[kind].hit) << name;
                    }
                }
            }
        });
    }
}

/// Records its calls, and requests a stop after some parts.
class Notes final : public ProgressSink {
  public:
    std::vector<std::size_t> done;
    std::size_t total = 0, stop_after = 0;
    StopFlag stop;

    void update(std::string_view phase, std::size_t now, std::size_t of) override {
        EXPECT_EQ(phase, "render");
        done.push_back(now);
        total = of;
        if (now == stop_after) stop.request();
    }
};

TEST(TiledRenderer, ProgressCountsTheTiles) {
    const Scene scene = mixed_scene();
    RenderJob job{scene, scene.cameras[0].camera};
    Notes notes;
    job.control = {.threads = 2, .tile_size = 8, .progress = &notes};
    Film film(24, 20, {0, 0, 24, 20});
    EXPECT_TRUE(Whitted{}.render(job, film).complete());
    EXPECT_EQ(notes.total, 9u);
    ASSERT_EQ(notes.done.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(notes.done[i], i + 1);
}

TEST(TiledRenderer, AStopLeavesTheTilesThatAreNotDoneBlack) {
    Scene scene = mixed_scene();
    scene.background = {1, 1, 1};
    RenderJob job{scene, scene.cameras[0].camera};
    Notes notes;
    notes.stop_after = 2;
    job.control = {.threads = 1, .tile_size = 8, .stop = &notes.stop, .progress = &notes};
    Film film(24, 20, {0, 0, 24, 20}), whole(24, 20, {0, 0, 24, 20});
    const RenderReport report = Whitted{}.render(job, film);
    EXPECT_FALSE(report.complete());
    EXPECT_EQ(report.parts, 9u);
    EXPECT_EQ(report.done, 2u);
    EXPECT_GT(report.counters.total_cast(), 0u);
    job.control = {};
    EXPECT_TRUE(Whitted{}.render(job, whole).complete());
    std::size_t done = 0;
    for (const PixelBox& tile : tiles_of(film.crop(), 8)) {
        bool black = true, same = true;
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                black = black && film.at(x, y) == Rgb{};
                same = same && film.at(x, y) == whole.at(x, y);
            }
        }
        EXPECT_TRUE(black || same);
        done += same;
    }
    EXPECT_EQ(done, 2u);
}

TEST(MaterialCache, GivesTheSampleOfEachMaterialThatIsTheSameEverywhere) {
    Scene scene;
    for (int i = 0; i < 100; ++i) {
        Material m;
        m.diffuse.color = {0.01 * i, 0.5, 0.5};
        if (i % 7 == 3) m.specular.texture = TextureId{0};
        scene.materials.push_back(m);
    }
    MaterialCache cache(scene);
    std::mt19937 random(5);
    for (int n = 0; n < 2000; ++n) {
        const auto i = static_cast<std::uint32_t>(random() % 100);
        const MaterialSample* sample = cache.find(MaterialId{i});
        ASSERT_EQ(sample == nullptr, i % 7 == 3) << i;
        if (sample == nullptr) continue;
        ASSERT_EQ(sample->diffuse, scene.materials[i].diffuse.color) << i;
    }
}

TEST(MaterialCache, EveryInputThatReadsATextureCounts) {
    EXPECT_FALSE(reads_textures(Material{}));
    const auto expect_read = [](auto... inputs) {
        const auto check = [](auto input) {
            Material m;
            m.*input = {};
            (m.*input).texture = TextureId{0};
            EXPECT_TRUE(reads_textures(m));
        };
        (check(inputs), ...);
    };
    using M = Material;
    expect_read(&M::emission, &M::ambient, &M::diffuse, &M::specular, &M::reflective,
                &M::transmissive, &M::shininess, &M::index, &M::alpha, &M::normal_map);
    const auto expect_read_of_metal = [](auto... inputs) {
        const auto check = [](auto input) {
            Material m;
            m.metallic_roughness.emplace();
            EXPECT_FALSE(reads_textures(m));
            ((*m.metallic_roughness).*input).texture = TextureId{0};
            EXPECT_TRUE(reads_textures(m));
        };
        (check(inputs), ...);
    };
    using R = MetallicRoughness;
    expect_read_of_metal(&R::base_color, &R::metallic, &R::roughness, &R::occlusion, &R::specular,
                         &R::specular_color, &R::transmission, &R::thickness);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
