#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/core/reports/scan_line_report.h"
#include "alhazen/renderers/lane_carpenter/patch_surface.h"
#include "alhazen/renderers/lane_carpenter/scan_lines.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"
#include "unit/renderers/unit_pixels.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::glowing;
using testing::SceneMaker;
using testing::unit_pixels;

struct Picture {
    Film film;
    ScanLineReport counts;
};

Picture picture_of(SceneMaker& maker, const Camera& camera, int size,
                   const ScanLineOptions& options = {}, AovFilm* aovs = nullptr, int samples = 1) {
    Scene scene = maker.compile();
    scene.background = {0, 0, 1};
    Picture picture{Film(size, size, {0, 0, size, size}), {}};
    const RenderJob job{.scene = scene,
                        .camera = camera,
                        .samples_per_pixel = samples,
                        .aovs = aovs,
                        .description = &maker.description()};
    const RenderReport report = LaneCarpenter(options).render(job, picture.film);
    EXPECT_TRUE(report.complete());
    picture.counts = *report.scan_lines;
    return picture;
}

Rectangle square(double lo, double hi, double z) {
    return {.corner = {lo, lo, z}, .edge_u = {hi - lo, 0, 0}, .edge_v = {0, hi - lo, 0}};
}

/// A sheet over [-32, 32]^2 that is a parabola in x, of height 4 in the middle.
BezierPatch arch(bool along_v = false) {
    BezierPatch patch;
    patch.degree_u = along_v ? 1 : 2;
    patch.degree_v = along_v ? 2 : 1;
    const Vec3 a{-32, -32, 0}, b{0, -32, 8}, c{32, -32, 0}, up{0, 64, 0};
    patch.points = along_v ? std::vector<Vec3>{a, b, c, a + up, b + up, c + up}
                           : std::vector<Vec3>{a, a + up, b, b + up, c, c + up};
    return patch;
}

TEST(LaneCarpenter, AFlatPatchIsOnePolygonAndCoversItsPixels) {
    SceneMaker maker;
    maker.add(square(-2, 2, 0), maker.material(glowing({1, 0, 0})));
    const Picture picture = picture_of(maker, unit_pixels(8), 8);
    EXPECT_EQ(picture.counts.quads, 1u);
    EXPECT_EQ(picture.counts.split_u + picture.counts.split_v, 0u);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            const bool inside = x >= 2 && x < 6 && y >= 2 && y < 6;
            EXPECT_EQ(picture.film.at(x, y), (inside ? Rgb{1, 0, 0} : Rgb{0, 0, 1}));
        }
    }
}

TEST(LaneCarpenter, SplitsOnlyAlongTheDirectionThatIsNotFlat) {
    // The middle control point is 8 pixels off the chord; each halving leaves a quarter at most: 2,
    // then 0.5.
    for (const bool along_v : {false, true}) {
        SceneMaker maker;
        maker.add(arch(along_v));
        ScanLineOptions options;
        options.flatness = 0.5;
        const Picture picture = picture_of(maker, unit_pixels(80), 80, options);
        EXPECT_EQ(picture.counts.quads, 4u);
        EXPECT_EQ(along_v ? picture.counts.split_v : picture.counts.split_u, 3u);
        EXPECT_EQ(along_v ? picture.counts.split_u : picture.counts.split_v, 0u);
        options.split = SplitRule::Both;
        EXPECT_EQ(picture_of(maker, unit_pixels(80), 80, options).counts.quads, 16u);
    }
}

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

