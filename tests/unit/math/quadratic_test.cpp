#include "alhazen/math/quadratic.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "support/quad.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Quad;
using testing::Random;

double to_double(Quad x) {
    return static_cast<double>(x);
}

TEST(DifferenceOfProducts, IsRightToOneAndAHalfUlp) {
    Random random(81);
    for (int i = 0; i < 100000; ++i) {
        const double a = random.uniform(-2, 2), b = random.uniform(-2, 2);
        double c = random.uniform(-2, 2), d = random.uniform(-2, 2);
        if (i % 2 == 0) {  // nearly equal products: plain arithmetic has no correct digit
            c = a * (1 + random.below(5) * 0x1p-52);
            d = b * (1 - random.below(5) * 0x1p-53);
        }
        const Quad exact = Quad(a) * b - Quad(c) * d;
        const double result = difference_of_products(a, b, c, d);
        const double ulp = std::abs(to_double(exact)) * 0x1p-52;
        ASSERT_LE(to_double(testing::magnitude(exact - result)), 1.5 * ulp)
            << "seed 81, case " << i << std::hexfloat << ": " << a << " " << b << " " << c << " "
            << d;
        ASSERT_EQ(result > 0, exact > 0) << "seed 81, case " << i;
        ASSERT_EQ(result < 0, exact < 0) << "seed 81, case " << i;
    }
}

TEST(Quadratic, RootsAscendAndAreRightToAFewUlp) {
    Random random(82);
    for (int i = 0; i < 100000; ++i) {
        const double a = random.sign() * random.log_uniform(1e-8, 1e8);
        const double b = random.sign() * random.log_uniform(1e-8, 1e8);
        const double c = random.sign() * random.log_uniform(1e-8, 1e8);
        const QuadraticRoots roots = solve_half_b_quadratic(a, b, c);
        const Quad discriminant = Quad(b) * b - Quad(a) * c;
        ASSERT_EQ(roots.count, discriminant >= 0 ? 2 : 0) << "seed 82, case " << i;
        if (roots.count == 0) continue;
        const Quad root = testing::square_root(discriminant);
        const Quad q = b > 0 ? -(b + root) : -(b - root);
        double t0 = to_double(q / a), t1 = to_double(c / q);
        if (t0 > t1) std::swap(t0, t1);
        ASSERT_LE(roots.t0, roots.t1);
        ASSERT_NEAR(roots.t0, t0, std::abs(t0) * 0x1p-50) << "seed 82, case " << i;
        ASSERT_NEAR(roots.t1, t1, std::abs(t1) * 0x1p-50) << "seed 82, case " << i;
    }
}

TEST(Quadratic, TheSmallRootDoesNotCancel) {
    // t^2 - 2e8 t + 1 = 0: the textbook formula gives 7.45e-9 for the small root.
    const QuadraticRoots roots = solve_half_b_quadratic(1.0, -1e8, 1.0);
    EXPECT_DOUBLE_EQ(roots.t0, 5e-9);
    EXPECT_DOUBLE_EQ(roots.t1, 2e8);
}

TEST(Quadratic, SpecialCasesAreReportedAsPromised) {
    EXPECT_EQ(solve_half_b_quadratic(1, 0, 1).count, 0);
    const QuadraticRoots twice = solve_half_b_quadratic(1, -3, 9);
    EXPECT_EQ(twice.count, 2);
    EXPECT_EQ(twice.t0, 3.0);
    EXPECT_EQ(twice.t1, 3.0);
    const QuadraticRoots zeros = solve_half_b_quadratic(2, 0, 0);
    EXPECT_EQ(zeros.count, 2);
    EXPECT_EQ(zeros.t0, 0.0);
    EXPECT_EQ(zeros.t1, 0.0);
    const QuadraticRoots linear = solve_half_b_quadratic(0, 2, -8);
    EXPECT_EQ(linear.count, 1);
    EXPECT_EQ(linear.t0, 2.0);
    EXPECT_EQ(solve_half_b_quadratic(0, 0, 1).count, 0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(solve_half_b_quadratic(nan, 1, 1).count, 0);
    EXPECT_EQ(solve_half_b_quadratic(1, nan, 1).count, 0);
    EXPECT_EQ(solve_half_b_quadratic(1, 1, nan).count, 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
