#pragma once
/// Finds all real roots, with certified signs, of a polynomial in Bernstein form on [0, 1].
///
/// Source: Lane and Riesenfeld, "Bounds on a polynomial", BIT 21, 1981 (sign variations of
/// Bernstein coefficients bound the number of roots, de Casteljau's split halves the interval);
/// Rouillier and Zimmermann, "Efficient isolation of polynomial's real roots", Journal of
/// Computational and Applied Mathematics 162, 2004.
/// Differs: the coefficients carry an error bound; the sign of a coefficient within it is unknown,
/// and the search bounds the number of variations over all values of the unknown signs. It finds
/// sign changes, not roots: a root of even multiplicity and a pair of roots that cannot be
/// separated count as none, an odd cluster as one, so that the number of crossings always agrees
/// with the signs at both ends. It splits where the coefficients differ most from the ends.
/// Conventions: p(u) = sum b[i] C(n, i) (1 - u)^(n - i) u^i. In double the search fails where it is
/// not certain. It is then repeated in double-double, with recomputed coefficients, where it always
/// succeeds: a value that cannot be distinguished from 0 has the sign of its surroundings (at an
/// end, that of the next coefficient, but see shared_ends; if all are unknown, positive,
/// "outside"), and roots closer than 2^-52 cancel in pairs. `find_certified_sign_changes` does
/// both.
/// Complexity: O(n^2) per split; usually no split for 0 or 1 crossing, one or two for 2.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "alhazen/math/double_double.h"

namespace alhazen {

/// A polynomial of degree at most N on [0, 1].
template <class Real, int N>
struct BernsteinPolynomial {
    int degree = 0;
    double error = 0;  ///< bound on the error of every coefficient
    /// True if the ends are shared with other polynomials, such as the pieces of one curve. A value
    /// at an end that cannot be distinguished from 0 is then positive for all of them; otherwise
    /// the crossings of all pieces together would not agree with the signs.
    bool shared_ends = false;
    std::array<Real, N + 1> b;  ///< the first degree + 1 are used; not initialised
};

/// The places in [0, 1] where a polynomial changes its sign.
template <int N>
struct SignChanges {
    int count = 0;
    bool negative_at_start = false;
    std::array<double, N> u;  ///< the first `count` are set, ascending; not initialised
    /// [i] the interval that contains sign change i and no other.
    std::array<double, N> lo, hi;

