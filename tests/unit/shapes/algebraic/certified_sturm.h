#pragma once
/// Number of distinct roots of a polynomial, for any number type: exact with rational numbers; with
/// balls exact or rejected.
/// Remainders are multiplied by positive numbers instead of divided.
/// Conventions: coefficients in ascending order of powers.
/// Source: Sturm's theorem, as in Basu, Pollack and Roy, "Algorithms in Real Algebraic Geometry",
/// 2nd ed., 2006, section 2.2.

#include <algorithm>
#include <array>
#include <initializer_list>

#include "unit/shapes/algebraic/certified_numbers.h"

namespace alhazen::testing {

inline constexpr std::size_t kMostPowers = 14;

/// Univariate polynomial.
template <class N>
struct Powers {
    std::array<N, kMostPowers> c{};
    std::size_t count = 0;

    Powers() = default;
    Powers(std::initializer_list<N> list) {
        for (const N& x : list) c[count++] = x;
    }
    [[nodiscard]] const N& lead() const { return c[count - 1]; }

    friend Powers operator+(const Powers& a, const Powers& b) { return sum(a, b, false); }
    friend Powers operator-(const Powers& a, const Powers& b) { return sum(a, b, true); }
    friend Powers operator*(const Powers& a, const Powers& b) {
        Powers p;
        if (a.count == 0 || b.count == 0) return p;
        p.count = a.count + b.count - 1;
        for (std::size_t i = 0; i < p.count; ++i) {
            const std::size_t first = i < b.count ? 0 : i - b.count + 1;
            p.c[i] = a.c[first] * b.c[i - first];
            for (std::size_t k = first + 1; k < a.count && k <= i; ++k) {
                p.c[i] = p.c[i] + a.c[k] * b.c[i - k];
            }
        }
        return p;
    }

  private:
    static Powers sum(const Powers& a, const Powers& b, bool minus) {
        Powers s;
        s.count = std::max(a.count, b.count);
        for (std::size_t i = 0; i < s.count; ++i) {
            const bool in_a = i < a.count, in_b = i < b.count;
            if (!in_b) {
                s.c[i] = a.c[i];
            } else if (!in_a) {
                s.c[i] = minus ? N(-b.c[i]) : b.c[i];
            } else {
                s.c[i] = minus ? N(a.c[i] - b.c[i]) : N(a.c[i] + b.c[i]);
            }
        }
        return s;
    }
};

/// Multiplies by a power of two that brings the largest coefficient near 1.
template <class Real>
void normalize(Powers<Ball<Real>>& p) {
    double largest = 0;
    for (std::size_t i = 0; i < p.count; ++i) largest = std::max(largest, std::abs(p.c[i].high()));
    if (!(largest > 0.0)) return;
    const int exponent = -std::ilogb(largest);
    for (std::size_t i = 0; i < p.count; ++i) p.c[i] = scaled(p.c[i], exponent);
}

/// Sturm sequence of a polynomial whose remainders fall by one degree each; others, and sequences
/// that end early, throw Uncertain.
template <class N>
class CertifiedSturm {
  public:
    explicit CertifiedSturm(Powers<N> p) {
        while (p.count > 0 && sign_of(p.lead()) == 0) --p.count;
        if (p.count < 2) return;
        normalize(p);
        Powers<N> slope;
        for (std::size_t i = 1; i < p.count; ++i) {
            slope.c[slope.count++] = N(static_cast<double>(i)) * p.c[i];
        }
        rows_[size_++] = p;
        rows_[size_++] = slope;
        while (rows_[size_ - 1].count > 1) {
            rows_[size_] = negative_remainder(rows_[size_ - 2], rows_[size_ - 1]);
            ++size_;
        }
        for (std::size_t i = 0; i < size_; ++i) {
            if (sign_of(rows_[i].lead()) == 0) throw Uncertain{};
        }
    }
    /// Number of roots on the whole line.
    [[nodiscard]] int count() const {
        return variations([](const Powers<N>& row) {
                   return row.count % 2 == 0 ? -sign_of(row.lead()) : sign_of(row.lead());
               }) -
               variations([](const Powers<N>& row) { return sign_of(row.lead()); });
    }
    /// Number of roots between two points that are not roots.
    [[nodiscard]] int count(const N& from, const N& to) const {
        const auto at = [&](const N& x) {
            return variations([&](const Powers<N>& row) {
                N value = row.lead();
                for (std::size_t i = row.count - 1; i-- > 0;) value = value * x + row.c[i];
                return known_sign(value);
            });
        };
        return at(from) - at(to);
    }

  private:
    static Powers<N> negative_remainder(Powers<N> a, const Powers<N>& b) {
        const int sign = sign_of(b.lead());
        if (sign == 0) throw Uncertain{};
        const N size = sign > 0 ? b.lead() : -b.lead();
        for (int step = 0; step < 2; ++step) {
            const N factor = sign > 0 ? a.lead() : -a.lead();
            const std::size_t shift = a.count - b.count;
            for (std::size_t i = 0; i + 1 < a.count; ++i) {
                a.c[i] = size * a.c[i];
                if (i >= shift) a.c[i] = a.c[i] - factor * b.c[i - shift];
            }
            --a.count;
        }
        for (std::size_t i = 0; i < a.count; ++i) a.c[i] = -a.c[i];
        normalize(a);
        return a;
    }
    /// An unknown sign between two different signs does not change the count.
    template <class Sign>
    [[nodiscard]] int variations(Sign&& sign) const {
        std::array<int, kMostPowers> s{};
        for (std::size_t i = 0; i < size_; ++i) s[i] = sign(rows_[i]);
        int found = 0, previous = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            if (s[i] == 0) {
                const bool between = i > 0 && i + 1 < size_ && s[i - 1] * s[i + 1] < 0;
                if (!between) throw Uncertain{};
                continue;
            }
            found += previous != 0 && s[i] != previous;
            previous = s[i];
        }
        return found;
    }

    std::array<Powers<N>, kMostPowers> rows_;
    std::size_t size_ = 0;
};

}  // namespace alhazen::testing
