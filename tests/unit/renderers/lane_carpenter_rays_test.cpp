/// Lane-Carpenter pictures and layers against those of rays.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"
#include "alhazen/renderers/lane_carpenter/scan_lines.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "support/scene_maker.h"
#include "unit/renderers/lane_carpenter_scenes.h"
#include "unit/renderers/one_pixel.h"
#include "unit/renderers/unit_pixels.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::add_mixture;
using testing::closed_torus;
using testing::glowing;
using testing::scan_picture_of;
using testing::ScanPicture;
using testing::SceneMaker;
using testing::unit_pixels;
using testing::upright_square;

/// The samples that show the same part and patch as rays, as a share; and as a share of these, the
/// ones whose depth, along the normal, is within twice the flatness.
struct Agreement {
    double same = 0, close = 0;
};

Agreement agreement(SceneMaker& maker, const Camera& camera, int size,
                    const ScanLineOptions& options) {
    const Scene scene = maker.compile("wide_bvh");
    const Film film(size, size, {0, 0, size, size});
    const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
    const ScanScene geometry = scan_scene(maker.description(), scene, picture_plane(camera).eye);
    const ScreenView view(camera, size, size, geometry.farthest);
    const SampleGrid grid(job, film, view);
    ScanLines lines(geometry, view, grid, options);
    ScanRow row;
    int same = 0, close = 0;
    for (int y = 0; y < size; ++y) {
        lines.next(row);
        for (int x = 0; x < size; ++x) {
            const Vec2 p = grid.film_at(x, y, 0);
            const Ray ray = eye_ray(camera, p.x, p.y);
            Hit hit;
            const bool found = scene.aggregate->closest(ray, hit, nullptr);
            const ScanSample& seen = row.samples[static_cast<std::size_t>(x)];
            if (found != (seen.item != ScanSample::kNothing)) continue;
            if (!found) {
                ++same;
                ++close;
                continue;
            }
            const bool flat = (seen.item & ScanSample::kFacet) != 0;
            const std::uint32_t item = seen.item & ~ScanSample::kFacet;
            const std::uint32_t source =
                flat ? geometry.facets[item].source : geometry.pieces[item].source;
            const std::uint32_t part =
                flat ? geometry.facets[item].part : geometry.pieces[item].part;
            const Surface surface = surface_at(*scene.aggregate, ray, hit);
            const bool same_patch = geometry.sources[source].mesh != nullptr || part == hit.part;
            if (geometry.sources[source].part != surface.part || !same_patch) continue;
            ++same;
            const double t = view.parallel() ? -seen.nearness
                                             : 1.0 / (seen.nearness * view.depth_of(ray.direction));
            const double off = std::abs(t - hit.t) * std::abs(dot(ray.direction, surface.normal));
            close += off <= 2.0 * options.flatness * view.pixel_size(seen.nearness);
        }
    }
    return {static_cast<double>(same) / (size * size), static_cast<double>(close) / same};
}

TEST(LaneCarpenter, ShowsTheSurfacesThatRaysMeet) {
    SceneMaker maker;
    add_mixture(maker);
    ScanLineOptions options;
    options.flatness = 0.1;
    const Camera perspective = look_along({0.4, 1.2, 5}, {-0.08, -0.24, -1}, {0, 1, 0}, 0.7, 1.0);
    const Camera parallel = look_along_parallel({0.4, 1.2, 5}, {-0.08, -0.24, -1}, {0, 1, 0}, 4, 1);
    for (const Camera& camera : {perspective, parallel}) {
        const Agreement found = agreement(maker, camera, 256, options);
        EXPECT_GE(found.same, 0.999);
        EXPECT_GE(found.close, 0.9995);
    }
}

double value_of(const LayerChannel& channel, std::size_t at) {
    if (channel.type == SampleType::Uint) return channel.whole[at];
    return double{channel.values[at]};
}

