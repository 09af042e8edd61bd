// kFields describes each shape completely: a copy of these fields alone is the same shape.

#include "alhazen/shapes/core/fields.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "alhazen/base/diagnostics.h"
#include "support/random_shapes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

template <class S>
void expect_described_by_its_fields() {
    testing::Random random(3);
    std::size_t crossings = 0;
    for (int i = 0; i < 100; ++i) {
        const S shape = testing::random_shape<S>({random, i % 2 == 1});
        S copy;
        for_each_field<S>([&](const auto& field) { copy.*field.member = shape.*field.member; });
        copy.prepare();
        for (int k = 0; k < 20; ++k) {
            const Box3 box = shape.box();
            Vec3 target = random.in_cube(3);
            for (int axis = 0; axis < 3; ++axis) {
                if (!std::isfinite(box.lo[axis]) || !std::isfinite(box.hi[axis])) continue;
                target[axis] = random.uniform(box.lo[axis], box.hi[axis]);
            }
            const Ray ray = testing::line(target, random.unit_vector());
            ShapeHits hits, copy_hits;
            append_hits(shape, ray, hits);
            append_hits(copy, ray, copy_hits);
            ASSERT_EQ(hits.size(), copy_hits.size()) << S::kName;
            crossings += hits.size();
            for (std::size_t h = 0; h < hits.size(); ++h) {
                ASSERT_EQ(hits[h].t, copy_hits[h].t) << S::kName;
            }
        }
    }
    EXPECT_GT(crossings, 0U) << S::kName;
}

template <class... S>
void expect_all_described(ShapeTypes<S...>) {
    (expect_described_by_its_fields<S>(), ...);
}

TEST(ShapeFields, DescribeEveryShapeCompletely) {
    expect_all_described(AnalyticShapes{});
}

TEST(ShapeFields, FindingsHaveTheNumberThatWasGiven) {
    for (const auto& [radius, text] :
         {std::pair{1e-310, "not 1e-310"}, {-2.5, "not -2.5"}, {1e71, "not 1e+71"}}) {
        Sphere ball;
        ball.radius = radius;
        Diagnostics diagnostics;
        ball.validate({}, diagnostics);
        ASSERT_EQ(diagnostics.error_count(), 1u);
        const std::string& found = diagnostics.all()[0].message;
        EXPECT_NE(found.find(text), std::string::npos) << found;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
