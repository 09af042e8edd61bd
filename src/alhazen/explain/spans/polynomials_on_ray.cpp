#include "alhazen/explain/spans/polynomials_on_ray.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <tuple>

#include "alhazen/math/constants.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/shapes_on_ray.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/shapes/algebraic/polynomial_expression.h"

namespace alhazen {

namespace {

/// An equation in a local frame.
struct LocalEquation {
    std::string text;
    SolidFrame frame;
};

/// Builds the text of a sum of terms, without those whose coefficients are 0.
class ExpressionText {
  public:
    void add(double coefficient, const char* term) {
        if (coefficient == 0.0) return;
        const char* sign = coefficient < 0.0 ? "-" : text_.empty() ? "" : "+";
        const double size = std::abs(coefficient);
        text_ += text_.empty() ? sign : fmt::format(" {} ", sign);
        if (*term == '\0') {
            text_ += fmt::format("{:.17g}", size);
        } else {
            text_ += size == 1.0 ? term : fmt::format("{:.17g}*{}", size, term);
        }
    }
    [[nodiscard]] std::string take() { return text_.empty() ? "0" : std::move(text_); }

  private:
    std::string text_;
};

std::string text_of(const QuadricForm& f) {
    ExpressionText text;
    text.add(f.xx, "x^2");
    text.add(f.yy, "y^2");
    text.add(f.zz, "z^2");
    text.add(2.0 * f.xy, "x*y");
    text.add(2.0 * f.yz, "y*z");
    text.add(2.0 * f.zx, "z*x");
    text.add(2.0 * f.x, "x");
    text.add(2.0 * f.y, "y");
    text.add(2.0 * f.z, "z");
    text.add(f.c, "");
    return text.take();
}

/// Excludes the truncated general cone, whose quadric covers only one of its cases.
template <class Shape>
concept QuadricShape = !std::same_as<Shape, Tgc> && requires(const Shape& shape) {
    shape.solid.quadric.form();
};
template <class Shape>
concept AlgebraicShape = QuadricShape<Shape> || std::same_as<Shape, Sphere> ||
    std::same_as<Shape, Torus> || std::same_as<Shape, Algebraic>;

template <QuadricShape Shape>
LocalEquation equation_of(const Shape& shape) {
    return {text_of(shape.solid.quadric.form()), shape.solid.frame};
}
LocalEquation equation_of(const Sphere& sphere) {
    const double r = sphere.radius;
    return {"x^2 + y^2 + z^2 - 1",
            SolidFrame(sphere.center, Mat3{{r, 0, 0}, {0, r, 0}, {0, 0, r}})};
}
LocalEquation equation_of(const Torus& torus) {
    const double k = (1.0 - torus.tube) * (1.0 + torus.tube);
    return {fmt::format("(x^2 + y^2 + z^2 + {:.17g})^2 - 4*(x^2 + y^2)", k), torus.frame};
}
LocalEquation equation_of(const Algebraic& surface) {
    return {surface.expression, SolidFrame()};
}

double value_at(const PolynomialOnRay& p, double t) {
    std::vector<double> b = p.bernstein;
    const double u = (t - p.from) / (p.to - p.from);
    for (std::size_t n = b.size() - 1; n > 0; --n) {
        for (std::size_t i = 0; i < n; ++i) b[i] = (1.0 - u) * b[i] + u * b[i + 1];
    }
    return b[0];
}

/// Where the polynomial changes its sign from sample to sample of its range.
std::vector<double> sign_changes(const PolynomialOnRay& p) {
    constexpr int kSamples = 512;
    double size = 0.0;
    for (const double b : p.bernstein) size = std::max(size, std::abs(b));
    std::vector<double> found;
    double last = 0.0, last_t = p.from;
    for (int k = 0; k <= kSamples; ++k) {
        const double t = p.from + (p.to - p.from) * k / kSamples, value = value_at(p, t);
        if (!(std::abs(value) > 1e-12 * size)) continue;  // its sign is not certain
        if (last != 0.0 && (value > 0.0) != (last > 0.0)) {
            double lo = last_t, hi = t;
            for (int n = 0; n < 60; ++n) {
                const double middle = 0.5 * (lo + hi);
                ((value_at(p, middle) > 0.0) == (last > 0.0) ? lo : hi) = middle;
            }
            found.push_back(lo);
        }
        last = value;
        last_t = t;
    }
    return found;
}

class PolynomialFinder {
  public:
    PolynomialFinder(const LoadedScene& loaded, std::vector<PolynomialOnRay>& found)
        : loaded_(loaded), found_(found) {}