TEST(LaneCarpenter, HasTheLookAndTheLayersOfRayCasting) {
    SceneMaker maker;
    add_mixture(maker);
    Scene scene = maker.compile("wide_bvh");
    scene.background = {0.1, 0.2, 0.3};
    const Camera camera = look_along({0.4, 1.2, 5}, {-0.08, -0.24, -1}, {0, 1, 0}, 0.7, 1.0);
    constexpr int kSize = 96;
    const PixelBox all{0, 0, kSize, kSize};
    Film film(kSize, kSize, all), rays(kSize, kSize, all);
    AovFilm layers(parse_aovs("all"), all), ray_layers(parse_aovs("all"), all);
    RenderJob job{
        .scene = scene, .camera = camera, .aovs = &layers, .description = &maker.description()};
    ScanLineOptions options;
    options.flatness = 0.05;
    (void)LaneCarpenter(options).render(job, film);
    job.aovs = &ray_layers;
    (void)RayCasting().render(job, rays);
    int other_pixels = 0, other_ids = 0, other_depths = 0, other_uvs = 0;
    const auto& channels = layers.layers().channels();
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const Rgb d = film.at(x, y) + -1.0 * rays.at(x, y);
            const auto at = static_cast<std::size_t>(y * kSize + x);
            other_pixels += std::abs(d.r) + std::abs(d.g) + std::abs(d.b) > 0.02;
            for (std::size_t c = 0; c < channels.size(); ++c) {
                const double a = value_of(channels[c], at);
                const double b = value_of(ray_layers.layers().channels()[c], at);
                other_ids += channels[c].name.starts_with("id.") && a != b;
                const bool other = a != b && !(std::abs(a - b) <= 0.01);
                other_depths += channels[c].name == "depth.Z" && other;
                other_uvs += channels[c].name == "uv.U" && other;
            }
        }
    }
    const int few = kSize * kSize / 200;
    EXPECT_LE(other_pixels, few);
    EXPECT_LE(other_ids, 3 * few);
    EXPECT_LE(other_depths, few);
    EXPECT_LE(other_uvs, few);
}

/// Samples of the layers `uv` and `N` that differ from those of rays, and of the picture.
struct Differences {
    int pixels = 0, uvs = 0, normals = 0;
};

Differences differences(SceneMaker& maker, const Camera& camera, int size) {
    Scene scene = maker.compile("wide_bvh");
    scene.background = {0, 0, 1};
    const PixelBox all{0, 0, size, size};
    Film film(size, size, all), rays(size, size, all);
    AovFilm layers(parse_aovs("uv,Ng"), all), ray_layers(parse_aovs("uv,Ng"), all);
    RenderJob job{
        .scene = scene, .camera = camera, .aovs = &layers, .description = &maker.description()};
    (void)LaneCarpenter().render(job, film);
    job.aovs = &ray_layers;
    (void)RayCasting().render(job, rays);
    Differences found;
    const auto& channels = layers.layers().channels();
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const Rgb d = film.at(x, y) + -1.0 * rays.at(x, y);
            found.pixels += !(std::abs(d.r) + std::abs(d.g) + std::abs(d.b) <= 0.02);
            for (std::size_t c = 0; c < channels.size(); ++c) {
                const auto at = static_cast<std::size_t>(y * size + x);
                const double off =
                    value_of(channels[c], at) - value_of(ray_layers.layers().channels()[c], at);
                (channels[c].name.starts_with("uv") ? found.uvs : found.normals) +=
                    !(std::abs(off) <= 0.01);
            }
        }
    }
    return found;
}

