#pragma once
/// Small scenes and their pictures, for tests of light-transport renderers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/shading/optics/dispersion.h"
#include "support/scene_maker.h"
#include "support/thorough.h"

namespace alhazen::testing {

inline Material matt(const Rgb& color) {
    Material m;
    m.diffuse.color = color;
    return m;
}
inline Material shining(const Rgb& radiance, const Rgb& color = {}) {
    Material m = matt(color);
    m.emission.color = radiance;
    return m;
}

/// Clear glass of a glTF material.
inline Material smooth_glass(double index = 1.5) {
    Material m;
    m.metallic_roughness.emplace();
    m.metallic_roughness->metallic.value = 0;
    m.metallic_roughness->roughness.value = 0;
    m.metallic_roughness->transmission.value = 1;
    m.metallic_roughness->thickness.value = 1;
    m.index.value = index;
    return m;
}
/// An index without measurable refraction whose boundary is no null boundary.
inline constexpr double kNearlyOne = 1.0 + 1e-9;
/// A volume whose boundary neither refracts nor reflects; with index 1 it is a null boundary.
inline Material fog(const Rgb& absorption, const Rgb& scattering, double anisotropy = 0.0,
                    double index = 1.0) {
    Material m;
    m.index.value = index;
    m.dielectric = Dielectric{absorption};
    m.scattering = {scattering, anisotropy};
    return m;
}
/// A dispersing glass of the table, by name.
inline Material glass_named(const std::string& name) {
    const NamedGlass& glass = *find_glass(name);
    Material m;
    m.dielectric.emplace();
    m.dispersion = Dispersion{.sellmeier = glass.sellmeier, .name = std::string(glass.name)};
    m.index.value = glass.sellmeier.index(kLineD);
    return m;
}

/// A prism along z with its refracting edge up, whose cross section is an isosceles triangle with
/// this apex angle (radians).
inline TriangleMesh prism(double apex) {
    const double half = std::tan(0.5 * apex);
    TriangleMesh mesh;
    for (const double z : {-1.0, 1.0}) {
        for (const Vec3& p : {Vec3{0, 0.5, z}, Vec3{-half, -0.5, z}, Vec3{half, -0.5, z}}) {
            mesh.positions.push_back(p);
        }
    }
    mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                      {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    return mesh;
}

/// A rectangle of two triangles.
inline TriangleMesh rectangle_mesh(const Vec3& corner, const Vec3& u, const Vec3& v) {
    TriangleMesh mesh;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

inline Rectangle rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
    Rectangle r;
    r.corner = corner;
    r.edge_u = u;
    r.edge_v = v;
    return r;
}

/// Renders a picture. `renderer`: NAME or "NAME --spectral"; its settings of optics are those of
/// the scene (Renderer::adjust).
inline Film picture_of(const Scene& scene, const std::string& renderer, int side, int samples,
                       std::uint64_t seed = 1, int threads = 1, int tile = 32) {
    const SamplingPlan plan;
    const std::size_t option = renderer.find(" --spectral");
    Film film(side, side, {0, 0, side, side});
    const RenderJob job{.scene = scene,
                        .camera = scene.cameras[0].camera,
                        .samples_per_pixel = samples,
                        .seed = seed,
                        .sampling = &plan,
                        .spectral = option != std::string::npos,
                        .control = {.threads = threads, .tile_size = tile}};
    const std::unique_ptr<Renderer> made = make_renderer(renderer.substr(0, option));
    ShadingConventions adjusted = scene.conventions.shading;
    made->adjust(adjusted);
    EXPECT_EQ(adjusted.optics.fresnel, scene.conventions.shading.optics.fresnel);
    EXPECT_EQ(adjusted.optics.beer, scene.conventions.shading.optics.beer);
    const RenderReport report = made->render(job, film);
    EXPECT_TRUE(report.complete());
    EXPECT_EQ(report.counters.non_finite, 0u);
    return film;
}

/// Expects equal pictures of 12 by 12 pixels with 1, 2 and 3 threads and three tile sizes.
inline void expect_same_for_threads_and_tiles(const Scene& scene, const std::string& renderer,
                                              int samples) {
    const Film a = picture_of(scene, renderer, 12, samples, 7, 1, 32);
    const Film b = picture_of(scene, renderer, 12, samples, 7, 2, 5);
    const Film c = picture_of(scene, renderer, 12, samples, 7, 3, 9);
    for (int i = 0; i < 144; ++i) {
        EXPECT_EQ(a.at(i % 12, i / 12), b.at(i % 12, i / 12)) << renderer << " pixel " << i;
        EXPECT_EQ(a.at(i % 12, i / 12), c.at(i % 12, i / 12)) << renderer << " pixel " << i;
    }
}

inline Rgb mean_of(const Film& film) {
    Rgb sum;
    const int n = film.frame_width();
    for (int i = 0; i < n * n; ++i) sum += film.at(i % n, i / n);
    return (1.0 / (n * n)) * sum;
}

/// How the mean of pictures is compared with a value; errors are relative to it.
struct MeanBounds {
    int samples = 256;
    double largest_error = 0.0;  ///< of the mean of all pictures
    double bias = 1e-9;          ///< beyond the errors
    int runs = 8;                ///< pictures
    double most_errors = 5.4;    ///< a t of 7 degrees of freedom is beyond in one of 1000 cases
    int side = 4;                ///< of a picture
};

/// Expects the mean of pictures of several seeds.
inline void expect_mean(const Scene& scene, const std::string& renderer, const Rgb& expected,
                        const MeanBounds& bounds) {
    Rgb sum, squares;
    for (int run = 0; run < bounds.runs; ++run) {
        const Rgb m = mean_of(
            picture_of(scene, renderer, bounds.side, bounds.samples, std::uint64_t(1 + run)));
        sum += m;
        squares += m * m;
    }
    for (int i = 0; i < 3; ++i) {
        const double mean = sum[i] / bounds.runs;
        const double error =
            std::sqrt(std::max(0.0, squares[i] / bounds.runs - mean * mean) / (bounds.runs - 1));
        EXPECT_LE(error, bounds.largest_error * expected[i]) << renderer << " " << i;
        EXPECT_LE(std::abs(mean - expected[i]),
                  bounds.most_errors * error + bounds.bias * expected[i])
            << renderer << " " << i << ": " << mean << " +- " << error << ", expected "
            << expected[i];
    }
}

inline Sphere ball(const Vec3& center, double radius) {
    Sphere s;
    s.center = center;
    s.radius = radius;
    return s;
}

/// A scene seen along -z from (0, 0, 5) by a pinhole camera; all pixels show the same.
inline SceneMaker looking_down() {
    SceneMaker maker;
    maker.description().cameras[0].camera = look_along({0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 1e-6, 1.0);
    return maker;
}

/// A diffuse floor seen straight from above, in a picture `side` wide.
inline SceneMaker floor_from_above(double side, const Rgb& color = {1, 1, 1}) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 0.5}, {0, 0, -1}, {side, 0, 0}, {0, side, 0}};
    maker.add(rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), maker.material(matt(color)));
    return maker;
}

