#pragma once
/// Exact number of distinct roots of a polynomial with rational coefficients in an interval, by
/// integers of any length and primitive remainders.
/// Source: Sturm's theorem, as in Basu, Pollack and Roy, "Algorithms in Real Algebraic Geometry",
/// 2nd ed., 2006, section 2.2.

#include <gmpxx.h>

#include <algorithm>
#include <vector>

namespace alhazen::testing {

/// Coefficients in ascending order of powers.
using RationalPolynomial = std::vector<mpq_class>;

inline RationalPolynomial operator+(RationalPolynomial a, const RationalPolynomial& b) {
    if (a.size() < b.size()) a.resize(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) a[i] += b[i];
    return a;
}
inline RationalPolynomial operator*(const RationalPolynomial& a, const RationalPolynomial& b) {
    if (a.empty() || b.empty()) return {};
    RationalPolynomial product(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < b.size(); ++k) product[i + k] += a[i] * b[k];
    }
    return product;
}
inline RationalPolynomial operator*(const mpq_class& s, RationalPolynomial a) {
    for (mpq_class& c : a) c *= s;
    return a;
}
inline RationalPolynomial operator-(const RationalPolynomial& a, const RationalPolynomial& b) {
    return a + mpq_class(-1) * b;
}

class SturmSequence {
  public:
    explicit SturmSequence(const RationalPolynomial& p) {
        std::vector<mpz_class> first = integers(p);
        if (first.size() < 2) return;
        std::vector<mpz_class> second;
        for (std::size_t i = 1; i < first.size(); ++i) {
            second.push_back(first[i] * static_cast<unsigned long>(i));
        }
        reduce(second);
        rows_.push_back(first);
        while (!second.empty()) {
            std::vector<mpz_class> rest = negative_remainder(rows_.back(), second);
            rows_.push_back(second);
            second = std::move(rest);
        }
    }
    [[nodiscard]] bool constant() const { return rows_.empty(); }
    /// Roots in (a, b], each counted once.
    [[nodiscard]] int count(const mpq_class& a, const mpq_class& b) const {
        return variations(a) - variations(b);
    }

  private:
    static std::vector<mpz_class> integers(const RationalPolynomial& p) {
        mpz_class common = 1;
        for (const mpq_class& c : p) common = lcm(common, c.get_den());
        std::vector<mpz_class> out;
        for (const mpq_class& c : p) out.push_back(c.get_num() * (common / c.get_den()));
        reduce(out);
        return out;
    }
    /// Removes leading zeros and the positive common factor.
    static void reduce(std::vector<mpz_class>& p) {
        while (!p.empty() && p.back() == 0) p.pop_back();
        mpz_class content = 0;
        for (const mpz_class& c : p) content = gcd(content, c);
        if (content > 1) {
            for (mpz_class& c : p) c /= content;
        }
    }
    static std::vector<mpz_class> negative_remainder(std::vector<mpz_class> a,
                                                     const std::vector<mpz_class>& b) {
        const mpz_class lead = abs(b.back());
        const int sign = sgn(b.back());
        while (a.size() >= b.size()) {
            const mpz_class factor = a.back() * sign;
            const std::size_t shift = a.size() - b.size();
            for (mpz_class& c : a) c *= lead;
            for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] -= factor * b[i];
            reduce(a);
            if (a.empty()) break;
        }
        for (mpz_class& c : a) c = -c;
        return a;
    }
    [[nodiscard]] int variations(const mpq_class& at) const {
        int count = 0, previous = 0;
        const mpz_class &n = at.get_num(), &d = at.get_den();
        for (const auto& row : rows_) {
            // Homogeneous Horner scheme: the value times d^degree > 0.
            mpz_class value = row.back(), power = 1;
            for (std::size_t i = row.size() - 1; i-- > 0;) {
                power *= d;
                value = value * n + row[i] * power;
            }
            const int s = sgn(value);
            if (s == 0) continue;
            count += previous != 0 && s != previous;
            previous = s;
        }
        return count;
    }

    std::vector<std::vector<mpz_class>> rows_;
};

/// Pairs of neighbouring roots in (a, b] that are closer than `distance`.
inline int close_pairs(const SturmSequence& sturm, const mpq_class& a, const mpq_class& b,
                       const mpq_class& distance) {
    std::vector<std::pair<mpq_class, int>> found;
    const auto isolate = [&](const auto& self, const mpq_class& lo, const mpq_class& hi) -> void {
        const int n = sturm.count(lo, hi);
        if (n == 0) return;
        if (hi - lo < distance) {
            found.emplace_back(lo, n);
            return;
        }
        const mpq_class middle = (lo + hi) / 2;
        self(self, lo, middle);
        self(self, middle, hi);
    };
    isolate(isolate, a, b);
    int pairs = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        pairs += found[i].second - 1;
        if (i > 0 && found[i].first - found[i - 1].first < 2 * distance) ++pairs;
    }
    return pairs;
}

}  // namespace alhazen::testing
