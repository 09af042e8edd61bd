// Lanes have the bits of the scalar code on every instruction set: operators, triangle and sphere,
// angles and points of the unit circle.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "alhazen/geometry/sphere_roots.h"
#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/math/angles.h"
#include "alhazen/math/constants.h"
#include "alhazen/simd/dispatch.h"
#include "alhazen/simd/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "unit/simd/lanes_test.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Must follow foreach_target.h.
#include "alhazen/simd/angles-inl.h"
#include "alhazen/simd/lane_rows-inl.h"
#include "alhazen/simd/lanes-inl.h"

#ifndef ALHAZEN_LANES_TEST_ONCE
#define ALHAZEN_LANES_TEST_ONCE
namespace alhazen::lanes_test {

/// Inputs and results of a formula on eight lanes, one row per quantity.
constexpr std::size_t kInputs = 11;
constexpr std::size_t kOutputs = 12;
struct alignas(64) Case {
    double in[kInputs][8];
    double out[kOutputs][8];
    std::uint32_t bits[4];
};

/// Sixteen rows of four floats, and what is made of them.
struct alignas(64) Rows {
    float in[16][4];
    float turned[4][16];            ///< [column][row]
    float least[2][4], most[2][4];  ///< of the columns: of 16 lanes, of 32
    float doubled[32];              ///< a column twice, the second time times two
    double promoted[8];
    float pair[8], largest[8];    ///< of the first two rows
    float upper[4], permuted[4];  ///< half of the pair; the first row by kPlaces
};
constexpr std::int32_t kPlaces[4] = {2, 0, 3, 0};

}  // namespace alhazen::lanes_test
#endif

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

#include "alhazen/geometry/sphere_roots_formula-inl.h"
#include "alhazen/geometry/watertight_triangle_formulas-inl.h"

using lanes_test::Case;
using lanes_test::Rows;

void turn_rows(Rows& r) {
    Lanes<float, 4> in[4][4];
    for (std::size_t g = 0; g < 4; ++g) {
        for (std::size_t i = 0; i < 4; ++i) in[g][i] = load_lanes<4>(r.in[4 * g + i]);
        transpose(in[g]);
    }
    Lanes<float, 16> columns[4];
    Lanes<float, 32> longer[4];
    for (std::size_t k = 0; k < 4; ++k) {
        columns[k] = joined<16>(in[0][k], in[1][k], in[2][k], in[3][k]);
        store_lanes(columns[k], r.turned[k]);
        store_lanes(columns[k], r.doubled);
        store_lanes(columns[k] + columns[k], r.doubled + 16);
        longer[k] = load_lanes<32>(r.doubled);
    }
    const LaneExtremes<16> few(columns);
    const LaneExtremes<32> many(longer);
    store_lanes(few.least, r.least[0]);
    store_lanes(few.most, r.most[0]);
    store_lanes(many.least, r.least[1]);
    store_lanes(many.most, r.most[1]);
    store_lanes(as_doubles(load_lanes<8>(r.turned[1])), r.promoted);
    const Lanes<float, 4> first = load_lanes<4>(r.in[0]);
    const Lanes<float, 8> pair = joined(first, load_lanes<4>(r.in[1]));
    store_lanes(pair, r.pair);
    store_lanes(upper_half(pair), r.upper);
    store_lanes(largest_of_fours(abs(pair)), r.largest);
    HWY_ALIGN std::int32_t places[4];
    std::copy_n(lanes_test::kPlaces, 4, places);
    store_lanes(permuted(first, places), r.permuted);
}

void operators(Case& c) {
    const Doubles a = load_lanes(c.in[0]);
    const Doubles b = load_lanes(c.in[1]);
    store_lanes(a + b, c.out[0]);
    store_lanes(a - b, c.out[1]);
    store_lanes(a * b, c.out[2]);
    store_lanes(a / b, c.out[3]);
    store_lanes(-a, c.out[4]);
    store_lanes(sqrt(a), c.out[5]);
    store_lanes(copysign(a, b), c.out[6]);
    store_lanes(fmin(a, b), c.out[7]);
    store_lanes(fmax(a, b), c.out[8]);
    store_lanes(Doubles(c.in[0][3]), c.out[9]);
    c.bits[0] = bits_of(a < b);
    c.bits[1] = bits_of(a <= b);
    c.bits[2] = bits_of(a > b) | bits_of(a >= b) << 8;
    c.bits[3] = bits_of((a < b) | (a > b)) | bits_of((a <= b) & (a >= b)) << 8;
}