void add_mixture(SceneMaker& maker) {
    Material plain;
    plain.diffuse.color = {0.8, 0.7, 0.6};
    plain.specular.color = {0.3, 0.3, 0.3};
    plain.shininess.value = 20;
    maker.add(Plane{.point = {0, -1.1, 0}, .normal = {0, 1, 0}}, maker.material(plain));
    maker.add(Torus{.major_radius = 1.0, .minor_radius = 0.35}, MaterialId{0},
              Affine::rotate({1, 0.2, 0}, 0.9));
    maker.add(Sphere{.center = {0, 0, 0}, .radius = 0.5}, maker.material(plain));
    maker.add(BoxShape{.lo = {-1.6, -1.1, -1}, .hi = {-1.1, -0.3, -0.5}});
    maker.add(Cylinder{.base = {1.3, -1.1, -0.4}, .top = {1.4, 0.4, -0.6}, .radius = 0.3});
    maker.add(maker.mesh(testing::tetrahedron()), MaterialId{1},
              Affine::translate({1.2, 1.1, 0}) * Affine::scale({0.3, 0.3, 0.3}));
    maker.light(PointLight{.position = {3, 4, 5}});
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

/// A torus of bicubic patches that shares its points.
PatchMesh closed_torus() {
    // Uniform cubic B-spline: every 4 x 4 of the points, as Bezier patches.
    constexpr int kAround = 7, kThrough = 5;
    const auto point = [](int i, int j) {
        const double a = 2 * 3.14159265358979 * i / kAround;
        const double b = 2 * 3.14159265358979 * j / kThrough;
        const double r = 1.2 + 0.7 * std::cos(b);
        return Vec3{r * std::cos(a), r * std::sin(a), 0.7 * std::sin(b)};
    };
    const auto bezier = [](const std::array<Vec3, 4>& p) {
        return std::array<Vec3, 4>{(p[0] + 4 * p[1] + p[2]) / 6, (2 * p[1] + p[2]) / 3,
                                   (p[1] + 2 * p[2]) / 3, (p[1] + 4 * p[2] + p[3]) / 6};
    };
    PatchMesh mesh;
    // Equal bits for what neighbours share: each corner, edge and inner point is made once.
    const auto spline = [&](int i, int j) {
        std::array<std::array<Vec3, 4>, 4> rows;
        for (int a = 0; a < 4; ++a) {
            std::array<Vec3, 4> row;
            for (int b = 0; b < 4; ++b) {
                row[std::size_t(b)] = point((i + a) % kAround, (j + b) % kThrough);
            }
            rows[std::size_t(a)] = bezier(row);
        }
        std::array<std::array<Vec3, 4>, 4> net;
        for (std::size_t b = 0; b < 4; ++b) {
            const auto column = bezier({rows[0][b], rows[1][b], rows[2][b], rows[3][b]});
            for (std::size_t a = 0; a < 4; ++a) net[a][b] = column[a];
        }
        return net;
    };
    for (int k = 0; k < 9 * kAround * kThrough; ++k) mesh.points.emplace_back();
    const int columns = 3 * kThrough;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < kThrough; ++j) {
            const auto net = spline(i, j);
            for (int a = 0; a < 4; ++a) {
                for (int b = 0; b < 4; ++b) {
                    const int index = (3 * i + a) % (3 * kAround) * columns + (3 * j + b) % columns;
                    mesh.points[std::size_t(index)] = net[std::size_t(a)][std::size_t(b)];
                    mesh.patches.push_back(std::uint32_t(index));
                }
            }
        }
    }
    return mesh;
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
    maker.add(square(-3, 3, 4), maker.material(veil));
    maker.add(square(-2, 2, 2), MaterialId{0});
    maker.add(square(-2, 1, 0), maker.material(single));
    // Seen from behind.
    maker.add(square(-1, 3, -3), MaterialId{1}, {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {}});
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

