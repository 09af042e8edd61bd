// Crossings of random and grazing rays with well-known surfaces against an exact count of the roots
// of the polynomial that the doubles of ray and shape define: Sturm's theorem in ball arithmetic,
// and over the integers where that is uncertain. ALHAZEN_ROOT_COUNT_RAYS sets the number of rays
// per surface (default 100000).

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "alhazen/shapes/algebraic/algebraic.h"
#include "alhazen/shapes/algebraic/polynomial_solid.h"
#include "alhazen/shapes/algebraic/superellipsoid.h"
#include "alhazen/shapes/algebraic/torus.h"
#include "support/random.h"
#include "unit/shapes/algebraic/certified_sturm.h"
#include "unit/shapes/algebraic/exact_root_count.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::close_pairs;
using testing::DoubleBall;
using testing::line;
using testing::Powers;
using testing::PreciseBall;
using testing::Random;
using testing::RationalPolynomial;
using testing::SturmSequence;
using testing::Uncertain;

// ---- the function along a line, for any number type

template <class N>
struct Coordinates {
    Powers<N> x, y, z;
};

/// Expanded about t = `start`.
template <class N>
Coordinates<N> line_in(const SolidFrame& frame, const Ray& ray, double start) {
    const Vec3 columns[] = {frame.local_from_object.x_axis, frame.local_from_object.y_axis,
                            frame.local_from_object.z_axis};
    N at[3], along[3];
    for (int j = 0; j < 3; ++j) {
        along[j] = N(ray.direction[j]);
        at[j] = N(ray.origin[j]) - N(frame.origin[j]) + N(start) * along[j];
    }
    const auto coordinate = [&](int k) {
        N a = N(columns[0][k]) * at[0], b = N(columns[0][k]) * along[0];
        for (int j = 1; j < 3; ++j) {
            a = a + N(columns[j][k]) * at[j];
            b = b + N(columns[j][k]) * along[j];
        }
        return Powers<N>{a, b};
    };
    return {coordinate(0), coordinate(1), coordinate(2)};
}

Coordinates<DoubleBall> shortened(const Coordinates<PreciseBall>& line) {
    const auto both = [](const Powers<PreciseBall>& p) {
        return Powers<DoubleBall>{testing::shortened(p.c[0]), testing::shortened(p.c[1])};
    };
    return {both(line.x), both(line.y), both(line.z)};
}

const SolidFrame& frame_of(const Algebraic&) {
    static const SolidFrame none;
    return none;
}
const SolidFrame& frame_of(const Torus& s) {
    return s.frame;
}
const SolidFrame& frame_of(const Superellipsoid& s) {
    return s.frame;
}

template <class N>
Powers<N> polynomial(const Torus& s, const Coordinates<N>& l) {
    const N r(s.tube);
    const Powers<N> across = l.x * l.x + l.y * l.y;
    const Powers<N> a = across + l.z * l.z + Powers<N>{N(N(1) - r * r)};
    return a * a - Powers<N>{N(4)} * across;
}

template <class N>
Powers<N> polynomial(const Algebraic& s, const Coordinates<N>& l) {
    using Op = PolynomialExpression::Op;
    static thread_local std::vector<Powers<N>> of;
    of.clear();
    for (const auto& n : s.polynomial->nodes()) {
        switch (n.op) {
            case Op::Constant:
                of.push_back({N(N(n.constant.high) + N(n.constant.low))});
                break;
            case Op::X:
                of.push_back(l.x);
                break;
            case Op::Y:
                of.push_back(l.y);
                break;
            case Op::Z:
                of.push_back(l.z);
                break;
            case Op::Add:
                of.push_back(of[n.a] + of[n.b]);
                break;
            case Op::Subtract:
                of.push_back(of[n.a] - of[n.b]);
                break;
            case Op::Multiply:
                of.push_back(of[n.a] * of[n.b]);
                break;
        }
    }
    return of.back();
}