    [[nodiscard]] bool negative_at_end() const { return negative_at_start != (count % 2 != 0); }
};

/// Selects all sign changes. Another type may select those that a caller needs: for a sign change
/// that is not wanted, u is any value between lo and hi. `wants` is called once for each, in
/// ascending order, and may keep state.
struct AllSignChanges {
    [[nodiscard]] bool wants(double /*lo*/, double /*hi*/) const { return true; }
};

namespace bernstein {

inline double leading(double v) {
    return v;
}
inline double leading(const DoubleDouble& v) {
    return v.high;
}

/// (1 - r) a + r b, where r is a dyadic fraction of few bits.
inline double blend(double a, double b, double r) {
    return (1.0 - r) * a + r * b;
}
inline DoubleDouble blend(const DoubleDouble& a, const DoubleDouble& b, double r) {
    return DoubleDouble(1.0 - r) * a + DoubleDouble(r) * b;
}

/// A degree known at compile time, or, as int, at run time.
template <int N>
using KnownDegree = std::integral_constant<int, N>;

/// Calls f with the degree of the polynomial: as a compile-time constant where it is N and N is
/// small.
template <class Real, int N, class F>
decltype(auto) with_degree(const BernsteinPolynomial<Real, N>& p, F&& f) {
    if constexpr (N <= 6 && std::is_same_v<Real, double>) {
        if (p.degree == N) return f(KnownDegree<N>());
    }
    return f(p.degree);
}

/// Calls f(i) for i from 0 to n; unrolled where n is a constant.
template <class F>
void for_indices(int n, F&& f) {
    for (int i = 0; i <= n; ++i) f(i);
}
template <int N, class F>
void for_indices(KnownDegree<N>, F&& f) {
    [&]<int... i>(std::integer_sequence<int, i...>) {
        (f(i), ...);
    }
    (std::make_integer_sequence<int, N + 1>());
}

/// Value and slope at u by de Casteljau's algorithm.
template <class Real, int N, class Degree>
void evaluate(const BernsteinPolynomial<Real, N>& p, Degree degree, double u, Real& value,
              double& slope) {
    const DoubleDouble rest = two_sum(1.0, -u);
    Real row[N + 2];  // one more: the compiler does not see that the last element is not read
    std::copy_n(p.b.begin(), degree + 1, row);
    slope = 0.0;
    for_indices(degree, [&](int step) {
        const int n = degree - step;
        if (n == 1) slope = degree * leading(row[1] - row[0]);
        for_indices(degree, [&](int i) {
            if (i >= n) return;
            if constexpr (std::is_same_v<Real, double>) {
                row[i] = rest.high * row[i] + u * row[i + 1];
            } else {
                row[i] = rest * row[i] + DoubleDouble(u) * row[i + 1];
            }
        });
    });
    value = row[0];
}
template <class Real, int N>
void evaluate(const BernsteinPolynomial<Real, N>& p, double u, Real& value, double& slope) {
    with_degree(p, [&](auto degree) { evaluate(p, degree, u, value, slope); });
}

/// Newton's method with a bracket: the root of f, which has `sign_lo` at lo and the opposite sign
/// at hi. `f(x, value, slope)`; x and the value are double.
template <class F>
double bracketed_newton(F&& f, double lo, double hi, double sign_lo, double guess) {
    double x = guess;
    double last_step = hi - lo;
    for (int i = 0; i < 200; ++i) {
        double value, slope;
        f(x, value, slope);
        if (value == 0.0) return x;
        (value * sign_lo > 0.0 ? lo : hi) = x;
        double next = x - value / slope;
        // Outside the bracket, NaN, or no gain: bisect.
        if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
        const double step = std::abs(next - x);
        if (step > 0.5 * last_step && i > 2) next = 0.5 * (lo + hi);
        // Convergence is quadratic, so this step is the last that matters. Near a double root it is
        // linear, and steps shrink by half.
        const bool fast = step <= 1e-9 * std::abs(x) && step <= 1e-4 * last_step;
        last_step = std::abs(next - x);
        x = next;
        if (fast || last_step <= 0x1p-52 * std::abs(x)) {
            if (last_step <= 0x1p-51 * std::abs(x)) return x;
            f(x, value, slope);
            next = x - value / slope;
            return next >= lo && next <= hi ? next : x;
        }
        if (!(hi - lo > 0x1p-53 * hi)) return x;
    }
    return x;
}

/// [n][i] is C(n, i).
template <int N>
inline constexpr std::array<std::array<double, N + 1>, N + 1> kBinomials = [] {
    std::array<std::array<double, N + 1>, N + 1> table{};
    for (std::size_t n = 0; n <= N; ++n) {
        table[n][0] = 1.0;
        for (std::size_t i = 1; i <= n; ++i) {
            table[n][i] = table[n - 1][i - 1] + (i < n ? table[n - 1][i] : 0.0);
        }
    }
    return table;
}();

/// C(n, i) b[i]: p(u) = (1 - u)^n q(u / (1 - u)), where q has these coefficients.
template <int N, class Degree>
struct ScaledPolynomial {
    [[no_unique_address]] Degree degree;
    std::array<double, N + 1> s{};  // the compiler does not see that only written elements are read

    ScaledPolynomial(const BernsteinPolynomial<double, N>& p, Degree n) : degree(n) {
        const double* row = kBinomials<N>[static_cast<std::size_t>(static_cast<int>(n))].data();
        const double* b = p.b.data();
        double* to = s.data();
        for_indices(n, [&](int i) { to[i] = row[i] * b[i]; });
    }
    void operator()(double w, double& value, double& slope) const {
        const double* from = s.data();
        value = from[degree];
        slope = 0.0;
        for_indices(degree, [&](int step) {
            if (step == 0) return;
            slope = slope * w + value;
            value = value * w + from[degree - step];
        });
    }
};

/// The search, in double or double-double.
template <class Real, int N, class Wanted, class Degree>
class SignChangeSearch {
    static constexpr bool kMustAnswer = !std::is_same_v<Real, double>;
    /// Rounding error of one step of a split (two products and their sum), relative to the largest
    /// coefficient.
    static constexpr double kRounding = kMustAnswer ? kDoubleDoubleUlp : 0x1p-52;

  public:
    SignChangeSearch(const BernsteinPolynomial<Real, N>& p, Degree degree, Wanted& wanted,
                     SignChanges<N>& out)
        : p_(p), degree_(degree), wanted_(wanted), out_(out) {}

    /// Returns false if the signs are not certain (never in double-double).
    bool run() {
        out_.count = 0;
        out_.negative_at_start = false;
        const int n = degree_;
        double total = p_.error;
        for_indices(degree_, [&](int i) { total += std::abs(leading(p_.b[i])); });
        // Overflow or NaN: the polynomial counts as having no crossings.
        if (!std::isfinite(total)) return true;
        int first = sign(p_.b[0], p_.error), last = sign(p_.b[n], p_.error);
        if (first == 0 || last == 0) {
            if (!kMustAnswer) return false;
            if (first == 0) first = sign_beside(0, 1);
            if (last == 0) last = sign_beside(n, -1);
        }
        out_.negative_at_start = first < 0;
        if constexpr (!kMustAnswer) {
            if (first == last) {
                const int most = most_variations(p_.b.data(), p_.error, first, last);
                if (most == 0) return true;
                if (most == 2 && found_between(first)) return true;
            }
        }
        return search(p_.b.data(), p_.error, 0.0, 1.0, first, last);
    }

