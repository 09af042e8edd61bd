#pragma once
/// Scenes of scan lines, and their pictures.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "alhazen/renderers/core/reports/scan_line_report.h"
#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

struct ScanPicture {
    Film film;
    ScanLineReport counts;
};

inline ScanPicture scan_picture_of(SceneMaker& maker, const Camera& camera, int size,
                                   const ScanLineOptions& options = {}, AovFilm* aovs = nullptr,
                                   int samples = 1) {
    Scene scene = maker.compile();
    scene.background = {0, 0, 1};
    ScanPicture picture{Film(size, size, {0, 0, size, size}), {}};
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

/// A square along z = const.
inline Rectangle upright_square(double lo, double hi, double z) {
    return {.corner = {lo, lo, z}, .edge_u = {hi - lo, 0, 0}, .edge_v = {0, hi - lo, 0}};
}

/// Shapes of all kinds above a plane.
inline void add_mixture(SceneMaker& maker) {
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
    maker.add(maker.mesh(tetrahedron()), MaterialId{1},
              Affine::translate({1.2, 1.1, 0}) * Affine::scale({0.3, 0.3, 0.3}));
    maker.light(PointLight{.position = {3, 4, 5}});
}

/// A torus of bicubic patches that shares its points.
inline PatchMesh closed_torus() {
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

}  // namespace alhazen::testing
