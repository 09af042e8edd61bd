/// `kajiya`: the two planes of the line as polynomials in v whose coefficients are polynomials in
/// u; their resultant, of degree 18 for a bicubic patch; its roots by Laguerre's method.
///
/// Source: Kajiya, "Ray Tracing Parametric Patches", SIGGRAPH 1982; Laguerre's method with
/// deflation: Press, Flannery, Teukolsky and Vetterling, "Numerical Recipes", 1986, section 9.5.
/// Differs: Bezout's determinant (3 x 3) in place of Sylvester's; v is the common root of both
/// polynomials, selected from the roots of one by the value of the other.
/// Conventions: power basis and double precision, as in the source: a root is real if its imaginary
/// part is below 1e-7, and common if the other polynomial is below 1e-6 of its coefficients.
/// Complexity: O(degree^4) for the resultant, about five steps for each of its roots.

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

#include "alhazen/shapes/patches/methods/each_patch.h"

namespace alhazen {
namespace {

using PowerPolynomial = std::vector<double>;  // ascending powers
using Complex = std::complex<double>;

constexpr double kReal = 1e-7;
constexpr double kCommon = 1e-6;
constexpr double kSameCommonRoot = 1e-7;

/// sum += factor * a * b.
void add_product(PowerPolynomial& sum, const PowerPolynomial& a, const PowerPolynomial& b,
                 double factor) {
    if (a.empty() || b.empty()) return;
    if (sum.size() < a.size() + b.size() - 1) sum.resize(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) sum[i + j] += factor * a[i] * b[j];
    }
}

double binomial(int n, int k) {
    double value = 1;
    for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
    return value;
}

/// [k] = the coefficient of t^k in Bernstein polynomial i of degree n.
double power_coefficient(int n, int i, int k) {
    if (k < i) return 0.0;
    return ((k - i) % 2 == 0 ? 1.0 : -1.0) * binomial(n, i) * binomial(n - i, k - i);
}

/// [j] = the coefficient of v^j, a polynomial in u, of x or y of the net.
std::vector<PowerPolynomial> rows_of(const PlaneNet& net, double PlanePoint::*part) {
    const int n = net.degree_u, m = net.degree_v;
    std::vector<PowerPolynomial> rows(static_cast<std::size_t>(m + 1),
                                      PowerPolynomial(static_cast<std::size_t>(n + 1)));
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            const double c = net.at[static_cast<std::size_t>(i * (m + 1) + j)].*part;
            for (int l = j; l <= m; ++l) {
                const double by_v = c * power_coefficient(m, j, l);
                for (int k = i; k <= n; ++k) {
                    rows[static_cast<std::size_t>(l)][static_cast<std::size_t>(k)] +=
                        by_v * power_coefficient(n, i, k);
                }
            }
        }
    }
    return rows;
}

/// Bezout's determinant of two polynomials in v of equal degree.
PowerPolynomial resultant(const std::vector<PowerPolynomial>& a,
                          const std::vector<PowerPolynomial>& b) {
    const std::size_t m = a.size() - 1;
    std::vector<PowerPolynomial> entry(m * m);
    for (std::size_t r = 0; r < m; ++r) {
        for (std::size_t s = 0; s < m; ++s) {
            for (std::size_t k = 0; k <= std::min(r, m - 1 - s); ++k) {
                add_product(entry[r * m + s], a[s + 1 + k], b[r - k], 1.0);
                add_product(entry[r * m + s], a[r - k], b[s + 1 + k], -1.0);
            }
        }
    }
    // Minors of the first rows, by the set of their columns.
    std::vector<PowerPolynomial> minor(std::size_t{1} << m);
    minor[0] = {1.0};
    for (std::size_t set = 0; set + 1 < minor.size(); ++set) {
        const auto row = static_cast<std::size_t>(std::popcount(set));
        for (std::size_t column = 0; column < m; ++column) {
            if ((set >> column & 1) != 0) continue;
            const double sign = std::popcount(set >> column) % 2 == 0 ? 1.0 : -1.0;
            add_product(minor[set | std::size_t{1} << column], minor[set], entry[row * m + column],
                        sign);
        }
    }
    return minor.back();
}