    template <AlgebraicShape Shape>
    void operator()(const Shape& shape, const Ray& ray, std::uint32_t part) {
        if (!meets_ahead(shape.box(), ray)) return;
        const LocalEquation equation = equation_of(shape);
        PolynomialOnRay p;
        p.shape = Shape::kName;
        p.part = part_name(loaded_.description, part);
        p.expression = equation.text;
        set_roots(shape, ray, p);
        if (set_coefficients(equation, range_in(shape.box(), ray), ray, p)) {
            found_.push_back(std::move(p));
        }
    }

  private:
    /// Sets the crossings of the surface itself (part 0).
    template <class Shape>
    static void set_roots(const Shape& shape, const Ray& ray, PolynomialOnRay& p) {
        ShapeHit hits[Shape::kMaxHits];
        Ray line = ray;
        line.t_min = 0.0;
        line.t_max = kInfinity;
        const int count = shape.intersect(line, hits);
        for (int i = 0; i < count; ++i) {
            if (hits[i].part == 0) p.roots.push_back(hits[i].t);
        }
    }

    /// False if the polynomial is constant or the range not finite.
    static bool set_coefficients(const LocalEquation& equation, Interval range, const Ray& ray,
                                 PolynomialOnRay& p) {
        constexpr double kMarginOfRange =
            0.15;  // margin, so that roots are visible from both sides
        if (!std::isfinite(range.lo)) range.lo = p.roots.empty() ? 0.0 : p.roots.front() - 1.0;
        if (!std::isfinite(range.hi)) range.hi = p.roots.empty() ? 10.0 : p.roots.back() + 1.0;
        const double margin = kMarginOfRange * (range.hi - range.lo);
        p.from = std::max(range.lo - margin, 0.0);
        p.to = range.hi + margin;
        const PolynomialExpression polynomial(equation.text);
        p.degree = polynomial.degree();
        if (p.degree < 1 || !(p.from < p.to)) return false;
        const auto at = [&](double t) {
            const Vec3 local = equation.frame.to_local(ray.at(t));
            return Point3<double>{local.x, local.y, local.z};
        };
        p.bernstein.resize(static_cast<std::size_t>(p.degree) + 1);
        const auto restrict_to_range = [&] {
            polynomial.restricted(at(p.from), at(p.to), p.bernstein.data());
        };
        restrict_to_range();
        if (add_roots(range, p)) restrict_to_range();
        return true;
    }

    /// Adds the sign changes within `bounds` that are not among the roots, and ends the range
    /// before those beyond. True if the range has changed.
    static bool add_roots(const Interval& bounds, PolynomialOnRay& p) {
        const double near = 1e-4 * (p.to - p.from), from = p.from, to = p.to;
        for (const double t : sign_changes(p)) {
            const auto is_it = [&](double root) { return std::abs(root - t) < near; };
            if (std::any_of(p.roots.begin(), p.roots.end(), is_it)) continue;
            if (t < bounds.lo) {
                p.from = std::max(p.from, 0.5 * (t + bounds.lo));
            } else if (t > bounds.hi) {
                p.to = std::min(p.to, 0.5 * (t + bounds.hi));
            } else {
                p.roots.push_back(t);
            }
        }
        std::sort(p.roots.begin(), p.roots.end());
        return p.from != from || p.to != to;
    }

    const LoadedScene& loaded_;
    std::vector<PolynomialOnRay>& found_;
};

}  // namespace

std::vector<PolynomialOnRay> polynomials_on_ray(const LoadedScene& loaded, const Ray& ray) {
    constexpr std::size_t kMost = 24;
    std::vector<PolynomialOnRay> found;
    visit_shapes_on_ray(loaded.scene.aggregate->primitives(), ray, PolynomialFinder(loaded, found));
    const auto place = [](const PolynomialOnRay& p) {
        return p.roots.empty() ? kInfinity : p.roots.front();
    };
    std::stable_sort(found.begin(), found.end(),
                     [&](const auto& a, const auto& b) { return place(a) < place(b); });
    if (found.size() > kMost) found.resize(kMost);
    return found;
}

}  // namespace alhazen