/// Pixels of the bright ground between eight dark ones.
int ground_pixels(SceneMaker& maker, Cracks cracks, int views, std::uint64_t& counted) {
    constexpr int kSize = 192;
    Scene scene = compile_without_geometry(maker.description());
    scene.background = {1, 1, 1};
    int found = 0;
    RandomStream random(7);
    for (int k = 0; k < views; ++k) {
        const Vec3 direction{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const Vec3 from = 6.0 * normalize(direction);
        const Camera camera = look_along(from, -from, {0.1, 0.3, 0.9}, 0.7, 1.0);
        Film film(kSize, kSize, {0, 0, kSize, kSize});
        const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
        ScanLineOptions options;
        options.cracks = cracks;
        options.flatness = 1.0;
        options.find_cracks = true;
        counted += LaneCarpenter(options).render(job, film).scan_lines->crack_samples;
        for (int y = 1; y + 1 < kSize; ++y) {
            for (int x = 1; x + 1 < kSize; ++x) {
                int ground = 0;
                for (int n = 0; n < 9; ++n) {
                    ground += film.at(x + n % 3 - 1, y + n / 3 - 1) == scene.background;
                }
                found += ground == 1 && film.at(x, y) == scene.background;
            }
        }
    }
    return found;
}

TEST(LaneCarpenter, CracksShowUnlessTheyAreClosed) {
    SceneMaker maker;
    Material dark = glowing({0.1, 0, 0});
    dark.double_sided = false;  // else the far side is seen through a crack
    maker.add(closed_torus(), maker.material(dark));
    std::uint64_t counted = 0, none = 0;
    EXPECT_GT(ground_pixels(maker, Cracks::Show, 4, counted), 0);
    EXPECT_GT(counted, 0u);
    EXPECT_EQ(ground_pixels(maker, Cracks::Tighter, 2, none), 0);
    EXPECT_EQ(none, 0u);
    EXPECT_EQ(ground_pixels(maker, Cracks::Clark, 20, none), 0);
}

TEST(LaneCarpenter, TheToleranceThatClosesCracksDoesNotDependOnTheCrop) {
    constexpr int kSize = 8;
    BezierPatch folded;
    folded.degree_u = folded.degree_v = 2;
    folded.points = {{0.4, 0.7, 0.9},  {1.3, 0.7, 1.3},   {-1.4, -0.1, 1.3},
                     {0.4, 1.2, -1.2}, {-0.1, -0.8, 0.1}, {0.2, -1.5, -0.8},
                     {-0.7, 1.2, 0.8}, {-1.0, 0.9, -1.1}, {0.4, -1.1, -1.5}};
    SceneMaker maker;
    maker.add(std::move(folded), MaterialId{0});
    maker.light(PointLight{.position = {3, 4, 6}});
    const Scene scene = maker.compile();
    const OrthographicCamera camera{{0, 0, 6}, {0, 0, -1}, {3, 0, 0}, {0, 3, 0}};
    const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
    ScanLineOptions options;
    options.cracks = Cracks::Tighter;
    Film whole(kSize, kSize, {0, 0, kSize, kSize});
    const RenderReport report = LaneCarpenter(options).render(job, whole);
    ASSERT_GT(report.scan_lines->passes, 1u);
    for (const PixelBox& box : {PixelBox{0, 0, 8, 4}, PixelBox{0, 4, 8, 8}, PixelBox{2, 2, 4, 3}}) {
        Film crop(kSize, kSize, box);
        const auto counts = LaneCarpenter(options).render(job, crop).scan_lines;
        EXPECT_EQ(counts->flatness, report.scan_lines->flatness);
        for (int y = box.y0; y < box.y1; ++y) {
            for (int x = box.x0; x < box.x1; ++x) EXPECT_EQ(crop.at(x, y), whole.at(x, y));
        }
    }
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
    const Picture picture = picture_of(maker, inside, 128);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) EXPECT_NE(picture.film.at(x, y), (Rgb{0, 0, 1}));
    }
}

TEST(LaneCarpenter, ThreadsAndCropsGiveTheSameBits) {
    SceneMaker maker;
    add_mixture(maker);
    const Scene scene = maker.compile();
    const Camera camera = look_along({0.4, 1.2, 5}, {-0.08, -0.24, -1}, {0, 1, 0}, 0.7, 1.0);
    for (const int samples : {1, 4}) {
        RenderJob job{.scene = scene,
                      .camera = camera,
                      .samples_per_pixel = samples,
                      .description = &maker.description()};
        Film one(70, 60, {0, 0, 70, 60}), many = one, crop(70, 60, {21, 13, 55, 50});
        job.control.threads = 1;
        const RenderReport first = LaneCarpenter().render(job, one);
        job.control.threads = 4;
        const RenderReport second = LaneCarpenter().render(job, many);
        (void)LaneCarpenter().render(job, crop);
        EXPECT_EQ(first.scan_lines->most_held, second.scan_lines->most_held);
        for (int y = 0; y < 60; ++y) {
            for (int x = 0; x < 70; ++x) {
                ASSERT_EQ(one.at(x, y), many.at(x, y));
                const PixelBox& box = crop.crop();
                if (x < box.x0 || x >= box.x1 || y < box.y0 || y >= box.y1) continue;
                ASSERT_EQ(one.at(x, y), crop.at(x, y)) << x << ',' << y;
            }
        }
    }
}

