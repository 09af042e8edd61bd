#include "alhazen/shapes/meshes/height_field.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/polygons/box_shape.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Random;

template <class Height>
HeightField made(std::uint32_t columns, std::uint32_t rows, Height height) {
    auto heights = std::make_shared<std::vector<float>>();
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) heights->push_back(float(height(i, j)));
    }
    HeightField field{.columns = columns, .rows = rows, .heights = heights};
    field.lo = {-2, -1};
    field.hi = {3, 2};
    Diagnostics diagnostics;
    field.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    field.prepare();
    return field;
}

std::uint32_t part_count(const HeightField& f) {
    return 4 * f.cells() + 4 * (f.columns - 1 + f.rows - 1);
}

TEST(HeightField, ItsTrianglesAreAClosedMeshTurnedOutward) {
    Random random(81);
    for (const auto& [columns, rows] : {std::pair{2u, 2u}, {2u, 5u}, {6u, 3u}, {9u, 9u}}) {
        const auto field = made(columns, rows, [&](auto, auto) { return random.uniform(0, 1); });
        TriangleMesh mesh;
        for (std::uint32_t part = 0; part < part_count(field); ++part) {
            const auto n = static_cast<std::uint32_t>(mesh.positions.size());
            for (const Vec3& p : field.triangle(part)) mesh.positions.push_back(p);
            mesh.triangles.push_back({n, n + 1, n + 2});
        }
        EXPECT_TRUE(mesh.closed()) << columns << " x " << rows;
        double mean = 0;
        for (std::uint32_t j = 0; j + 1 < rows; ++j) {
            for (std::uint32_t i = 0; i + 1 < columns; ++i) {
                const double a = field.height(i, j), c = field.height(i + 1, j + 1);
                mean += (2 * a + 2 * c + field.height(i + 1, j) + field.height(i, j + 1)) / 6;
            }
        }
        // Volume under the two triangles of each cell, down to the base at -1.
        EXPECT_NEAR(signed_volume(mesh), 15 * (1 + mean / field.cells()), 1e-12);
    }
}

TEST(HeightField, MeetsWhatItsTrianglesDoAndNothingElse) {
    Random random(82);
    int crossings = 0;
    for (int k = 0; k < 60; ++k) {
        const auto columns = std::uint32_t(2 + random.below(20));
        const auto rows = std::uint32_t(2 + random.below(20));
        const bool lattice = k % 2 == 1;
        const auto field = made(columns, rows, [&](auto, auto) {
            return lattice ? 0.5 * random.below(3) : random.uniform(-0.9, 1);
        });
        for (int i = 0; i < 60; ++i) {
            const Vec3 target{random.uniform(-2, 3), random.uniform(-1, 2), random.uniform(-1, 1)};
            Vec3 d = random.unit_vector();
            if (i % 3 == 0) d.z *= 0.01;
            Ray ray = line(target - random.log_uniform(1, 1e4) * d, d);
            if (lattice && i % 2 == 0) {
                ray = line(random.on_lattice(3, 0.25), random.lattice_direction());
            }
            std::vector<ShapeHit> expected;
            const RayShear shear(ray.direction);
            for (std::uint32_t part = 0; part < part_count(field); ++part) {
                const auto [a, b, c] = field.triangle(part);
                ShapeHit hit;
                if (intersect_triangle(ray, shear, a, b, c, hit)) {
                    hit.part = part;
                    expected.push_back(hit);
                }
            }
            ShapeHits hits;
            field.intersect(ray, hits);
            ASSERT_EQ(hits.size(), expected.size()) << k << " " << i;
            for (std::size_t n = 1; n < hits.size(); ++n) ASSERT_LE(hits[n - 1].t, hits[n].t);
            for (const ShapeHit& e : expected) {
                const auto found = std::find_if(
                    hits.begin(), hits.end(), [&](const ShapeHit& h) { return h.part == e.part; });
                ASSERT_NE(found, hits.end()) << k << " " << i;
                // Clamping to the box may cost the last digits.
                ASSERT_NEAR(found->t, e.t, 1e-10 * (1 + std::abs(e.t)));
            }
            crossings += int(hits.size());
        }
    }
    EXPECT_GT(crossings, 4000);
}

TEST(HeightField, OfOneHeightIsABox) {
    const auto field = made(17, 9, [](auto, auto) { return 0.75; });
    const BoxShape box{.lo = {-2, -1, -1}, .hi = {3, 2, 0.75}};
    Random random(83);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 d = random.unit_vector();
        const Ray ray = line(random.in_cube(3) - 5.0 * d, d);
        ShapeHits hits;
        field.intersect(ray, hits);
        ShapeHit expected[2];
        ASSERT_EQ(int(hits.size()), box.intersect(ray, expected)) << i;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            ASSERT_NEAR(hits[k].t, expected[k].t, 1e-13);
            ASSERT_LT(
                length(field.surface(ray, hits[k]).normal - box.surface(ray, expected[k]).normal),
                1e-14);
        }
    }
}

TEST(HeightField, OfAMillionSamplesAnswersAtOnce) {
    const auto field = made(1025, 1025, [](double i, double j) {
        return 0.2 * std::sin(i * 0.05) * std::cos(j * 0.07) + 0.01 * std::sin(i * j);
    });
    Random random(84);
    int hit = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 d = random.unit_vector();
        const Ray ray = line(Vec3{0.5, 0.5, 0.2} + random.in_cube(1) - 5.0 * d, d);
        ShapeHits first(1);
        field.intersect(ray, first);
        hit += !first.empty();
        if (i % 20 != 0) continue;
        ShapeHits all;
        field.intersect(ray, all);
        ASSERT_EQ(all.size() % 2, 0u) << i;
        ASSERT_EQ(all.empty(), first.empty());
        if (all.empty()) continue;
        ASSERT_EQ(all.front().t, first.front().t);
    }
    EXPECT_GT(hit, 15000);
}

TEST(HeightField, RefusesWhatIsNotAboveItsBase) {
    Diagnostics diagnostics;
    const auto check = [&](HeightField field, std::vector<float> heights) {
        field.heights = std::make_shared<std::vector<float>>(std::move(heights));
        field.validate({}, diagnostics);
        return diagnostics.all().back().message;
    };
    const HeightField square{.columns = 2, .rows = 2};
    EXPECT_NE(check(square, {0, 0, 0, -1}).find("above the base"), std::string::npos);
    EXPECT_NE(check(square, {0, 0, 0, std::nanf("")}).find("above the base"), std::string::npos);
    EXPECT_NE(check(square, {0, 0, 0}).find("expected 2 x 2 heights, found 3"), std::string::npos);
    EXPECT_NE(check({.columns = 1, .rows = 4}, {0, 0, 0, 0}).find("at least 2 x 2"),
              std::string::npos);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
