#pragma once
/// Exact number of distinct real roots of a polynomial with rational coefficients, as a reference.
/// Conventions: coefficients in ascending order of powers; roots in the half-open interval (lo,
/// hi].
/// Source: Basu, Pollack and Roy, "Algorithms in Real Algebraic Geometry", 2nd ed., 2006, section
/// 2.2.2 (Sturm's theorem).

#include <gmpxx.h>

#include <vector>

namespace alhazen::testing {

using RationalPolynomial = std::vector<mpq_class>;

inline void trim(RationalPolynomial& p) {
    while (!p.empty() && p.back() == 0) p.pop_back();
}

inline RationalPolynomial product(const RationalPolynomial& a, const RationalPolynomial& b) {
    RationalPolynomial c(a.empty() || b.empty() ? 0 : a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < b.size(); ++k) c[i + k] += a[i] * b[k];
    }
    return c;
}

inline mpq_class value(const RationalPolynomial& p, const mpq_class& x) {
    mpq_class sum = 0;
    for (std::size_t i = p.size(); i-- > 0;) sum = sum * x + p[i];
    return sum;
}

/// Negated remainder of a by b.
inline RationalPolynomial minus_remainder(RationalPolynomial a, const RationalPolynomial& b) {
    while (a.size() >= b.size()) {
        const mpq_class factor = a.back() / b.back();
        const std::size_t shift = a.size() - b.size();
        for (std::size_t i = 0; i < b.size(); ++i) a[shift + i] -= factor * b[i];
        a.pop_back();
        trim(a);
        if (a.empty()) break;
    }
    for (mpq_class& c : a) c = -c;
    return a;
}

inline int sturm_variations(const std::vector<RationalPolynomial>& chain, const mpq_class& x) {
    int variations = 0, last = 0;
    for (const RationalPolynomial& p : chain) {
        const int s = sgn(value(p, x));
        if (s == 0) continue;
        variations += last != 0 && s != last;
        last = s;
    }
    return variations;
}

inline int count_roots(RationalPolynomial p, const mpq_class& lo, const mpq_class& hi) {
    trim(p);
    if (p.size() < 2) return 0;
    std::vector<RationalPolynomial> chain{p, {}};
    for (std::size_t i = 1; i < p.size(); ++i) {
        chain[1].push_back(p[i] * mpq_class(static_cast<unsigned long>(i)));
    }
    for (;;) {
        RationalPolynomial next = minus_remainder(chain[chain.size() - 2], chain.back());
        if (next.empty()) break;
        chain.push_back(std::move(next));
    }
    return sturm_variations(chain, lo) - sturm_variations(chain, hi);
}

}  // namespace alhazen::testing
