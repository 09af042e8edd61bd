// Crossings of random and grazing rays with blobs against the exact number that the ray's and the
// blob's doubles define. ALHAZEN_EXACT_RAYS in the environment: how many rays, 2000 by default.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "alhazen/math/unit_vector.h"
#include "alhazen/shapes/blob.h"
#include "exact_sturm.h"
#include "support/random.h"

namespace alhazen {
namespace {

using testing::line;
using testing::Random;
using testing::RationalPolynomial;

using ExactVec = std::array<mpq_class, 3>;

ExactVec exact(const Vec3& v) {
    return {mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)};
}
ExactVec minus(const ExactVec& a, const ExactVec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
mpq_class dot_of(const ExactVec& a, const ExactVec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
ExactVec cross_of(const ExactVec& a, const ExactVec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A rational number that is right to 2^-200.
mpq_class root_of(const mpq_class& x) {
    mpf_class r(0, 512);
    r = x;
    r = sqrt(r);
    mpq_class q(r);
    q.canonicalize();
    return q;
}

struct ExactPiece {
    mpq_class in, out;
    RationalPolynomial density;
};

/// strength (1 - |f + t d|^2 / scale)^2 where the quadratic is positive and between `lo` and `hi`,
/// where these are given.
void add_piece(const ExactVec& f, const ExactVec& d, const mpq_class& scale, double strength,
               const mpq_class* lo, const mpq_class* hi, std::vector<ExactPiece>& pieces) {
    const mpq_class a = dot_of(d, d), b = dot_of(f, d), c = dot_of(f, f) - scale;
    mpq_class in, out;
    if (a == 0) {
        if (c >= 0 || lo == nullptr || hi == nullptr) return;
        in = *lo, out = *hi;
    } else {
        const mpq_class discriminant = b * b - a * c;
        if (discriminant <= 0) return;
        const mpq_class s = root_of(discriminant);
        in = (-b - s) / a, out = (-b + s) / a;
        if (lo != nullptr) in = std::max(in, *lo);
        if (hi != nullptr) out = std::min(out, *hi);
    }
    if (in >= out) return;
    const RationalPolynomial q{-c / scale, -2 * b / scale, -a / scale};
    RationalPolynomial density = testing::product(q, q);
    for (mpq_class& x : density) x *= mpq_class(strength);
    pieces.push_back({in, out, density});
}

std::vector<ExactPiece> pieces_of(const Blob& blob, const Ray& ray) {
    std::vector<ExactPiece> pieces;
    const ExactVec o = exact(ray.origin), d = exact(ray.direction);
    for (const BlobComponent& c : blob.components) {
        const mpq_class r2 = mpq_class(c.radius) * mpq_class(c.radius);
        const ExactVec f = minus(o, exact(c.base));
        if (!c.rod) {
            add_piece(f, d, r2, c.strength, nullptr, nullptr, pieces);
            continue;
        }
        const ExactVec e = minus(exact(c.top), exact(c.base));
        const mpq_class ee = dot_of(e, e), start = dot_of(f, e), speed = dot_of(d, e);
        // Random rays are not across a rod exactly.
        const mpq_class at_base = -start / speed, at_top = (ee - start) / speed;
        const mpq_class first = std::min(at_base, at_top), last = std::max(at_base, at_top);
        const ExactVec g = minus(o, exact(c.top));
        add_piece(speed > 0 ? f : g, d, r2, c.strength, nullptr, &first, pieces);
        add_piece(cross_of(f, e), cross_of(d, e), r2 * ee, c.strength, &first, &last, pieces);
        add_piece(speed > 0 ? g : f, d, r2, c.strength, &last, nullptr, pieces);
    }
    return pieces;
}

int exact_crossings(const Blob& blob, const Ray& ray) {
    const std::vector<ExactPiece> pieces = pieces_of(blob, ray);
    std::vector<mpq_class> ends;
    for (const ExactPiece& p : pieces) {
        ends.push_back(p.in);
        ends.push_back(p.out);
    }
    std::sort(ends.begin(), ends.end());
    int count = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (ends[i] == ends[i + 1]) continue;
        RationalPolynomial sum{mpq_class(-blob.threshold), 0, 0, 0, 0};
        for (const ExactPiece& p : pieces) {
            if (p.in > ends[i] || p.out < ends[i + 1]) continue;
            for (std::size_t k = 0; k < p.density.size(); ++k) sum[k] += p.density[k];
        }
        count += testing::count_roots(sum, ends[i], ends[i + 1]);
    }
    return count;
}

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
    const long rays = wanted != nullptr ? std::atol(wanted) : 2000;
    Random random(91);
    Blob blob = random_blob(random);
    long grazing = 0, crossings = 0;
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
        const int expected = exact_crossings(blob, ray);
        ASSERT_EQ(static_cast<int>(hits.size()), expected)
            << std::hexfloat << "ray " << i << " origin " << ray.origin.x << " " << ray.origin.y
            << " " << ray.origin.z << " direction " << ray.direction.x << " " << ray.direction.y
            << " " << ray.direction.z;
        crossings += expected;
    }
    std::printf("%ld rays, %ld of them grazing, %ld crossings\n", rays, grazing, crossings);
    EXPECT_GT(crossings, rays / 2);
}

}  // namespace
}  // namespace alhazen
