#include "alhazen/geometry/box.h"

#include <gtest/gtest.h>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/hit.h"
#include "support/quad.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Quad;
using testing::QuadVec;
using testing::Random;

const Box3 kUnit{{0, 0, 0}, {1, 1, 1}};

TEST(Box3, IsEmptyUntilSomethingIsIncluded) {
    Box3 box;
    EXPECT_TRUE(box.empty());
    EXPECT_EQ(box.size(), Vec3{});
    EXPECT_EQ(box.half_area(), 0.0);
    EXPECT_EQ(padded(box), box);
    EXPECT_TRUE(transformed(Affine::translate({1, 2, 3}), box).empty());
    box.include(Vec3{1, 2, 3});
    EXPECT_FALSE(box.empty());
    EXPECT_TRUE(box.contains({1, 2, 3}));
    EXPECT_EQ(box.size(), Vec3{});
    box.include(kUnit);
    EXPECT_EQ(box, (Box3{{0, 0, 0}, {1, 2, 3}}));
    EXPECT_EQ(box.half_area(), 11.0);
    EXPECT_EQ(box.center(), (Vec3{0.5, 1, 1.5}));
    EXPECT_EQ(box.corner(5), (Vec3{1, 0, 3}));
}

TEST(Box3, PaddingGrowsEverySideByAFewUlp) {
    const Box3 box = padded({{-8, 0, 1}, {-4, 1, 1}});
    EXPECT_LT(box.lo.x, -8.0);
    EXPECT_GT(box.hi.x, -4.0);
    EXPECT_LT(box.lo.z, 1.0);
    EXPECT_GT(box.hi.z, 1.0);
    EXPECT_NEAR(box.lo.x, -8.0, 1e-14);
}

TEST(Box3, TransformedHoldsTheExactImage) {
    Random random(91);
    for (int i = 0; i < 20000; ++i) {
        Box3 box;
        box.include(random.in_cube(100));
        box.include(random.in_cube(100));
        // Rotation about a distant point: large terms that nearly cancel.
        const Vec3 pivot = random.in_cube(1e6);
        const Affine move = Affine::translate(pivot) *
                            Affine::rotate(random.unit_vector(), random.uniform(0, 6)) *
                            Affine::translate(-pivot);
        const Box3 image = transformed(move, box);
        const Vec3 s = box.size();
        Vec3 p = box.corner(random.below(8));
        if (random.coin()) p = box.lo + Vec3{random.uniform() * s.x, s.y, random.uniform() * s.z};
        if (!box.contains(p)) continue;
        const Mat3& m = move.linear;
        const QuadVec q = Quad(p.x) * QuadVec(m.x_axis) + Quad(p.y) * QuadVec(m.y_axis) +
                          Quad(p.z) * QuadVec(m.z_axis) + QuadVec(move.translation);
        ASSERT_TRUE(image.lo.x <= q.x && q.x <= image.hi.x && image.lo.y <= q.y &&
                    q.y <= image.hi.y && image.lo.z <= q.z && q.z <= image.hi.z)
            << "seed 91, case " << i;
        ASSERT_LE(length(image.size()), 3.01 * length(box.size()) + 1e-8) << i;
    }
}

TEST(Box3, TransformedUnboundedBoxesAreEverything) {
    const double inf = std::numeric_limits<double>::infinity();
    const Box3 slab{{-inf, -inf, 0}, {inf, inf, 1}};
    const Box3 image = transformed(Affine::scale({0, 1, 1}), slab);
    EXPECT_EQ(image.lo, (Vec3{-inf, -inf, -inf}));
    EXPECT_EQ(image.hi, (Vec3{inf, inf, inf}));
}

TEST(BoxExtent, IsTheRangeOverTheCorners) {
    Random random(92);
    for (int i = 0; i < 1000; ++i) {
        Box3 box;
        box.include(random.in_cube(3));
        box.include(random.in_cube(3));
        const Vec3 axis = random.coin() ? random.unit_vector() : random.lattice_direction();
        Interval corners;
        for (int k = 0; k < 8; ++k) corners.include(dot(axis, box.corner(k)));
        EXPECT_NEAR(extent(box, axis).lo, corners.lo, 1e-14) << "seed 92, case " << i;
        EXPECT_NEAR(extent(box, axis).hi, corners.hi, 1e-14) << "seed 92, case " << i;
    }
    const double inf = std::numeric_limits<double>::infinity();
    const Box3 slab{{-inf, 0, -inf}, {inf, 1, inf}};
    EXPECT_EQ(extent(slab, {0, 2, -0.0}), (Interval{0, 2}));
    EXPECT_EQ(extent(slab, {1, 2, 0}), (Interval{-inf, inf}));
}

TEST(BoundsSource, ClipsToTheCellByDefault) {
    struct One final : BoundsSource {
        [[nodiscard]] std::size_t size() const override { return 1; }
        [[nodiscard]] Box3 box(std::size_t) const override { return kUnit; }
    } one;
    EXPECT_EQ(one.clipped_box(0, {{0.5, -1, 0}, {2, 2, 0.5}}), (Box3{{0.5, 0, 0}, {1, 1, 0.5}}));
    EXPECT_TRUE(one.clipped_box(0, {{2, 2, 2}, {3, 3, 3}}).empty());
}

TEST(Ray, KeepsTUnderTransforms) {
    Random random(93);
    const Affine move = Affine::translate({1, 2, 3}) * Affine::scale({2, 3, 4});
    const Ray ray{random.in_cube(2), random.in_cube(2), 0.5, 8};
    const Ray image = transformed(move, ray);
    EXPECT_EQ(image.t_min, 0.5);
    EXPECT_EQ(image.t_max, 8.0);
    EXPECT_LT(length(image.at(3) - move.point(ray.at(3))), 1e-13);
    EXPECT_TRUE(ray.covers(0.5) && ray.covers(8) && !ray.covers(8.1) && !ray.covers(std::nan("")));
}

TEST(Ray, ValidityAsksForFiniteNumbersAndADirection) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(is_valid({{0, 0, 0}, {0, 0, -1}}));
    EXPECT_FALSE(is_valid({{0, 0, 0}, {0, -0.0, 0}}));
    EXPECT_FALSE(is_valid({{0, nan, 0}, {0, 0, 1}}));
    EXPECT_FALSE(is_valid({{0, 0, 0}, {0, 0, 1}, nan, 1}));
    EXPECT_FALSE(is_valid({{0, 0, 0}, {0, 0, 1}, 2, 1}));
}

TEST(Hit, OutermostIdBreaksTies) {
    Hit hit;
    EXPECT_FALSE(hit.found());
    hit.primitive = PrimitiveId{5};
    EXPECT_EQ(hit.top(), PrimitiveId{5});
    hit.path.push_back(PrimitiveId{3});
    hit.path.push_back(PrimitiveId{9});
    EXPECT_EQ(hit.top(), PrimitiveId{9});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
