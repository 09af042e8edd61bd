// Sign changes of polynomials with known roots.

#include "alhazen/math/bernstein_roots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
constexpr int kMost = 14;

/// Product of (u - root) in double-double Bernstein form, by multiplication of scaled coefficients.
BernsteinPolynomial<DoubleDouble, kMost> with_roots(const std::vector<double>& roots) {
    std::vector<DoubleDouble> scaled{DoubleDouble(1.0)};
    for (const double root : roots) {
        const DoubleDouble at_0 = -root, at_1 = two_sum(1.0, -root);
        std::vector<DoubleDouble> next(scaled.size() + 1, DoubleDouble(0.0));
        for (std::size_t i = 0; i < scaled.size(); ++i) {
            next[i] += scaled[i] * at_0;
            next[i + 1] += scaled[i] * at_1;
        }
        scaled = next;
    }
    BernsteinPolynomial<DoubleDouble, kMost> p;
    p.degree = static_cast<int>(roots.size());
    p.error = 1e-30;
    double binomial = 1.0;
    for (int i = 0; i <= p.degree; ++i) {
        // Division by the binomials is inexact: one Newton step gives the quotient in
        // double-double.
        const double q = scaled[i].high / binomial;
        const DoubleDouble rest = scaled[i] - DoubleDouble(q) * DoubleDouble(binomial);
        p.b[i] = DoubleDouble(q) + DoubleDouble(rest.high / binomial);
        binomial = binomial * (p.degree - i) / (i + 1);
    }
    return p;
}

template <int N>
BernsteinPolynomial<double, N> rounded(const BernsteinPolynomial<DoubleDouble, N>& p) {
    BernsteinPolynomial<double, N> r;
    r.degree = p.degree;
    double largest = 0.0;
    for (int i = 0; i <= p.degree; ++i) {
        r.b[i] = p.b[i].high;
        largest = std::max(largest, std::abs(r.b[i]));
    }
    r.error = 0x1p-52 * largest;
    return r;
}

/// Both searches through their common interface.
template <int N>
SignChanges<N> sign_changes(const BernsteinPolynomial<DoubleDouble, N>& p) {
    SignChanges<N> out;
    find_certified_sign_changes<N>(
        [&](auto& to) {
            if constexpr (std::is_same_v<std::decay_t<decltype(to)>,
                                         BernsteinPolynomial<double, N>>) {
                to = rounded(p);
            } else {
                to = p;
            }
        },
        out);
    return out;
}

TEST(BernsteinRoots, OfRandomProductsAreAllFound) {
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
        const int degree = 1 + random.below(12);
        std::vector<double> roots, inside;
        for (int k = 0; k < degree; ++k) {
            roots.push_back(random.uniform(-1, 2));
            if (roots[k] > 0 && roots[k] < 1) inside.push_back(roots[k]);
        }
        std::sort(inside.begin(), inside.end());
        const auto found = sign_changes(with_roots(roots));
        ASSERT_EQ(found.count, static_cast<int>(inside.size())) << "case " << i;
        for (std::size_t k = 0; k < inside.size(); ++k) {
            ASSERT_LE(found.lo[k], found.u[k]);
            ASSERT_LE(found.u[k], found.hi[k]);
            ASSERT_LE(found.lo[k], inside[k] + 0x1p-50);
            ASSERT_GE(found.hi[k], inside[k] - 0x1p-50);
            // Error of the root: error of a coefficient over the slope, the product of distances to
            // other roots.
            double slope = 1.0;
            for (const double r : roots) {
                if (r != inside[k]) slope *= std::abs(inside[k] - r);
            }
            ASSERT_NEAR(found.u[k], inside[k], 4e-16 + 1e-13 / slope) << "case " << i;
        }
    }
}