void triangle(Case& c) {
    const auto in = [&](std::size_t i) HWY_ATTR { return load_lanes(c.in[i]); };
    const ShearedVertex<Doubles> a =
        sheared(in(0), in(1), in(2), in(3), in(4), in(5), in(6), in(7));
    const ShearedVertex<Doubles> b{in(8), in(9), in(10)};
    const Doubles eu = edge_function(a, b);
    const Doubles ev = in(3) * in(4);
    const Doubles ew = edge_function(b, a);
    const TriangleSolution<Doubles> s = solve_triangle(eu, ev, ew, a.z, b.z, in(5), in(6));
    const Doubles results[] = {a.x, a.y, a.z, eu, ew, s.t, s.u, s.v};
    for (std::size_t i = 0; i < 8; ++i) store_lanes(results[i], c.out[i]);
}

void sphere(Case& c) {
    const auto in = [&](std::size_t i) HWY_ATTR { return load_lanes(c.in[i]); };
    const SphereRoots<Doubles> r =
        sphere_roots(in(0), in(1), in(2), in(3), in(4), in(5), in(6), in(7));
    store_lanes(r.discriminant, c.out[0]);
    store_lanes(r.t_near, c.out[1]);
    store_lanes(r.t_far, c.out[2]);
}

/// Sixteen lanes: those of `in`, and `in` times `scale`.
HWY_INLINE Lanes<double, 16> two_blocks(const double* in, double scale) {
    HWY_ALIGN double both[16];
    store_lanes(load_lanes(in), both);
    store_lanes(load_lanes(in) * Doubles(scale), both + 8);
    return load_lanes<16>(both);
}
HWY_INLINE void store_blocks(const Lanes<double, 16>& a, double* first, double* second) {
    HWY_ALIGN double both[16];
    store_lanes(a, both);
    store_lanes(load_lanes(both), first);
    store_lanes(load_lanes(both + 8), second);
}

void angle(Case& c) {
    store_lanes(angle_from_axis(load_lanes(c.in[0]), load_lanes(c.in[1])), c.out[0]);
    store_blocks(angle_from_axis(two_blocks(c.in[0], 0.25), two_blocks(c.in[1], -0.5)), c.out[1],
                 c.out[2]);
}

void direction(Case& c) {
    const SineCosine at = sine_cosine_at(load_lanes(c.in[0]));
    store_lanes(at.cosine, c.out[0]);
    store_lanes(at.sine, c.out[1]);
    const SineCosine wide = sine_cosine_at(two_blocks(c.in[0], 0.5));
    store_blocks(wide.cosine, c.out[2], c.out[4]);
    store_blocks(wide.sine, c.out[3], c.out[5]);
    const SineCosine after = sine_cosine_after(load_lanes(c.in[0]) * Doubles(0.125));
    store_lanes(after.cosine, c.out[6]);
    store_lanes(after.sine, c.out[7]);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

ALHAZEN_KERNEL_TABLE(operators);
ALHAZEN_KERNEL_TABLE(triangle);
ALHAZEN_KERNEL_TABLE(sphere);
ALHAZEN_KERNEL_TABLE(turn_rows);
ALHAZEN_KERNEL_TABLE(angle);
ALHAZEN_KERNEL_TABLE(direction);

using lanes_test::Case;
using lanes_test::kInputs;
using lanes_test::kOutputs;

/// Doubles of all kinds: ordinary, on a lattice, huge, tiny, special.
double any_double(std::mt19937_64& random, int sort) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    constexpr double kSpecial[] = {0.0, -0.0,      1.0,        -1.0,      kInf,     -kInf,
                                   NAN, 0x1p-1074, -0x1p-1074, 0x1p-1022, 0x1p1023, -0x1p1023,
                                   0.5, 2.0,       0x1p-600,   0x1p600};
    const double unit = static_cast<double>(random() >> 11) * 0x1p-53 * 2 - 1;
    switch (sort) {
        case 0:
            return unit;
        case 1:
            return static_cast<double>(static_cast<int>(random() % 7) - 3);
        case 2:
            return std::ldexp(unit, static_cast<int>(random() % 800) - 400);
        case 3:
            return kSpecial[random() % std::size(kSpecial)];
        default:
            return any_double(random, static_cast<int>(random() % 4));
    }
}

bool same(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) ||
           std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
/// Equal, ignoring the sign of zero: the minimum of two zeros may have either.
bool same_value(double a, double b) {
    return same(a, b) || (a == 0 && b == 0);
}

using Scalar = std::array<double, kOutputs>;

