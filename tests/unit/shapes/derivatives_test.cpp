// dpdu and dpdv of every shape against differences of neighbouring points.

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "support/random_shapes.h"
#include "support/thorough.h"
#include "tested_shape.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Random;
using testing::random_shape;
using testing::ShapeSource;
using testing::TestedShape;

struct DerivedType {
    const char* name;
    bool periodic;  ///< in u
    int rays_per_shape;
    TestedShape (*make)(const ShapeSource& from);
};

/// Surfaces of many patches take longer to build than many rays to trace.
template <class S>
constexpr int kRaysOfShape =
    std::is_same_v<S, PatchMesh> || std::is_same_v<S, NurbsSurface> ? 4 : 1;

template <class... S>
std::vector<DerivedType> derived_types(const ShapeTypes<S...>*) {
    return {{S::kName, !std::is_same_v<S, Plane> && !std::is_same_v<S, Polygon>, kRaysOfShape<S>,
             [](const ShapeSource& from) { return TestedShape(random_shape<S>(from)); }}...};
}

class ShapeDerivatives : public ::testing::TestWithParam<DerivedType> {};
INSTANTIATE_TEST_SUITE_P(, ShapeDerivatives,
                         ::testing::ValuesIn(derived_types(static_cast<AnalyticShapes*>(nullptr))),
                         [](const auto& type) { return std::string(type.param.name); });

/// Removes a jump of u by one turn.
double shorter_turn(double difference) {
    return difference - std::round(difference);
}

Vec3 target_on(const TestedShape& shape, Random& random) {
    const Box3 box = shape.box();
    Vec3 p = random.in_cube(30);
    for (int k = 0; k < 3; ++k) {
        if (std::isfinite(box.lo[k])) p[k] = random.uniform(box.lo[k], box.hi[k]);
    }
    return p;
}

TEST_P(ShapeDerivatives, PredictTheNextPoint) {
    const bool periodic = GetParam().periodic;
    const int rays_per_shape = GetParam().rays_per_shape;
    Random random(11);
    int compared = 0;
    std::optional<TestedShape> made;
    // Every day a quarter of them.
    const int rays = testing::cases(1000, 4000);
    for (int i = 0; i < rays; ++i) {
        if (i % rays_per_shape == 0) {
            made.emplace(GetParam().make(ShapeSource{random, i / rays_per_shape % 4 == 3}));
        }
        const TestedShape& shape = *made;
        const Vec3 direction = random.unit_vector();
        const Vec3 origin = target_on(shape, random) - 40.0 * direction;
        ShapeHits hits;
        const Ray ray = line(origin, direction);
        shape.intersect(ray, hits);
        if (hits.empty()) continue;
        const ShapeSurface a = shape.surface(ray, hits[0]);
        // At grazing rays and near a pole the next point is not close.
        if (std::abs(dot(a.normal, direction)) < 0.3) continue;
        if (length(a.dpdu) < 0.02 * length(a.dpdv)) continue;
        // Relative error of the prediction for a neighbour at a distance; negative: none is close.
        const Vec3 aside = random.unit_vector();
        const auto error_at = [&](double step) {
            ShapeHits next_hits;
            const Ray next = line(origin + step * aside, direction);
            shape.intersect(next, next_hits);
            if (next_hits.empty() || next_hits[0].part != hits[0].part) return -1.0;
            // Sheets of a folded plane are met at one t, in any order: the same sheet is compared.
            const ShapeHit* same = &next_hits[0];
            const auto distance = [&](const ShapeHit& hit) {
                return std::abs(hit.u - hits[0].u) + std::abs(hit.v - hits[0].v);
            };
            for (const ShapeHit& hit : next_hits) {
                const bool is_tie = std::abs(hit.t - next_hits[0].t) <= 1e-14 * next_hits[0].t;
                if (is_tie && hit.part == hits[0].part && distance(hit) < distance(*same)) {
                    same = &hit;
                }
            }
            const ShapeSurface b = shape.surface(next, *same);
            if (dot(a.normal, b.normal) < 0.99) return -1.0;
            const Vec3 moved = b.point - a.point;
            if (length(moved) < 0.1 * step || length(moved) > 10 * step) return -1.0;
            const double du = periodic ? shorter_turn(b.uv.x - a.uv.x) : b.uv.x - a.uv.x;
            const Vec3 predicted = du * a.dpdu + (b.uv.y - a.uv.y) * a.dpdv;
            const double rounding = 1e-12 * length(a.point);
            return std::fmax(length(moved - predicted) - rounding, 0.0) / length(moved);
        };
        const double step = 1e-5 * std::fmin(length(a.dpdu), length(a.dpdv));
        const double error = error_at(step);
        if (error < 0.0) continue;
        // Where derivatives of second order are large, the error falls with the step.
        if (error >= 2e-3) {
            ASSERT_LT(error_at(step / 16.0), error / 8.0) << "case " << i;
        }
        ++compared;
    }
    EXPECT_GT(40 * compared, 3 * rays);
}

TEST(TriangleDerivatives, FollowTheTextureCoordinatesOfTheVertices) {
    Random random(12);
    TriangleMesh mesh;
    mesh.triangles = {{0, 1, 2}};
    for (int i = 0; i < 200; ++i) {
        mesh.positions.clear();
        mesh.uvs.clear();
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(random.in_cube(5));
            mesh.uvs.push_back({random.uniform(-2, 2), random.uniform(-2, 2)});
        }
        const ShapeSurface a = mesh.surface(0, {1.0, 0.2, 0.3, 0});
        const ShapeSurface b = mesh.surface(0, {1.0, 0.5, 0.1, 0});
        const Vec3 predicted = (b.uv.x - a.uv.x) * a.dpdu + (b.uv.y - a.uv.y) * a.dpdv;
        const double size = length(a.dpdu) + length(a.dpdv);
        EXPECT_LT(length(b.point - a.point - predicted), 1e-11 * (1 + size)) << i;
    }
}

TEST(TriangleDerivatives, AreZeroWhereTheCoordinatesDoNotTell) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.uvs = {{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}};
    const ShapeSurface s = mesh.surface(0, {1.0, 0.2, 0.3, 0});
    EXPECT_EQ(s.dpdu, Vec3{});
    EXPECT_EQ(s.dpdv, Vec3{});
}

TEST(TriangleDerivatives, WithoutCoordinatesAreThoseOfTheBarycentrics) {
    TriangleMesh mesh;
    mesh.positions = {{1, 1, 1}, {3, 1, 1}, {1, 4, 1}};
    mesh.triangles = {{0, 1, 2}};
    const ShapeSurface s = mesh.surface(0, {1.0, 0.2, 0.3, 0});
    EXPECT_EQ(s.dpdu, (Vec3{2, 0, 0}));
    EXPECT_EQ(s.dpdv, (Vec3{0, 3, 0}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