TEST(LaneCarpenter, CropsMayEndBetweenAPatchAndItsControlPoints) {
    SceneMaker maker;
    maker.add(Sphere{.center = {-0.875, -0.875, 1}, .radius = 0.625}, {},
              Affine::rotate({1, 0, 0}, 30 * kPi / 180));
    const Scene scene = maker.compile();
    const Camera camera = look_along({0.25, 0.0067, -5.4914}, {-0.247, 0.0063, 5.4624},
                                     {0.1, 0.2, 1}, 0.567, 48.0 / 36.0);
    for (const bool all_first : {false, true}) {
        for (const int samples : {1, 4}) {
            const RenderJob job{.scene = scene,
                                .camera = camera,
                                .samples_per_pixel = samples,
                                .description = &maker.description()};
            const LaneCarpenter renderer({.all_first = all_first});
            Film whole(48, 36, {0, 0, 48, 36});
            (void)renderer.render(job, whole);
            for (int begin = 0; begin < 36; begin += 5) {
                for (int end = begin + 1; end <= 36; ++end) {
                    Film crop(48, 36, {0, begin, 48, end});
                    (void)renderer.render(job, crop);
                    for (int y = begin; y < end; ++y) {
                        for (int x = 0; x < 48; ++x) {
                            ASSERT_EQ(whole.at(x, y), crop.at(x, y)) << begin << ' ' << end;
                        }
                    }
                }
            }
        }
    }
}

TEST(LaneCarpenter, ClarkGivesTheSamePictureFromMorePatches) {
    SceneMaker maker;
    maker.add(closed_torus());
    const Camera camera = look_along({2, -4, 3}, {-2, 4, -3}, {0, 0, 1}, 0.7, 1.0);
    ScanLineOptions options;
    const Picture lazy = picture_of(maker, camera, 200, options);
    options.all_first = true;
    const Picture first = picture_of(maker, camera, 200, options);
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) ASSERT_EQ(lazy.film.at(x, y), first.film.at(x, y));
    }
    EXPECT_EQ(lazy.counts.quads, first.counts.quads);
    EXPECT_GT(first.counts.most_held, 4 * lazy.counts.most_held);
    EXPECT_EQ(lazy.counts.lines.size(), 200u);
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

TEST(LaneCarpenter, RefusesByNameWhatIsNoPatch) {
    SceneMaker maker;
    (void)maker.material({});
    maker.add(Blob{});
    maker.add(Superellipsoid{});
    const ObjectIndex solid = maker.object("cut");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(solid);
    try {
        (void)scan_scene(maker.description(), compile_without_geometry(maker.description()), {});
        FAIL();
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        for (const char* name : {"blob", "superellipsoid", "'cut'"}) {
            EXPECT_NE(text.find(name), std::string::npos) << text;
        }
    }
}

TEST(RendererSettings, AreCheckedByTheirRenderer) {
    EXPECT_NO_THROW((void)make_renderer("lane_carpenter:flatness=0.5,cracks=show,split=both"));
    EXPECT_NO_THROW((void)make_renderer("clark"));
    for (const char* text :
         {"lane_carpenter:flatness=0", "lane_carpenter:flatness=x", "lane_carpenter:cracks=none",
          "lane_carpenter:flat=1", "lane_carpenter:flatness", "lane_carpenter:split=one,split=one",
          "whitted:flatness=1", "lane"}) {
        EXPECT_THROW((void)make_renderer(text), Error) << text;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