/// A root of a polynomial with complex coefficients.
Complex laguerre(const std::vector<Complex>& c, Complex x, std::uint64_t& steps) {
    const double n = static_cast<double>(c.size() - 1);
    for (int step = 1; step <= 60; ++step) {
        ++steps;
        Complex p = c.back(), d = 0, f = 0;
        double error = std::abs(p);
        for (std::size_t k = c.size() - 1; k-- > 0;) {
            f = x * f + d;
            d = x * d + p;
            p = x * p + c[k];
            error = std::abs(p) + std::abs(x) * error;
        }
        if (std::abs(p) <= 1e-16 * error) break;
        const Complex g = d / p, h = g * g - 2.0 * f / p;
        const Complex root = std::sqrt((n - 1.0) * (n * h - g * g));
        const Complex plus = g + root, minus = g - root;
        const Complex larger = std::abs(plus) > std::abs(minus) ? plus : minus;
        // Breaks a rare cycle by a step of another length.
        const Complex move = std::abs(larger) > 0.0 ? n / larger : Complex(1.0, double(step));
        const Complex next = x - (step % 10 != 0 ? move : 0.37 * move);
        if (next == x) break;
        x = next;
    }
    return x;
}

/// The real roots in [0, 1], each refined with the undeflated polynomial.
std::vector<double> unit_roots(PowerPolynomial p, std::uint64_t& steps) {
    double most = 0;
    for (const double c : p) most = std::max(most, std::abs(c));
    if (!(most > 0.0) || !std::isfinite(most)) return {};
    while (p.size() > 1 && std::abs(p.back()) <= 1e-14 * most) p.pop_back();
    const std::vector<Complex> whole(p.begin(), p.end());
    std::vector<Complex> left = whole;
    std::vector<double> roots;
    while (left.size() > 1) {
        const Complex rough = laguerre(left, 0.0, steps);
        Complex carry = left.back();
        for (std::size_t k = left.size() - 1; k-- > 0;) {
            const Complex c = left[k];
            left[k] = carry;
            carry = c + rough * carry;
        }
        left.pop_back();
        const Complex root = laguerre(whole, rough, steps);
        if (std::abs(root.imag()) > kReal) continue;
        if (root.real() >= -kReal && root.real() <= 1.0 + kReal) roots.push_back(root.real());
    }
    return roots;
}

PowerPolynomial at_u(const std::vector<PowerPolynomial>& rows, double u) {
    PowerPolynomial out;
    for (const PowerPolynomial& row : rows) {
        double value = 0;
        for (std::size_t k = row.size(); k-- > 0;) value = value * u + row[k];
        out.push_back(value);
    }
    return out;
}

/// The value at v over the sum of the magnitudes of the coefficients.
double relative_value(const PowerPolynomial& p, double v) {
    double value = 0, size = 0;
    for (std::size_t k = p.size(); k-- > 0;) {
        value = value * v + p[k];
        size += std::abs(p[k]);
    }
    return size > 0.0 ? std::abs(value) / size : 0.0;
}

class Kajiya final : public EachPatchMethod {
  public:
    using EachPatchMethod::EachPatchMethod;

  private:
    void meet(const BezierNet& net, std::uint32_t patch, PatchQuestion& question) override {
        const PlaneNet plane = plane_net(net, question.line);
        const auto x = rows_of(plane, &PlanePoint::x), y = rows_of(plane, &PlanePoint::y);
        std::vector<std::pair<double, double>> roots;
        for (const double u : unit_roots(resultant(x, y), question.counts.steps)) {
            PowerPolynomial one = at_u(x, u), other = at_u(y, u);
            for (const double v : unit_roots(one, question.counts.steps)) {
                if (relative_value(other, v) > kCommon) continue;
                const auto within = [](double t) { return t >= -1e-12 && t <= 1.0 + 1e-12; };
                if (!within(u) || !within(v)) continue;
                if (is_new_root(roots, u, v, kSameCommonRoot)) {
                    question.report(net, patch, u, v);
                }
            }
        }
    }
};

}  // namespace

std::unique_ptr<PatchMethod> make_kajiya(std::span<const BezierNet> nets) {
    return std::make_unique<Kajiya>(nets);
}

}  // namespace alhazen