TEST(BernsteinRoots, OfEvenMultiplicityAreNoneAndOfOddMultiplicityOne) {
    for (const double root : {0.3, 0.5, 0.625, 1.0 / 3.0}) {
        for (int multiplicity = 1; multiplicity <= 6; ++multiplicity) {
            std::vector<double> roots(static_cast<std::size_t>(multiplicity), root);
            roots.push_back(0.9);
            const auto found = sign_changes(with_roots(roots));
            ASSERT_EQ(found.count, 1 + multiplicity % 2) << root << " " << multiplicity;
            ASSERT_NEAR(found.u[found.count - 1], 0.9, 1e-14);
            if (multiplicity % 2 == 1) {
                ASSERT_NEAR(found.u[0], root, 2e-5);
            }
        }
    }
}

TEST(BernsteinRoots, AsCloseAsDoubleTellsAreTwo) {
    for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14}) {
        const auto found = sign_changes(with_roots({0.4, 0.4 + gap, 0.8}));
        ASSERT_EQ(found.count, 3) << gap;
        ASSERT_NEAR(found.u[0], 0.4, 0.02 * gap + 1e-16) << gap;
        ASSERT_NEAR(found.u[1], 0.4 + gap, 0.02 * gap + 1e-16) << gap;
    }
}

TEST(BernsteinRoots, NearlyRealPairsAreNone) {
    // (u - 0.4)^2 + gap^2, times (u - 0.8).
    for (const double gap : {1e-3, 1e-7, 1e-11, 1e-14}) {
        auto p = with_roots({0.4, 0.4, 0.8});
        const auto line = with_roots({0.8});
        // gap^2 (u - 0.8), raised to degree 3.
        const DoubleDouble g = two_product(gap, gap);
        for (int i = 0; i <= 3; ++i) {
            p.b[i] +=
                g * (DoubleDouble(line.b[0]) + DoubleDouble(i / 3.0) * (line.b[1] - line.b[0]));
        }
        const auto found = sign_changes(p);
        ASSERT_EQ(found.count, 1) << gap;
        ASSERT_NEAR(found.u[0], 0.8, 1e-14);
    }
}

TEST(BernsteinRoots, OfWilkinsonsKindAreFound) {
    std::vector<double> roots;
    for (int i = 1; i <= 12; ++i) roots.push_back(i / 13.0);
    const auto found = sign_changes(with_roots(roots));
    ASSERT_EQ(found.count, 12);
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(found.u[i], roots[i], 1e-9);
}

TEST(BernsteinRoots, OfWhatIsZeroOrNoNumberAreNone) {
    auto p = with_roots({0.5, 0.25});
    for (int i = 0; i <= 2; ++i) p.b[i] = DoubleDouble(0.0);
    EXPECT_EQ(sign_changes(p).count, 0);
    for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
        p.b[1] = DoubleDouble(bad);
        EXPECT_EQ(sign_changes(p).count % 2, 0);
    }
}

TEST(BernsteinRoots, CountAgreesWithTheSignsAtTheEnds) {
    // Coefficients of few bits give many zeros and multiple roots.
    Random random(2);
    for (int i = 0; i < 20000; ++i) {
        BernsteinPolynomial<DoubleDouble, kMost> p;
        p.degree = 1 + random.below(8);
        p.error = 1e-30;
        for (int k = 0; k <= p.degree; ++k) p.b[k] = DoubleDouble(random.below(5) - 2.0);
        const auto found = sign_changes(p);
        // Near an end with p = 0, p has the sign of the first nonzero coefficient.
        double first = 0.0, last = 0.0;
        for (int k = p.degree; k >= 0; --k) first = p.b[k].high != 0.0 ? p.b[k].high : first;
        for (int k = 0; k <= p.degree; ++k) last = p.b[k].high != 0.0 ? p.b[k].high : last;
        ASSERT_EQ(found.negative_at_start, first < 0.0) << i;
        ASSERT_EQ(found.negative_at_end(), last < 0.0) << i;
        for (int k = 1; k < found.count; ++k) ASSERT_LE(found.u[k - 1], found.u[k]);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
