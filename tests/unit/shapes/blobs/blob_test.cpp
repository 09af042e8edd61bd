#include "alhazen/shapes/blobs/blob.h"

#include <gtest/gtest.h>

#include "alhazen/shapes/quadrics/cylinder.h"
#include "alhazen/shapes/quadrics/sphere.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Random;

Blob made(const std::vector<BlobComponent>& components, double threshold) {
    Blob blob{.components = components, .threshold = threshold};
    Diagnostics diagnostics;
    blob.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    blob.prepare();
    return blob;
}

BlobComponent ball(const Vec3& center, double radius, double strength) {
    return {.base = center, .top = center, .radius = radius, .strength = strength};
}
BlobComponent rod(const Vec3& base, const Vec3& top, double radius, double strength) {
    return {.base = base, .top = top, .radius = radius, .strength = strength, .rod = true};
}

double density(const Blob& blob, const Vec3& p) {
    double sum = 0;
    for (const BlobComponent& c : blob.components) {
        Vec3 nearest = c.base;
        if (c.rod) {
            const Vec3 e = c.top - c.base;
            nearest += std::clamp(dot(p - c.base, e) / dot(e, e), 0.0, 1.0) * e;
        }
        const double q = 1 - length_squared(p - nearest) / (c.radius * c.radius);
        if (q > 0) sum += c.strength * q * q;
    }
    return sum;
}

TEST(Blob, OfOneBallIsASphere) {
    // 2 (1 - r^2 / 9)^2 = 1/2 at r^2 = 9 / 2.
    const Blob blob = made({ball({1, -2, 3}, 3, 2)}, 0.5);
    const Sphere sphere{.center = {1, -2, 3}, .radius = std::sqrt(4.5)};
    Random random(71);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 d = random.unit_vector();
        const double far = random.log_uniform(0.1, 1e5);
        const Ray ray = line(sphere.center + 2.5 * random.unit_vector() - far * d, d);
        ShapeHits hits;
        blob.intersect(ray, hits);
        ShapeHit expected[2];
        const int n = sphere.intersect(ray, expected);
        if (n == 2 && expected[1].t - expected[0].t < 1e-6 * std::sqrt(far)) continue;
        ASSERT_EQ(static_cast<int>(hits.size()), n) << i;
        for (int k = 0; k < n; ++k) {
            const double chord = expected[1].t - expected[0].t;
            ASSERT_NEAR(hits[k].t, expected[k].t, 1e-14 * (10 + far) * (1 + 10 / chord)) << i;
            ASSERT_LT(
                length(blob.surface(ray, hits[k]).normal - sphere.surface(ray, expected[k]).normal),
                1e-12 * (10 + far) * (1 + 10 / chord));
        }
    }
}

TEST(Blob, OfOneRodIsACylinderWithRoundEnds) {
    const double r = std::sqrt(0.5);
    const Blob blob = made({rod({0, 0, -2}, {0, 0, 2}, 1, 1)}, 0.25);
    Cylinder side{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = r};
    side.prepare();
    const Sphere low{.center = {0, 0, -2}, .radius = r}, high{.center = {0, 0, 2}, .radius = r};
    Random random(72);
    for (int i = 0; i < 20000; ++i) {
        Vec3 d = random.in_cube(1);
        if (i % 5 == 0) d = {0, 0, 1};
        if (i % 5 == 1) d.z = 0;
        const Vec3 target{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
        const Ray ray = line(target - 5.0 * d, d);
        // Convex hull of the intervals in the three convex parts of the convex whole.
        double entry = 1e9, exit = -1e9;
        ShapeHit part[2];
        const auto include = [&](int n) {
            if (n != 2) return;
            entry = std::min(entry, part[0].t);
            exit = std::max(exit, part[1].t);
        };
        include(side.intersect(ray, part));
        include(low.intersect(ray, part));
        include(high.intersect(ray, part));
        if (exit > entry && exit - entry < 1e-5) continue;
        ShapeHits hits;
        blob.intersect(ray, hits);
        ASSERT_EQ(hits.size(), exit > entry ? 2u : 0u) << i;
        if (hits.empty()) continue;
        ASSERT_NEAR(hits[0].t, entry, 1e-9) << i;
        ASSERT_NEAR(hits[1].t, exit, 1e-9) << i;
    }
}

Blob random_blob(Random& random, int count) {
    std::vector<BlobComponent> components;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = random.in_cube(4);
        const double r = random.uniform(0.6, 2.5), s = random.below(5) == 0 ? -1.0 : 1.5;
        components.push_back(random.below(3) == 0 ? rod(p, p + random.in_cube(3), r, s)
                                                  : ball(p, r, s));
    }
    return made(components, 0.6);
}

