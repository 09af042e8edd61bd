// Crossings of random and grazing rays with blobs against the exact number that the doubles of ray
// and blob define. ALHAZEN_EXACT_RAYS sets the number of rays (default 20000).

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "alhazen/math/unit_vector.h"
#include "alhazen/shapes/blobs/blob.h"
#include "support/random.h"
#include "unit/shapes/algebraic/certified_sturm.h"
#include "unit/shapes/algebraic/exact_sturm.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::DoubleBall;
using testing::line;
using testing::Powers;
using testing::PreciseBall;
using testing::Random;
using testing::RationalPolynomial;
using testing::Uncertain;

// ---- blobs for any number type

template <class N>
using VecOf = std::array<N, 3>;

template <class N>
VecOf<N> exact(const Vec3& v) {
    return {N(v.x), N(v.y), N(v.z)};
}
template <class N>
VecOf<N> minus(const VecOf<N>& a, const VecOf<N>& b) {
    return {N(a[0] - b[0]), N(a[1] - b[1]), N(a[2] - b[2])};
}
template <class N>
N dot_of(const VecOf<N>& a, const VecOf<N>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class N>
VecOf<N> cross_of(const VecOf<N>& a, const VecOf<N>& b) {
    return {N(a[1] * b[2] - a[2] * b[1]), N(a[2] * b[0] - a[0] * b[2]),
            N(a[0] * b[1] - a[1] * b[0])};
}

int sign_of(const mpq_class& x) {
    return sgn(x);
}
/// Square root with an error below 2^-200.
mpq_class square_root(const mpq_class& x) {
    mpf_class r(0, 512);
    r = x;
    r = sqrt(r);
    mpq_class q(r);
    q.canonicalize();
    return q;
}

/// Overlapping balls have no order: throws Uncertain.
template <class N>
bool less(const N& a, const N& b) {
    return sign_of(N(b - a)) > 0;
}

/// Position where a component begins or ends. Equal positions have the same number.
template <class N>
struct End {
    N t;
    int number = 0;

    friend bool operator<(const End& a, const End& b) {
        return a.number != b.number && less(a.t, b.t);
    }
};

template <class N>
struct Piece {
    End<N> in, out;
    Powers<N> density;
};

/// Components along a line.
template <class N>
class PiecesOf {
  public:
    PiecesOf(const Blob& blob, const VecOf<N>& origin, const VecOf<N>& direction)
        : origin_(origin), direction_(direction) {
        for (const BlobComponent& c : blob.components) add(c);
    }
    std::vector<Piece<N>> pieces;

  private:
    void add(const BlobComponent& c) {
        const N r2 = N(c.radius) * N(c.radius);
        const VecOf<N> f = minus(origin_, exact<N>(c.base));
        if (!c.rod) {
            add_piece(f, direction_, r2, c.strength, nullptr, nullptr);
            return;
        }
        const VecOf<N> e = minus(exact<N>(c.top), exact<N>(c.base));
        const N ee = dot_of(e, e), from = dot_of(f, e), speed = dot_of(direction_, e);
        // Random rays are not exactly perpendicular to a rod.
        const bool upward = sign_of(speed) > 0;
        const End<N> at_base{N(-from / speed), ends_++}, at_top{N((ee - from) / speed), ends_++};
        const End<N>& first = upward ? at_base : at_top;
        const End<N>& last = upward ? at_top : at_base;
        const VecOf<N> g = minus(origin_, exact<N>(c.top));
        add_piece(upward ? f : g, direction_, r2, c.strength, nullptr, &first);
        add_piece(cross_of(f, e), cross_of(direction_, e), r2 * ee, c.strength, &first, &last);
        add_piece(upward ? g : f, direction_, r2, c.strength, &last, nullptr);
    }

    /// Adds strength (1 - |f + t d|^2 / scale)^2 where the quadratic is positive, limited to `lo`
    /// to `hi` if given.
    void add_piece(const VecOf<N>& f, const VecOf<N>& d, const N& scale, double strength,
                   const End<N>* lo, const End<N>* hi) {
        const N a = dot_of(d, d), b = dot_of(f, d), c = dot_of(f, f) - scale;
        End<N> in{{}, ends_++}, out{{}, ends_++};
        if (sign_of(a) == 0) {
            if (sign_of(c) >= 0 || lo == nullptr || hi == nullptr) return;
            in = *lo, out = *hi;
        } else {
            const N discriminant = b * b - a * c;
            if (sign_of(discriminant) <= 0) return;
            const N s = square_root(discriminant);
            in.t = (-b - s) / a, out.t = (-b + s) / a;
            if (lo != nullptr && in < *lo) in = *lo;
            if (hi != nullptr && *hi < out) out = *hi;
        }
        if (!(in < out)) return;
        const N over = N(-1) / scale;
        const Powers<N> q{N(c * over), N(N(2) * b * over), N(a * over)};
        pieces.push_back({in, out, Powers<N>{N(strength)} * (q * q)});
    }

    VecOf<N> origin_, direction_;
    int ends_ = 0;
};

/// Sum of count(polynomial, from, to) over all spans between adjacent ends of components.
template <class N, class Count>
int count_spans(const Blob& blob, const PiecesOf<N>& along, Count&& count) {
    std::vector<End<N>> ends;
    for (const Piece<N>& p : along.pieces) {
        ends.push_back(p.in);
        ends.push_back(p.out);
    }
    // Insertion sort: comparisons may throw.
    for (std::size_t i = 1; i < ends.size(); ++i) {
        for (std::size_t k = i; k > 0 && ends[k] < ends[k - 1]; --k) {
            std::swap(ends[k], ends[k - 1]);
        }
    }
    int found = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (ends[i].number == ends[i + 1].number) continue;
        Powers<N> sum{N(-blob.threshold)};
        for (const Piece<N>& p : along.pieces) {
            if (!(ends[i] < p.in) && !(p.out < ends[i + 1])) sum = sum + p.density;
        }
        if (sum.count > 1) found += count(sum, ends[i].t, ends[i + 1].t);
    }
    return found;
}