void fill(Case& c, std::mt19937_64& random) {
    const int sort = static_cast<int>(random() % 5);
    for (auto& row : c.in) {
        for (double& x : row) x = any_double(random, sort);
    }
}

/// Runs `kernel` on every instruction set and compares the first rows of its results with `scalar`.
template <class Kernel, class ScalarForm, class Same>
void compare(std::size_t outputs, const Kernel& kernel, const ScalarForm& scalar,
             const Same& equal) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        std::mt19937_64 random(42);
        std::uint64_t numbers = 0;
        for (int block = 0; block < 65000; ++block) {
            Case c{};
            fill(c, random);
            kernel(c);
            for (std::size_t lane = 0; lane < 8; ++lane) {
                double in[kInputs];
                for (std::size_t i = 0; i < kInputs; ++i) in[i] = c.in[i][lane];
                const Scalar expected = scalar(in);
                for (std::size_t i = 0; i < outputs; ++i) {
                    ASSERT_TRUE(equal(i, expected[i], c.out[i][lane]))
                        << target << " block " << block << " lane " << lane << " result " << i
                        << std::hexfloat << ": " << expected[i] << " became " << c.out[i][lane];
                    numbers += !std::isnan(expected[i]);
                }
            }
        }
        EXPECT_GT(numbers, 500000u) << "too many NaNs to prove anything";
    }
}

TEST(Lanes, OperatorsGiveTheBitsOfTheScalar) {
    compare(
        9,
        [](Case& c) {
            ALHAZEN_KERNEL(operators)
            (c);
        },
        [](const double* in) {
            const double a = in[0], b = in[1];
            return Scalar{a + b,
                          a - b,
                          a * b,
                          a / b,
                          -a,
                          std::sqrt(a),
                          std::copysign(a, b),
                          std::fmin(a, b),
                          std::fmax(a, b)};
        },
        [](std::size_t i, double a, double b) { return i < 7 ? same(a, b) : same_value(a, b); });
}

TEST(Lanes, ComparisonsAreThoseOfTheScalar) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        std::mt19937_64 random(43);
        for (int block = 0; block < 20000; ++block) {
            Case c{};
            fill(c, random);
            if (block % 3 == 0) std::memcpy(c.in[1], c.in[0], 4 * sizeof(double));
            ALHAZEN_KERNEL(operators)(c);
            std::uint32_t bits[4] = {};
            for (std::uint32_t lane = 0; lane < 8; ++lane) {
                const double a = c.in[0][lane], b = c.in[1][lane];
                const auto bit = [lane](bool x) { return std::uint32_t{x} << lane; };
                bits[0] |= bit(a < b);
                bits[1] |= bit(a <= b);
                bits[2] |= bit(a > b) | bit(a >= b) << 8;
                bits[3] |= bit(a < b || a > b) | bit(a <= b && a >= b) << 8;
                ASSERT_TRUE(same(c.out[9][lane], c.in[0][3]));
            }
            for (int i = 0; i < 4; ++i) ASSERT_EQ(bits[i], c.bits[i]) << target << " mask " << i;
        }
    }
}

TEST(Lanes, RowsBecomeColumnsAndGiveTheirExtremes) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        std::mt19937_64 random(44);
        std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
        for (int round = 0; round < 200; ++round) {
            lanes_test::Rows r{};
            for (auto& row : r.in) {
                for (float& x : row) x = uniform(random);
            }
            ALHAZEN_KERNEL(turn_rows)(r);
            for (std::size_t k = 0; k < 4; ++k) {
                float least = 9, most = -9;
                for (std::size_t i = 0; i < 16; ++i) {
                    ASSERT_EQ(r.turned[k][i], r.in[i][k]) << target;
                    least = std::fmin(least, r.in[i][k]);
                    most = std::fmax(most, r.in[i][k]);
                }
                ASSERT_EQ(r.least[0][k], least) << target;
                ASSERT_EQ(r.most[0][k], most) << target;
                ASSERT_EQ(r.least[1][k], std::fmin(least, 2 * least)) << target;
                ASSERT_EQ(r.most[1][k], std::fmax(most, 2 * most)) << target;
            }
            for (std::size_t i = 0; i < 8; ++i) {
                ASSERT_EQ(r.promoted[i], double{r.in[i][1]}) << target;
                const auto& row = r.in[i / 4];
                ASSERT_EQ(r.pair[i], row[i % 4]) << target;
                float largest = 0;
                for (const float x : row) largest = std::fmax(largest, std::abs(x));
                ASSERT_EQ(r.largest[i], largest) << target;
            }
            for (std::size_t i = 0; i < 4; ++i) {
                ASSERT_EQ(r.upper[i], r.in[1][i]) << target;
                ASSERT_EQ(r.permuted[i], r.in[0][lanes_test::kPlaces[i]]) << target;
            }
        }
    }
}