/// Requires whole numbers 2 / e and e / n.
template <class N>
Powers<N> polynomial(const Superellipsoid& s, const Coordinates<N>& l) {
    const auto power = [](const Powers<N>& p, int n) {
        Powers<N> product = p;
        for (int i = 1; i < n; ++i) product = product * p;
        return product;
    };
    const int p = static_cast<int>(s.p), q = static_cast<int>(s.q);
    return power(power(l.x, p) + power(l.y, p), q / p) + power(l.z, q) - Powers<N>{N(1)};
}

// ---- counts

/// Part of the line in which the shape searches for crossings.
struct Part {
    bool whole = true;  ///< the whole line has no other crossings
    double entry = -1e9, exit = 1e9;
};
template <class S>
Part part_of(const S&, const Ray&) {
    return {};
}
template <>
Part part_of(const Algebraic& s, const Ray& ray) {
    ClipSegment segment;
    if (!clip_segment({}, ray, s.clip_box, s.size, segment)) return {false, 0, 0};
    return {false, segment.range.entry, segment.range.exit};
}

template <class S>
SturmSequence exact_sequence(const S& shape, const Ray& ray) {
    const Powers<mpq_class> p = polynomial(shape, line_in<mpq_class>(frame_of(shape), ray, 0.0));
    return SturmSequence(
        RationalPolynomial(p.c.begin(), p.c.begin() + static_cast<std::ptrdiff_t>(p.count)));
}
template <class S>
int exact_count(const S& shape, const Ray& ray, const Part& part) {
    const SturmSequence sturm = exact_sequence(shape, ray);
    return sturm.constant() ? 0 : sturm.count(mpq_class(part.entry), mpq_class(part.exit));
}

/// Number of rays counted by each number type.
struct Tally {
    long by_double = 0, by_double_double = 0, by_integers = 0;
};

/// Exact: uses balls, and integers where balls are uncertain.
template <class S>
int certain_count(const S& shape, const Ray& ray, const Part& part, Tally& tally) {
    if (!(part.entry < part.exit)) return 0;
    const Vec3 middle = shape.box().center();
    const double start =
        part.whole ? dot(middle - ray.origin, ray.direction) : 0.5 * part.entry + 0.5 * part.exit;
    const auto line = line_in<PreciseBall>(frame_of(shape), ray, start);
    const PreciseBall from = PreciseBall(part.entry) - PreciseBall(start);
    const PreciseBall to = PreciseBall(part.exit) - PreciseBall(start);
    const auto count = [&](const auto& coordinates, const auto& lo, const auto& hi) {
        const testing::CertifiedSturm sturm(polynomial(shape, coordinates));
        return part.whole ? sturm.count() : sturm.count(lo, hi);
    };
    try {
        const int n = count(shortened(line), testing::shortened(from), testing::shortened(to));
        ++tally.by_double;
        return n;
    } catch (const Uncertain&) {
    }
    try {
        const int n = count(line, from, to);
        ++tally.by_double_double;
        return n;
    } catch (const Uncertain&) {
    }
    ++tally.by_integers;
    return exact_count(shape, ray, part);
}

/// One ray in this many is counted in both ways.
constexpr int kCountedTwice = 2048;

int rays_per_surface() {
    const char* text = std::getenv("ALHAZEN_ROOT_COUNT_RAYS");
    return text != nullptr ? std::atoi(text) : 100000;
}

/// Half of the rays are random, half lie along a tangent plane, displaced by 0 to 1e-16 of the
/// size.
template <class S>
Ray random_ray(const S& shape, Random& random) {
    const Box3 box = shape.box();
    const auto target = [&] {
        return Vec3{random.uniform(box.lo.x, box.hi.x), random.uniform(box.lo.y, box.hi.y),
                    random.uniform(box.lo.z, box.hi.z)};
    };
    const Vec3 direction = random.unit_vector();
    const Ray ray = line(target() - random.log_uniform(0.1, 100) * direction, direction);
    if (random.coin()) return ray;
    ShapeHit hits[16];
    const int n = shape.intersect(ray, hits);
    if (n == 0) return ray;
    const ShapeSurface at = shape.surface(ray, hits[random.below(n)]);
    Vec3 along = cross(at.normal, random.unit_vector());
    along = unit_or(along, direction);
    const double off = random.sign() * std::pow(10.0, -random.uniform(1, 17));
    return line(at.point + off * at.normal - random.log_uniform(0.1, 10) * along, along);
}