TEST(LaneCarpenter, ParametersAreThoseOfRays) {
    SceneMaker maker;
    maker.add(Rectangle{.corner = {-2, -2, -1}, .edge_u = {4, 0, 0}, .edge_v = {0, 4, 0}});
    NurbsSurface surface;
    surface.degree_u = 2;
    surface.degree_v = 1;
    surface.knots_u = {1, 1, 1, 1.5, 3, 3, 3};
    surface.knots_v = {-2, -2, 0, 5, 5};
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 3; ++j) {
            surface.points.push_back({0.9 * i - 1.4, 0.9 * j - 0.9, i % 2 == j % 2 ? 0.3 : 0.0});
        }
    }
    maker.add(surface);
    const Camera camera = look_along({0.4, 1.2, 5}, {-0.08, -0.24, -1}, {0, 1, 0}, 0.7, 1.0);
    const Differences found = differences(maker, camera, 96);
    EXPECT_LE(found.uvs, 60);
    EXPECT_LE(found.normals, 100);
    // The derivatives by u and v of the whole, against differences along the surface.
    surface.prepare();
    for (const double x : {-0.9, -0.2, 0.7}) {
        const auto surface_at_x = [&](double at) {
            const Ray ray{{at, -0.3, 5}, {0, 0, -1}};
            ShapeHits hits;
            surface.intersect(ray, hits);
            EXPECT_EQ(hits.size(), 1u);
            return surface.surface(ray, hits[0]);
        };
        const ShapeSurface low = surface_at_x(x), high = surface_at_x(x + 1e-5);
        const Vec2 change = high.uv - low.uv;
        const Vec3 along = change.x * low.dpdu + change.y * low.dpdv;
        EXPECT_NEAR(along.x, 1e-5, 1e-8);
        EXPECT_NEAR(along.y, 0.0, 1e-8);
    }
}

TEST(LaneCarpenter, SingleSidedSurfacesAreThoseOfRays) {
    Material single = glowing({0.1, 0.9, 0});
    single.double_sided = false;
    // Mirrored, and with a patch that runs against its neighbours.
    for (const bool turned : {false, true}) {
        SceneMaker maker;
        PatchMesh mesh = closed_torus();
        if (turned) {
            for (std::size_t patch = 0; patch < mesh.patches.size() / 16; patch += 3) {
                for (std::size_t i = 0; i < 4; ++i) {
                    for (std::size_t j = 0; j < i; ++j) {
                        std::swap(mesh.patches[16 * patch + 4 * i + j],
                                  mesh.patches[16 * patch + 4 * j + i]);
                    }
                }
            }
        }
        const Affine mirror = Affine::scale({turned ? 1.0 : -1.0, 1, 1});
        maker.add(std::move(mesh), maker.material(single), mirror);
        const Camera camera = look_along({1.1, 0.1, 5}, {-0.2, 0, -5}, {0, 1, 0}, 0.9, 1.0);
        const Differences found = differences(maker, camera, 128);
        EXPECT_LE(found.pixels, 16);
        EXPECT_LE(found.normals, 250);
        const Camera inside = look_along({1.2, 0.1, 0.1}, {0, 1, 0.1}, {0, 0, 1}, 1.2, 1.0);
        EXPECT_LE(differences(maker, inside, 64).pixels, 4);
    }
}

TEST(LaneCarpenter, VeilsLetTheEyePassAsForRays) {
    SceneMaker maker;
    Material veil = glowing({1, 0, 0}), single = glowing({0, 1, 0});
    veil.alpha_mode = AlphaMode::Blend;
    veil.alpha.value = 0.25;
    single.double_sided = false;
    maker.add(upright_square(-3, 3, 4), maker.material(veil));
    maker.add(upright_square(-2, 2, 2), MaterialId{0});
    maker.add(upright_square(-2, 1, 0), maker.material(single));
    // Seen from behind.
    maker.add(upright_square(-1, 3, -3), MaterialId{1}, {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {}});
    const Camera camera = unit_pixels(8);
    Scene scene = maker.compile();
    scene.background = {0, 0, 1};
    const PixelBox all{0, 0, 8, 8};
    Film film(8, 8, all), rays(8, 8, all);
    const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
    (void)LaneCarpenter().render(job, film);
    (void)RayCasting().render(job, rays);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) EXPECT_EQ(film.at(x, y), rays.at(x, y)) << x << ',' << y;
    }
    // Two veils of 1/4 before green: 1/4 + 3/16 red, 9/16 green.
    EXPECT_EQ(film.at(3, 4), (Rgb{0.4375, 0.5625, 0}));
}