  private:
    static int sign(const Real& v, double error) {
        return int(leading(v) > error) - int(leading(v) < -error);
    }

    /// The sign beside an end where p is 0: that of the nearest coefficient whose sign is known.
    int sign_beside(int end, int step) const {
        if (p_.shared_ends) return 1;
        for (int i = end; i >= 0 && i <= degree_; i += step) {
            const int s = sign(p_.b[static_cast<std::size_t>(i)], p_.error);
            if (s != 0) return s;
        }
        return 1;
    }

    /// An upper bound of the number of sign changes of the coefficients, over all signs of the
    /// unknown ones.
    int most_variations(const Real* b, double error, int first, int last) const {
        int most = 0, previous = first, unknown = 0;
        for_indices(degree_, [&](int i) {
            if (i == 0) return;
            const int s = i == degree_ ? last : sign(b[i], error);
            if (s == 0) {
                ++unknown;
                return;
            }
            most += s == previous ? (unknown + 1) / 2 * 2 : 1 + unknown / 2 * 2;
            previous = s;
            unknown = 0;
        });
        return most;
    }

    /// Isolates two changes by a point between them that has the other sign: one change lies on
    /// either side of it. Returns false if no such point is found.
    bool found_between(int first) {
        const Extremes e = extremes(p_.b.data(), first);
        const bool mirrored = e.middle > 0.5;
        const double far = mirrored ? e.middle : 1.0 - e.middle;  // the length of the larger part
        double value, slope;
        const ScaledPolynomial<N, Degree> q(p_, degree_);
        if (mirrored) {
            reversed(q)((1.0 - e.middle) / far, value, slope);
        } else {
            q(e.middle / far, value, slope);
        }
        // The value is p over far^n; `error` bounds its rounding, relative to the largest
        // coefficient.
        double scale = 1.0;
        for_indices(degree_, [&](int i) { scale *= i == 0 ? 1.0 : far; });
        const double error = p_.error + 4.0 * degree_ * kRounding * e.largest;
        if (!(-first * value * scale > error)) return false;
        return emit(0.0, e.middle, first) && emit(e.middle, 1.0, -first);
    }
    static ScaledPolynomial<N, Degree> reversed(ScaledPolynomial<N, Degree> q) {
        std::reverse(q.s.begin(), q.s.begin() + q.degree + 1);
        return q;
    }

    struct Extremes {
        double largest = 0;   ///< the largest magnitude of a coefficient
        double middle = 0.5;  ///< where the coefficients differ most from the first one
    };
    Extremes extremes(const Real* b, int first) const {
        Extremes e;
        double lowest = 0.0;
        int at = 0;
        for_indices(degree_, [&](int i) {
            const double value = leading(b[i]);
            e.largest = std::max(e.largest, std::abs(value));
            if (i == 0 || i == degree_ || !(first * value < lowest)) return;
            lowest = first * value;
            at = i;
        });
        if (at > 0) {
            e.middle = std::clamp(static_cast<int>(8.0 * at / degree_ + 0.5), 1, 7) / 8.0;
        }
        return e;
    }

    /// Splits b at r; `left` and `right` receive the coefficients of the two parts.
    void split(const Real* b, double r, Real* left, Real* right) const {
        for_indices(degree_, [&](int i) { right[i] = b[i]; });
        left[0] = right[0];
        for_indices(degree_, [&](int k) {
            if (k == 0) return;
            for_indices(degree_, [&](int i) {
                if (i <= degree_ - k) right[i] = blend(right[i], right[i + 1], r);
            });
            left[k] = right[0];
        });
    }

    bool search(const Real* b, double error, double lo, double hi, int first, int last) {
        const int most = most_variations(b, error, first, last);
        if (most == 0) return true;
        if (most == 1) return emit(lo, hi, first);
        const Extremes e = extremes(b, first);
        if (!(hi - lo > 0x1p-52) || e.largest <= 8.0 * error) {
            return cluster(lo, hi, first, last);
        }
        Real left[N + 2], right[N + 2];  // as in `evaluate`
        const double child_error = error + degree_ * kRounding * e.largest;
        const double candidates[] = {e.middle, 0.5, 0.375, 0.625, 0.25, 0.75};
        int middle_sign = 0;
        double r = 0.5;
        for (const double candidate : candidates) {
            r = candidate;
            split(b, r, left, right);
            middle_sign = sign(right[0], child_error);
            if (middle_sign != 0) break;
        }
        if (middle_sign == 0) {
            if (!kMustAnswer) return false;
            middle_sign = first == last ? first : 1;
        }
        const double middle = lo + r * (hi - lo);
        return search(left, child_error, lo, middle, first, middle_sign) &&
               search(right, child_error, middle, hi, middle_sign, last);
    }