template <class S>
void compare(const char* name, S shape) {
    shape.prepare();
    Random random(2026);
    const int rays = rays_per_surface();
    long same = 0, too_close = 0, crossings = 0, multiple = 0;
    Tally tally;
    for (int i = 0; i < rays; ++i) {
        const Ray ray = random_ray(shape, random);
        ShapeHit hits[16];
        const int ours = shape.intersect(ray, hits);
        const Part part = part_of(shape, ray);
        const int truth = certain_count(shape, ray, part, tally);
        if (i % kCountedTwice == 0) {
            ASSERT_EQ(truth, exact_count(shape, ray, part)) << name << " ray " << i;
        }
        crossings += truth;
        multiple += truth > 2;
        if (ours == truth) {
            ++same;
            continue;
        }
        ASSERT_EQ(ours % 2, truth % 2)
            << name << " ray " << i << ": ours " << ours << ", exact " << truth;
        // Only roots closer than the resolution of double on the line may be missing.
        const double length = part.whole ? 4.0 : part.exit - part.entry;
        const mpq_class distance = mpq_class(length * 0x1p-44);
        const int pairs = close_pairs(exact_sequence(shape, ray), mpq_class(part.entry),
                                      mpq_class(part.exit), distance);
        ASSERT_LT(ours, truth) << name << " ray " << i;
        ASSERT_LE(truth - ours, 2 * pairs)
            << name << " ray " << i << ": ours " << ours << ", exact " << truth;
        ++too_close;
    }
    std::cout << name << ": " << rays << " rays, " << crossings << " crossings, " << multiple
              << " rays with more than 2; same count " << same << ", pairs closer than 2^-44 "
              << too_close << "; counted in double " << tally.by_double << ", in double-double "
              << tally.by_double_double << ", in integers " << tally.by_integers << std::endl;
    EXPECT_GT(crossings, rays / 50);
}

Algebraic algebraic(const char* expression, double size) {
    return {.expression = expression,
            .clip_box = {{-size, -size, -size}, {size, size, size}},
            .capped = false};
}

TEST(RootCount, OfATorusIsExact) {
    compare("torus", Torus{.center = {0.1, -0.2, 0.3}, .axis = {1, 2, 3}, .minor_radius = 0.3});
    compare("thin torus", Torus{.axis = {0, 1, 1}, .minor_radius = 0.01});
}

TEST(RootCount, OfTheBarthSexticIsExact) {
    compare("Barth sextic",
            algebraic("4*((3+sqrt(5))/2*x^2-y^2)*((3+sqrt(5))/2*y^2-z^2)*((3+sqrt(5))/2*z^2-x^2)"
                      "-(2+sqrt(5))*(x^2+y^2+z^2-1)^2",
                      2.0));
}

TEST(RootCount, OfTheKummerSurfaceIsExact) {
    compare("Kummer", algebraic("(x^2+y^2+z^2-1.3^2)^2 - (3*1.3^2-1)/(3-1.3^2)*"
                                "(1-z-sqrt(2)*x)*(1-z+sqrt(2)*x)*(1+z+sqrt(2)*y)*(1+z-sqrt(2)*y)",
                                2.5));
}

TEST(RootCount, OfTheSteinerSurfaceIsExact) {
    compare("Steiner", algebraic("x^2*y^2 + y^2*z^2 + z^2*x^2 - 2*x*y*z", 1.5));
}

TEST(RootCount, OfTheCayleyCubicIsExact) {
    compare("Cayley", algebraic("4*(x^2+y^2+z^2) + 16*x*y*z - 1", 1.5));
}

TEST(RootCount, OfSuperellipsoidsIsExact) {
    compare("superellipsoid 4 4", Superellipsoid{.east = 0.5, .north = 0.5});
    compare("superellipsoid 2 4", Superellipsoid{.axis_a = {1, 0.5, 0}, .east = 1, .north = 0.5});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