TEST(LaneCarpenter, PatchesThroughTheEyePlaneAreCut) {
    SceneMaker maker;
    maker.add(Sphere{.radius = 2}, maker.material(glowing({1, 1, 0})));
    maker.add(Torus{.major_radius = 1.0, .minor_radius = 0.3}, maker.material(glowing({1, 0, 0})));
    const Camera inside = look_along({0.1, -1.2, 0.5}, {0.1, 1, -0.4}, {0, 0, 1}, 1.6, 1.0);
    ScanLineOptions options;
    options.flatness = 0.1;
    const Agreement found = agreement(maker, inside, 128, options);
    EXPECT_GE(found.same, 0.997);
    EXPECT_GE(found.close, 0.999);
    const ScanPicture picture = scan_picture_of(maker, inside, 128);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) EXPECT_NE(picture.film.at(x, y), (Rgb{0, 0, 1}));
    }
}

/// A wavy sheet of 3 x 2 pieces, whose loops keep the inside of a diamond without a disc.
NurbsSurface trimmed_sheet() {
    NurbsSurface sheet;
    sheet.degree_u = sheet.degree_v = 2;
    sheet.knots_u = {2, 2, 2, 3, 4, 5, 5, 5};
    sheet.knots_v = {0, 0, 0, 0.5, 1, 1, 1};
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 4; ++j) {
            sheet.points.push_back({i - 2.0, j - 1.5, (i + j) % 2 == 0 ? 0.4 : -0.4});
            sheet.weights.push_back(1.0 + 0.5 * (i % 2));
        }
    }
    const TrimCurve border{
        .points = {{3.5, 0.02}, {4.9, 0.5}, {3.5, 0.98}, {2.1, 0.5}, {3.5, 0.02}}};
    TrimCurve disc{.degree = 2, .knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}};
    const double c = std::sqrt(0.5);
    for (const Vec2& p :
         {Vec2{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}}) {
        disc.points.push_back({3.6 + 0.4 * p.x, 0.5 + 0.15 * p.y});
        disc.weights.push_back(p.x != 0 && p.y != 0 ? c : 1.0);
    }
    sheet.trims = {{border}, {disc}};
    return sheet;
}

TEST(LaneCarpenter, TrimmedSurfacesShowWhatLiesBehindThem) {
    SceneMaker maker;
    maker.add(trimmed_sheet(), maker.material(glowing({1, 0, 0})));
    maker.add(Sphere{.center = {0.2, 0.1, -1.5}, .radius = 0.5},
              maker.material(glowing({0, 1, 0})));
    Scene scene = maker.compile("wide_bvh");
    const Camera camera = look_along({0.6, -0.8, 6}, {-0.1, 0.13, -1}, {0, 1, 0}, 0.7, 1.0);
    for (const int samples : {1, 4}) {
        constexpr int kSize = 200;
        const PixelBox all{0, 0, kSize, kSize};
        Film film(kSize, kSize, all), rays(kSize, kSize, all);
        const RenderJob job{.scene = scene,
                            .camera = camera,
                            .samples_per_pixel = samples,
                            .description = &maker.description()};
        (void)LaneCarpenter().render(job, film);
        (void)RayCasting().render(job, rays);
        int other = 0, red = 0, green = 0;
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const Rgb d = film.at(x, y) + -1.0 * rays.at(x, y);
                other += std::abs(d.r) + std::abs(d.g) + std::abs(d.b) > 0.3;
                red += rays.at(x, y).r > 0.5;
                green += rays.at(x, y).g > 0.5;
            }
        }
        EXPECT_GT(red, kSize * kSize / 20);
        EXPECT_GT(green, kSize * kSize / 200);
        EXPECT_LE(other, kSize * kSize / 1000) << samples;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
