#include <gmpxx.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "support/polygon_checks.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// A rational of any length.
class Rational {
  public:
    explicit Rational(Int128 v) {
        const bool negative = v < 0;
        __extension__ using Bits = unsigned __int128;
        const Bits bits = negative ? Bits{0} - static_cast<Bits>(v) : static_cast<Bits>(v);
        mpz_class n(static_cast<unsigned long>(bits >> 64));
        n = (n << 64) + static_cast<unsigned long>(bits);
        value_ = negative ? mpq_class(-n) : mpq_class(n);
    }
    friend Rational operator+(const Rational& a, const Rational& b) {
        return Rational(a.value_ + b.value_);
    }
    friend Rational operator-(const Rational& a, const Rational& b) {
        return Rational(a.value_ - b.value_);
    }
    friend Rational operator*(const Rational& a, const Rational& b) {
        return Rational(a.value_ * b.value_);
    }
    friend Rational operator/(const Rational& a, const Rational& b) {
        return Rational(a.value_ / b.value_);
    }
    friend bool operator==(const Rational& a, const Rational& b) { return a.value_ == b.value_; }

  private:
    explicit Rational(const mpq_class& value) : value_(value) {}
    mpq_class value_;
};

long operations_asked_for() {
    const char* text = std::getenv("ALHAZEN_POLYGON_OPERATIONS");
    return text == nullptr ? 1000000 : std::atol(text);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// ALHAZEN_POLYGON_OPERATIONS: how many, instead of 10^6.
TEST(PolygonSetsHeavy, AMillionOperationsHaveTheirExactRationalAreas) {
    RandomPolygons random(1977);
    PolygonChecks checks;
    const long asked = operations_asked_for();
    for (long i = 0; checks.operations < asked; ++i) {
        const auto [a, b] = random.pair(i % 20 == 0 ? 16 : 7);
        ASSERT_EQ(polygon_flaw<Rational>(a, b, checks), "") << "pair " << i;
    }
    std::printf("%ld operations, %ld pairs by the walk, %ld pairs rounded\n", checks.operations,
                checks.general, checks.rounded);
}

TEST(PolygonSetsHeavy, TenThousandOperationsOnOnePolygonLoseNothing) {
    EXPECT_EQ(chain_flaw(10000), "");
}

TEST(PolygonSetsHeavy, AMillionVerticesTakeSeconds) {
    RandomPolygons random(5);
    const auto wave = [&random](double phase) {
        LatticeLoop loop(1000000);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const double angle = 6.283185307179586e-6 * static_cast<double>(i);
            const double r = 1.2e7 * (1 + 0.2 * std::sin(50 * angle + phase)) + random.below(20);
            loop[i] = {static_cast<std::int32_t>(std::lround(r * std::cos(angle))),
                       static_cast<std::int32_t>(std::lround(r * std::sin(angle)))};
        }
        return loop;
    };
    auto start = std::chrono::steady_clock::now();
    const PolygonSet a = polygon_set(wave(0));
    const PolygonSet b = polygon_set(wave(2));
    std::printf("mended two of 10^6 vertices in %.2f s\n", seconds_since(start));
    start = std::chrono::steady_clock::now();
    const PolygonCut parts = cut(a, b);
    std::printf("cut them in %.2f s\n", seconds_since(start));
    EXPECT_LT(seconds_since(start), 120);
    const double error = std::abs(
        static_cast<double>(twice_area(parts.inside) + twice_area(parts.outside) - twice_area(a)));
    EXPECT_LT(error, 1e-6 * static_cast<double>(twice_area(a)));
    // Teeth: 10^6 vertices, half of them crossed by one edge.
    LatticeLoop comb;
    for (std::int32_t i = 0; i < 250000; ++i) {
        comb.insert(comb.end(), {{4 * i, 0}, {4 * i + 1, 5000}, {4 * i + 2, 5000}, {4 * i + 3, 0}});
    }
    comb.insert(comb.end(), {{1000000, -10}, {0, -10}});
    start = std::chrono::steady_clock::now();
    const PolygonCut cuts = cut(polygon_set(comb), lattice_rectangle({-10, 2501}, {2000000, 6000}));
    std::printf("a comb of 10^6 vertices in %.2f s\n", seconds_since(start));
    EXPECT_EQ(cuts.inside.loop_count(), 250000U);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
