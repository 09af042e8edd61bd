#include "alhazen/imaging/film/filter_integral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "alhazen/base/error.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::vector<const FilterEntry*> filters_with_integral() {
    std::vector<const FilterEntry*> result;
    for (const FilterEntry& entry : filters()) {
        if (entry.integral != nullptr) result.push_back(&entry);
    }
    return result;
}

double over(const FilterIntegral& filter, const std::vector<Vec2>& loop) {
    double sum = 0.0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        sum += filter.along(loop[k], loop[(k + 1) % loop.size()]);
    }
    return sum;
}

TEST(FilterIntegral, IsTheAntiderivativeOfTheKernel) {
    for (const FilterEntry* entry : filters_with_integral()) {
        for (const double radius : {entry->radius, 1.3}) {
            EXPECT_EQ(entry->integral(0.0, radius), 0.0) << entry->name;
            for (const double x : {-0.93, -0.41, 0.17, 0.31, 0.77}) {
                const double at = x * radius, h = 1e-5;
                EXPECT_NEAR(
                    (entry->integral(at + h, radius) - entry->integral(at - h, radius)) / (2.0 * h),
                    entry->value(at, radius), 1e-8)
                    << entry->name << " at " << at;
            }
        }
    }
}

TEST(FilterIntegral, OfThePlaneIsOneAndOfARectangleAProduct) {
    for (const FilterEntry* entry : filters_with_integral()) {
        for (const double radius : {entry->radius, 0.9, 2.7}) {
            const FilterIntegral filter(*entry, radius);
            EXPECT_NEAR(over(filter, {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}), 1.0, 1e-12);
            EXPECT_NEAR(over(filter, {{-0.3, 0.1}, {0.8, 0.1}, {0.8, 0.7}, {-0.3, 0.7}}),
                        filter.between(-0.3, 0.8) * filter.between(0.1, 0.7), 1e-10)
                << entry->name << " " << radius;
        }
    }
}

TEST(FilterIntegral, OfATriangleIsThatByMidpoints) {
    const std::vector<Vec2> corners{{-1.1, -0.9}, {1.4, -0.3}, {0.2, 1.2}};
    constexpr int kSteps = 400;
    for (const FilterEntry* entry : filters_with_integral()) {
        // Steps of the box are no matter for midpoints.
        if (entry->name == std::string("box")) continue;
        const double r = entry->radius;
        const FilterIntegral filter(*entry, r);
        const Vec2 u = corners[1] - corners[0], v = corners[2] - corners[0];
        const double area = 0.5 * (u.x * v.y - u.y * v.x) / (kSteps * kSteps);
        double sum = 0.0;
        const auto add = [&](double s, double t) {
            const Vec2 p = corners[0] + (s / kSteps) * u + (t / kSteps) * v;
            if (std::abs(p.x) > r || std::abs(p.y) > r) return;
            sum += area * entry->value(p.x, r) * entry->value(p.y, r);
        };
        for (int i = 0; i < kSteps; ++i) {
            for (int j = 0; i + j < kSteps; ++j) {
                add(i + 1.0 / 3.0, j + 1.0 / 3.0);
                if (i + j + 1 < kSteps) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
            }
        }
        const double whole = 2.0 * entry->integral(r, r);
        EXPECT_NEAR(over(filter, corners), sum / (whole * whole), 2e-5) << entry->name;
    }
}

TEST(FilterIntegral, OfPartsAddsUp) {
    for (const FilterEntry* entry : filters_with_integral()) {
        const FilterIntegral filter(*entry, entry->radius);
        const Vec2 middle{0.137, -0.211};
        const std::vector<Vec2> ring{{-4, -3}, {3, -4}, {4, 3}, {-0.3, 4.5}, {-4, 3.3}};
        double sum = 0.0;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            sum += over(filter, {middle, ring[k], ring[(k + 1) % ring.size()]});
        }
        EXPECT_NEAR(sum, 1.0, 1e-9) << entry->name;
    }
}

TEST(FilterIntegral, WithoutClosedFormIsRefused) {
    EXPECT_THROW(FilterIntegral(*find_filter("lanczos"), 3.0), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