    /// Handles an interval whose roots cannot be separated.
    bool cluster(double lo, double hi, int first, int last) {
        if (!kMustAnswer) return false;
        return first == last || emit(lo, hi, first);
    }

    bool put(double u, double lo, double hi) {
        if (out_.count >= N) return false;
        const auto i = static_cast<std::size_t>(out_.count++);
        out_.u[i] = std::clamp(u, lo, hi);
        out_.lo[i] = lo;
        out_.hi[i] = hi;
        return true;
    }

    bool emit(double lo, double hi, int sign_lo) {
        if (!wanted_.wants(lo, hi)) return put(lo, lo, hi);
        if constexpr (kMustAnswer) {
            const auto f = [&](double u, double& value, double& slope) {
                Real exact;
                evaluate(p_, degree_, u, exact, slope);
                value = leading(exact);
            };
            return put(bracketed_newton(f, lo, hi, sign_lo, 0.5 * (lo + hi)), lo, hi);
        } else {
            return put(polish(lo, hi, sign_lo), lo, hi);
        }
    }

    /// The root in [lo, hi], found as a root of the scaled polynomial or of its mirror image,
    /// whichever has it at w <= 1.
    double polish(double lo, double hi, double sign_lo) const {
        const ScaledPolynomial<N, Degree> q(p_, degree_);
        if (lo < 0.5 && hi > 0.5) {
            double value, slope;
            q(1.0, value, slope);
            (value * sign_lo > 0.0 ? lo : hi) = 0.5;
        }
        if (hi <= 0.5) {
            const double w = root_of(q, lo / (1.0 - lo), hi / (1.0 - hi), sign_lo);
            return w / (1.0 + w);
        }
        const double w = root_of(reversed(q), (1.0 - hi) / hi, (1.0 - lo) / lo, -sign_lo);
        return 1.0 / (1.0 + w);
    }

    static double root_of(const ScaledPolynomial<N, Degree>& q, double lo, double hi,
                          double sign_lo) {
        double f_lo = q.s[0], f_hi, slope;
        if (lo > 0.0) q(lo, f_lo, slope);
        q(hi, f_hi, slope);
        double guess = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
        if (!(guess >= lo && guess <= hi)) guess = 0.5 * (lo + hi);
        return bracketed_newton(q, lo, hi, sign_lo, guess);
    }

    const BernsteinPolynomial<Real, N>& p_;
    [[no_unique_address]] Degree degree_;
    Wanted& wanted_;
    SignChanges<N>& out_;
};

}  // namespace bernstein

/// Finds the sign changes in double. Returns false if they are not certain; `out` is then invalid.
template <int N, class Wanted = const AllSignChanges>
[[nodiscard]] bool find_sign_changes(const BernsteinPolynomial<double, N>& p, SignChanges<N>& out,
                                     Wanted&& wanted = {}) {
    using W = std::remove_reference_t<Wanted>;
    return bernstein::with_degree(p, [&](auto degree) {
        return bernstein::SignChangeSearch<double, N, W, decltype(degree)>(p, degree, wanted, out)
            .run();
    });
}
/// Finds the sign changes in double-double. Always succeeds; see the conventions for values that
/// cannot be distinguished from 0.
template <int N, class Wanted = const AllSignChanges>
void find_sign_changes(const BernsteinPolynomial<DoubleDouble, N>& p, SignChanges<N>& out,
                       Wanted&& wanted = {}) {
    using W = std::remove_reference_t<Wanted>;
    bernstein::SignChangeSearch<DoubleDouble, N, W, int>(p, p.degree, wanted, out).run();
}

/// Finds the sign changes in double and, where that is not certain, in double-double.
/// `make(BernsteinPolynomial<Real, N>&)` computes the coefficients and their error bound; its calls
/// must describe the same polynomial.
template <int N, class Make, class Wanted = AllSignChanges>
void find_certified_sign_changes(Make&& make, SignChanges<N>& out, const Wanted& wanted = {}) {
    BernsteinPolynomial<double, N> p;
    make(p);
    if (find_sign_changes(p, out, wanted)) return;
    BernsteinPolynomial<DoubleDouble, N> precise;
    make(precise);
    find_sign_changes(precise, out, wanted);
}

}  // namespace alhazen
