#pragma once
/// Crossings of a line with a shape, and the shape's volume by rays, for tests of exact solids.

#include <gtest/gtest.h>

#include <vector>

#include "alhazen/shapes/core/shape.h"
#include "support/random.h"

namespace alhazen::testing {

template <class S>
S prepared(S shape) {
    Diagnostics diagnostics;
    shape.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    shape.prepare();
    return shape;
}
template <class S>
std::size_t errors_of(const S& shape) {
    Diagnostics diagnostics;
    shape.validate({}, diagnostics);
    return diagnostics.error_count();
}

template <class S>
std::vector<double> crossings(const S& shape, const Vec3& origin, const Vec3& direction) {
    ShapeHits hits;
    append_hits(shape, line(origin, direction), hits);
    std::vector<double> t;
    for (const ShapeHit& hit : hits) t.push_back(hit.t);
    return t;
}
inline void expect_near(const std::vector<double>& found, const std::vector<double>& expected,
                        double tolerance = 1e-12) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], tolerance);
}

/// Outward normal at the first crossing.
template <class S>
Vec3 first_normal(const S& shape, const Vec3& origin, const Vec3& direction) {
    ShapeHits hits;
    const Ray ray = line(origin, direction);
    append_hits(shape, ray, hits);
    EXPECT_FALSE(hits.empty());
    return hits.empty() ? Vec3{} : shape.surface(ray, hits[0]).normal;
}

/// Volume by a stratified sample of lines along z through the box.
template <class S>
double volume_by_rays(const S& shape, int side = 160) {
    Random random(24);
    const Box3 box = shape.box();
    double sum = 0;
    for (int i = 0; i < side * side; ++i) {
        const double x = box.lo.x + box.size().x * (i % side + random.uniform()) / side;
        const double y =
            box.lo.y + box.size().y * (static_cast<double>(i / side) + random.uniform()) / side;
        const std::vector<double> t = crossings(shape, {x, y, 0}, {0, 0, 1});
        EXPECT_EQ(t.size() % 2, 0u);
        for (std::size_t k = 0; k + 1 < t.size(); k += 2) sum += t[k + 1] - t[k];
    }
    return sum / (side * side) * box.size().x * box.size().y;
}

}  // namespace alhazen::testing