int exact_count(const Blob& blob, const Ray& ray) {
    const PiecesOf<mpq_class> along(blob, exact<mpq_class>(ray.origin),
                                    exact<mpq_class>(ray.direction));
    return count_spans(blob, along, [](const auto& sum, const auto& from, const auto& to) {
        const RationalPolynomial p(sum.c.begin(),
                                   sum.c.begin() + static_cast<std::ptrdiff_t>(sum.count));
        return testing::count_roots(p, from, to);
    });
}

struct Tally {
    long by_double = 0, by_double_double = 0, by_integers = 0;
};

/// Exact: uses balls, and integers where balls are uncertain.
int certain_count(const Blob& blob, const Ray& ray, Tally& tally) {
    const double start = dot(blob.box().center() - ray.origin, ray.direction);
    const VecOf<PreciseBall> d = exact<PreciseBall>(ray.direction);
    VecOf<PreciseBall> o = exact<PreciseBall>(ray.origin);
    for (std::size_t k = 0; k < 3; ++k) o[k] = o[k] + PreciseBall(start) * d[k];
    const auto count = [](const auto& sum, const auto& from, const auto& to) {
        return testing::CertifiedSturm(sum).count(from, to);
    };
    try {
        const VecOf<DoubleBall> short_o{shortened(o[0]), shortened(o[1]), shortened(o[2])};
        const int n = count_spans(
            blob, PiecesOf<DoubleBall>(blob, short_o, exact<DoubleBall>(ray.direction)), count);
        ++tally.by_double;
        return n;
    } catch (const Uncertain&) {
    }
    try {
        const int n = count_spans(blob, PiecesOf<PreciseBall>(blob, o, d), count);
        ++tally.by_double_double;
        return n;
    } catch (const Uncertain&) {
    }
    ++tally.by_integers;
    return exact_count(blob, ray);
}

/// One ray in this many is counted in both ways.
constexpr long kCountedTwice = 512;

Blob random_blob(Random& random) {
    Blob blob{.threshold = 0.6};
    for (int i = 2 + random.below(8); i > 0; --i) {
        BlobComponent c{.base = random.in_cube(2), .radius = random.uniform(0.6, 2)};
        c.strength = random.below(5) == 0 ? -1.0 : 1.5;
        c.rod = random.below(3) == 0;
        c.top = c.rod ? c.base + random.in_cube(2) : c.base;
        blob.components.push_back(c);
    }
    blob.prepare();
    return blob;
}

TEST(BlobExact, CrossingsAreAsManyAsSturmCounts) {
    const char* wanted = std::getenv("ALHAZEN_EXACT_RAYS");
    const long rays = wanted != nullptr ? std::atol(wanted) : 20000;
    Random random(91);
    Blob blob = random_blob(random);
    long grazing = 0, crossings = 0;
    Tally tally;
    for (long i = 0; i < rays; ++i) {
        if (i % 50 == 0) blob = random_blob(random);
        const Vec3 d = random.unit_vector();
        const double far = random.below(4) == 0 ? random.log_uniform(10, 1e5) : 6.0;
        Ray ray = line(random.in_cube(2) - far * d, d);
        ShapeHits hits;
        blob.intersect(ray, hits);
        if (i % 2 == 1 && !hits.empty()) {
            const ShapeSurface s = blob.surface(ray, hits.front());
            const Vec3 along = unit_or(cross(s.normal, random.unit_vector()), {1, 0, 0});
            const double off = random.sign() * random.log_uniform(1e-16, 1e-3);
            ray = line(s.point + off * s.normal - 6.0 * along, along);
            hits.clear();
            blob.intersect(ray, hits);
            ++grazing;
        }
        const int expected = certain_count(blob, ray, tally);
        if (i % kCountedTwice == 0) {
            ASSERT_EQ(expected, exact_count(blob, ray)) << "ray " << i;
        }
        ASSERT_EQ(static_cast<int>(hits.size()), expected)
            << std::hexfloat << "ray " << i << " origin " << ray.origin.x << " " << ray.origin.y
            << " " << ray.origin.z << " direction " << ray.direction.x << " " << ray.direction.y
            << " " << ray.direction.z;
        crossings += expected;
    }
    std::printf(
        "blobs: %ld rays, %ld of them grazing, %ld crossings; counted in double %ld, in"
        " double-double %ld, in integers %ld\n",
        rays, grazing, crossings, tally.by_double, tally.by_double_double, tally.by_integers);
    EXPECT_GT(crossings, rays / 2);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