/// Means over blocks of pixels in independent pictures, and their standard errors.
struct Blocks {
    static constexpr int kSide = 2;
    std::vector<double> mean, error;
};

inline Blocks blocks_of(const Scene& scene, const std::string& renderer, int samples,
                        int runs = 12) {
    constexpr int kPixels = 8, kBlocks = Blocks::kSide * Blocks::kSide;
    std::vector<double> sum(kBlocks), squares(kBlocks);
    for (int run = 0; run < runs; ++run) {
        const Film film = picture_of(scene, renderer, kPixels, samples, std::uint64_t(100 + run));
        std::vector<double> own(kBlocks);
        for (int y = 0; y < kPixels; ++y) {
            for (int x = 0; x < kPixels; ++x) {
                const Rgb& c = film.at(x, y);
                own[std::size_t(y * Blocks::kSide / kPixels * Blocks::kSide +
                                x * Blocks::kSide / kPixels)] += c.r + c.g + c.b;
            }
        }
        for (std::size_t i = 0; i < own.size(); ++i) {
            const double value = own[i] * kBlocks / (3.0 * kPixels * kPixels);
            sum[i] += value;
            squares[i] += value * value;
        }
    }
    Blocks blocks;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const double mean = sum[i] / runs;
        blocks.mean.push_back(mean);
        blocks.error.push_back(
            std::sqrt(std::max(0.0, squares[i] / runs - mean * mean) / (runs - 1)));
    }
    return blocks;
}

/// A t of 22 degrees of freedom beyond it is seen in one of 10^5 draws: with three pairs of 4
/// blocks in one of 8000 scenes.
inline constexpr double kMostErrors = 5.7;

/// Fails if the means of two renderers differ by more than `most` standard errors in a block. Of
/// three and more, two are compared every day.
inline void expect_same_light(const Scene& scene, const std::string& name,
                              const std::vector<std::string>& all, int samples,
                              double most = kMostErrors) {
    const std::vector<std::string> renderers = to_compare(all, name);
    std::vector<Blocks> found;
    for (const std::string& r : renderers) found.push_back(blocks_of(scene, r, samples));
    for (std::size_t a = 0; a < found.size(); ++a) {
        for (std::size_t b = a + 1; b < found.size(); ++b) {
            for (std::size_t i = 0; i < found[a].mean.size(); ++i) {
                const double error = std::hypot(found[a].error[i], found[b].error[i]);
                EXPECT_LE(std::abs(found[a].mean[i] - found[b].mean[i]), most * error + 1e-12)
                    << name << ", block " << i << ": " << renderers[a] << " " << found[a].mean[i]
                    << ", " << renderers[b] << " " << found[b].mean[i];
            }
        }
    }
}

}  // namespace alhazen::testing