TEST(Lanes, TheTriangleTestGivesTheBitsOfTheScalar) {
    compare(
        8,
        [](Case& c) {
            ALHAZEN_KERNEL(triangle)
            (c);
        },
        [](const double* in) {
            const ShearedVertex<double> a =
                sheared(in[0], in[1], in[2], in[3], in[4], in[5], in[6], in[7]);
            const ShearedVertex<double> b{in[8], in[9], in[10]};
            const double eu = edge_function(a, b), ev = in[3] * in[4], ew = edge_function(b, a);
            const TriangleSolution<double> s = solve_triangle(eu, ev, ew, a.z, b.z, in[5], in[6]);
            return Scalar{a.x, a.y, a.z, eu, ew, s.t, s.u, s.v};
        },
        [](std::size_t, double a, double b) { return same(a, b); });
}

TEST(Lanes, TheSphereTestGivesTheBitsOfTheScalar) {
    compare(
        3,
        [](Case& c) {
            ALHAZEN_KERNEL(sphere)
            (c);
        },
        [](const double* in) {
            const SphereRoots<double> r =
                sphere_roots(in[0], in[1], in[2], in[3], in[4], in[5], in[6], in[7]);
            return Scalar{r.discriminant, r.t_near, r.t_far};
        },
        [](std::size_t, double a, double b) { return same_value(a, b); });
}

/// Numbers of [low, high]: random ones, numbers near to `special`, and its neighbours.
std::vector<double> numbers(double low, double high, const std::vector<double>& special) {
    std::mt19937_64 random(71);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    std::vector<double> all;
    for (const double s : special) {
        double up = s, down = s;
        for (int i = 0; i < 40; ++i) {
            all.push_back(up);
            all.push_back(down);
            up = std::nextafter(up, high);
            down = std::nextafter(down, low);
        }
        for (int i = 0; i < 2000; ++i) {
            const double away = std::ldexp(2.0 * unit() - 1.0, -static_cast<int>(random() % 60));
            all.push_back(std::clamp(s + away, low, high));
        }
    }
    for (int i = 0; i < 100000; ++i) all.push_back(low + unit() * (high - low));
    while (all.size() % 8 != 0) all.push_back(low);
    return all;
}

/// Compares `kernel` with `scalar` for these numbers on every instruction set.
template <class Kernel, class ScalarForm>
void compare_numbers(const std::vector<double>& all, std::size_t outputs, const Kernel& kernel,
                     const ScalarForm& scalar) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        for (std::size_t first = 0; first < all.size(); first += 8) {
            Case c{};
            std::copy_n(all.data() + first, 8, c.in[0]);
            kernel(c);
            for (std::size_t lane = 0; lane < 8; ++lane) {
                const Scalar expected = scalar(c.in[0][lane]);
                for (std::size_t i = 0; i < outputs; ++i) {
                    ASSERT_TRUE(same(expected[i], c.out[i][lane]))
                        << target << std::hexfloat << ": " << c.in[0][lane] << " result " << i;
                }
            }
        }
    }
}

TEST(Lanes, AnglesHaveTheBitsOfTheScalar) {
    compare(
        3,
        [](Case& c) {
            ALHAZEN_KERNEL(angle)
            (c);
        },
        [](const double* in) {
            return Scalar{angle_from_axis(in[0], in[1]), angle_from_axis(in[0], in[1]),
                          angle_from_axis(0.25 * in[0], -0.5 * in[1])};
        },
        [](std::size_t, double a, double b) { return same(a, b); });
}

TEST(Lanes, DirectionsHaveTheBitsOfTheScalar) {
    std::vector<double> special;
    for (int eighth = 0; eighth <= 8; ++eighth) special.push_back(0.25 * kPi * eighth);
    compare_numbers(
        numbers(0, 7, special), 8,
        [](Case& c) {
            ALHAZEN_KERNEL(direction)
            (c);
        },
        [](double x) {
            const Vec2 whole = direction_at(x), half = direction_at(0.5 * x);
            const Vec2 after = direction_after(0.125 * x);
            return Scalar{whole.x, whole.y, whole.x, whole.y, half.x, half.y, after.x, after.y};
        });
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
#endif
