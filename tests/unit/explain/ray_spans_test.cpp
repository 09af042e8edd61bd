#include "alhazen/explain/spans/ray_spans.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/explain/spans/polynomials_on_ray.h"
#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "support/scene_maker.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using Spans = std::vector<TSpan>;

/// The three columns of table 15.2 on four stretches: in left, both, right, neither.
TEST(CsgSpans, EveryRowOfTheTableIsThatOfRoth) {
    const Spans left{{0, 2}}, right{{1, 3}};
    EXPECT_EQ(combined(Combine::Union, left, right), (Spans{{0, 3}}));
    EXPECT_EQ(combined(Combine::Intersection, left, right), (Spans{{1, 2}}));
    EXPECT_EQ(combined(Combine::Difference, left, right), (Spans{{0, 1}}));
    EXPECT_EQ(combined(Combine::Difference, right, left), (Spans{{2, 3}}));
}
TEST(CsgSpans, NothingAndEndlessSpansCombine) {
    const Spans none, some{{1, 2}, {4, kInfinity}};
    EXPECT_EQ(combined(Combine::Union, none, some), some);
    EXPECT_EQ(combined(Combine::Intersection, none, some), none);
    EXPECT_EQ(combined(Combine::Difference, some, none), some);
    EXPECT_EQ(combined(Combine::Difference, some, some), none);
    EXPECT_EQ(combined(Combine::Intersection, some, {{0, 5}}), (Spans{{1, 2}, {4, 5}}));
}
TEST(CsgSpans, SpansThatTouchAreOne) {
    EXPECT_EQ(combined(Combine::Union, {{0, 1}}, {{1, 2}}), (Spans{{0, 2}}));
}

LoadedScene loaded_file(const std::string& name) {
    return load(testing::source_folder() / "scenes" / name);
}

/// The combination of the leaves' spans equals the solid's, on rays through it.
TEST(RaySpans, TheCombinationIsThatOfTheSolid) {
    for (const char* name : {"machined_part.alhazen", "glass_of_wine.alhazen", "solids.alhazen"}) {
        SCOPED_TRACE(name);
        const LoadedScene loaded = loaded_file(name);
        const CameraDescription& camera = loaded.scene.cameras.front();
        RandomStream random(3);
        int compared = 0;
        for (int i = 0; i < 300; ++i) {
            const double x = random.uniform(0.2, 0.8), y = random.uniform(0.2, 0.8);
            for (const SolidSpans& solid : solid_spans(loaded, eye_ray(camera.camera, x, y))) {
                if (!solid.combination) continue;
                ++compared;
                ASSERT_EQ(solid.combination->spans.size(), solid.spans.size()) << i;
                for (std::size_t k = 0; k < solid.spans.size(); ++k) {
                    EXPECT_NEAR(solid.combination->spans[k].from, solid.spans[k].from, 1e-9);
                    EXPECT_NEAR(solid.combination->spans[k].to, solid.spans[k].to, 1e-9);
                }
            }
        }
        EXPECT_GT(compared, 50);
    }
}

double value_at(const PolynomialOnRay& p, double t) {
    std::vector<double> b = p.bernstein;
    const double u = (t - p.from) / (p.to - p.from);
    for (std::size_t n = b.size() - 1; n > 0; --n) {
        for (std::size_t i = 0; i < n; ++i) b[i] = (1 - u) * b[i] + u * b[i + 1];
    }
    return b[0];
}
double largest(const PolynomialOnRay& p) {
    double size = 0;
    for (const double b : p.bernstein) size = std::fmax(size, std::abs(b));
    return size;
}

TEST(PolynomialsOnRay, OfASphereIsTheParabolaOfItsEquation) {
    SceneMaker scene;
    scene.material({});
    scene.add(Sphere{{0, 0, 0}, 2});
    LoadedScene loaded;
    loaded.description = scene.description();
    loaded.scene = compile(loaded.description);
    const auto found = polynomials_on_ray(loaded, {{1, 0, 5}, {0, 0, -1}});
    ASSERT_EQ(found.size(), 1u);
    const PolynomialOnRay& p = found.front();
    EXPECT_EQ(p.degree, 2);
    ASSERT_EQ(p.roots.size(), 2u);
    EXPECT_NEAR(p.roots[0], 5 - std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(p.roots[1], 5 + std::sqrt(3.0), 1e-12);
    for (const double t : {3.0, 4.5, 6.9}) {
        EXPECT_NEAR(value_at(p, t), (1 + (5 - t) * (5 - t)) / 4 - 1, 1e-12) << t;
    }
}

/// Roots are zeros of the polynomial, whose sign differs on their two sides.
TEST(PolynomialsOnRay, RootsAreItsZeros) {
    for (const char* name : {"algebraic.alhazen", "quadrics.alhazen", "solids.alhazen"}) {
        SCOPED_TRACE(name);
        const LoadedScene loaded = loaded_file(name);
        RandomStream random(4);
        int roots = 0;
        for (int i = 0; i < 400; ++i) {
            const double x = random.uniform(0, 1), y = random.uniform(0, 1);
            const Ray ray = eye_ray(loaded.scene.cameras.front().camera, x, y);
            for (const PolynomialOnRay& p : polynomials_on_ray(loaded, ray)) {
                ASSERT_EQ(p.bernstein.size(), static_cast<std::size_t>(p.degree) + 1);
                for (const double t : p.roots) {
                    ++roots;
                    EXPECT_LT(std::abs(value_at(p, t)), 1e-9 * largest(p)) << p.part;
                }
            }
        }
        EXPECT_GT(roots, 50);
    }
}

TEST(PolynomialsOnRay, EveryChangeOfSignInTheRangeIsARoot) {
    for (const char* name : {"algebraic.alhazen", "quadrics.alhazen", "solids.alhazen"}) {
        SCOPED_TRACE(name);
        const LoadedScene loaded = loaded_file(name);
        RandomStream random(5);
        int changes = 0;
        for (int i = 0; i < 200; ++i) {
            const double x = random.uniform(0, 1), y = random.uniform(0, 1);
            const Ray ray = eye_ray(loaded.scene.cameras.front().camera, x, y);
            for (const PolynomialOnRay& p : polynomials_on_ray(loaded, ray)) {
                constexpr int kSteps = 200;
                const double step = (p.to - p.from) / kSteps, least = 1e-9 * largest(p);
                EXPECT_GE(p.from, 0.0);
                for (int k = 0; k < kSteps; ++k) {
                    const double a = value_at(p, p.from + k * step),
                                 b = value_at(p, p.from + (k + 1) * step);
                    if (std::abs(a) < least || std::abs(b) < least || (a > 0) == (b > 0)) continue;
                    ++changes;
                    bool found = false;
                    for (const double t : p.roots) {
                        found |= std::abs(t - p.from - (k + 0.5) * step) < 0.6 * step;
                    }
                    EXPECT_TRUE(found) << p.part << ' ' << p.from + k * step;
                }
            }
        }
        EXPECT_GT(changes, 25);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