TEST(Blob, ItsCrossingsAreWhereTheDensityIsTheThresholdAndNowhereElse) {
    Random random(73);
    int crossings = 0, most = 0;
    for (int k = 0; k < 40; ++k) {
        const Blob blob = random_blob(random, 2 + k);
        for (int i = 0; i < 100; ++i) {
            const Vec3 d = random.unit_vector();
            const Ray ray = line(random.in_cube(4) - 10.0 * d, d);
            ShapeHits hits;
            blob.intersect(ray, hits);
            ASSERT_EQ(hits.size() % 2, 0u);
            for (const ShapeHit& hit : hits) {
                ASSERT_NEAR(density(blob, ray.at(hit.t)), blob.threshold, 1e-11) << k << " " << i;
            }
            // Entries and exits agree with the transitions of densely spaced samples.
            std::size_t next = 0;
            for (int s = 0; s < 400; ++s) {
                const double t = 20.0 * (s + 0.5) / 400;
                while (next < hits.size() && hits[next].t < t) ++next;
                const double over = density(blob, ray.at(t)) - blob.threshold;
                if (std::abs(over) < 1e-9) continue;
                ASSERT_EQ(over > 0, next % 2 == 1) << k << " " << i << " at " << t;
            }
            crossings += static_cast<int>(hits.size());
            most = std::max(most, static_cast<int>(hits.size()));
        }
    }
    EXPECT_GT(crossings, 4000);
    EXPECT_GE(most, 6);
}

TEST(Blob, AHundredThousandBallsAreTheSumOfThoseNearTheRay) {
    Random random(74);
    std::vector<BlobComponent> components;
    for (int i = 0; i < 100000; ++i) components.push_back(ball(random.in_cube(50), 1.2, 1));
    const Blob blob = made(components, 0.6);
    for (int i = 0; i < 20; ++i) {
        const Vec3 d = random.unit_vector();
        const Ray ray = line(random.in_cube(40) - 100.0 * d, d);
        Blob few{.threshold = 0.6};
        for (const BlobComponent& c : components) {
            const Vec3 f = c.base - ray.origin;
            if (length(f - dot(f, d) * d) < 1.3) few.components.push_back(c);
        }
        few.prepare();
        ShapeHits all, some;
        blob.intersect(ray, all);
        few.intersect(ray, some);
        ASSERT_EQ(all.size(), some.size()) << i;
        EXPECT_GT(all.size(), 10u);
        for (std::size_t k = 0; k < all.size(); ++k) ASSERT_NEAR(all[k].t, some[k].t, 1e-9);
    }
}

TEST(Blob, RefusesWhatItCannotBe) {
    Diagnostics diagnostics;
    Blob{}.validate({}, diagnostics);
    Blob{.components = {ball({0, 0, 0}, 1, 1)}, .threshold = 0}.validate({}, diagnostics);
    Blob{.components = {ball({0, 0, 0}, -1, 1)}}.validate({}, diagnostics);
    Blob{.components = {rod({0, 0, 0}, {0, 0, 0}, 1, 1)}}.validate({}, diagnostics);
    Blob{.components = {ball({0, 0, 0}, 1, std::nan(""))}}.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 5u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
