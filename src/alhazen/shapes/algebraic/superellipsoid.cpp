#include "alhazen/shapes/algebraic/superellipsoid.h"

#include <array>
#include <utility>

#include "alhazen/math/double_double_power.h"
#include "alhazen/shapes/algebraic/polynomial_solid.h"
#include "alhazen/shapes/quadrics/ellipsoid.h"

namespace alhazen {

namespace {

/// Scale of the clip, beyond which the line is certainly outside.
constexpr double kBoxMargin = 1.0 + 1.0 / 64;
/// Roundings of a sum of powers per unit of the exponents, in half ulps.
constexpr double kRoundings = 32.0;
/// The error of a sum of powers in double-double, relative.
constexpr double kPreciseSlack = 0x1p-92;
/// A root found in double is accurate to about the rounding of t if the slope is at least this
/// fraction of its terms.
constexpr double kSteepEnough = 1.0 / 8;
/// Largest number of halvings of a part of the line.
constexpr int kMostHalvings = 48;
/// Largest number of samples of one line.
constexpr int kMostSamples = 2000;

/// The function at one point of the line, with its terms.
struct Sample {
    double t = 0;
    std::array<double, 3> at{};     ///< |x|, |y|, |z|
    std::array<double, 3> power{};  ///< |x|^p, |y|^p, |z|^q
    double error = 0;               ///< error bound of the sum of the terms
    double value = 0;               ///< the sum minus 1, in double-double where double is uncertain
    double value_error = 0;         ///< error bound of `value`
    bool inside = false;            ///< as computed: in double-double where double is uncertain
    bool certain = false;           ///< farther from the surface than the rounding
};

/// The line of a ray in the frame of the solid.
struct LocalLine {
    const Superellipsoid& solid;
    const Ray& ray;
    const ClipSegment& segment;

    /// The function minus 1 on the exact line, t from the shifted origin.
    [[nodiscard]] DoubleDouble precise(double t) const {
        const Point3<DoubleDouble> o = solid.frame.local_point(to_real<DoubleDouble>(ray.origin));
        const Point3<DoubleDouble> d =
            solid.frame.local_vector(to_real<DoubleDouble>(ray.direction));
        const DoubleDouble at = two_sum(segment.shift, t);
        const DoubleDouble p(solid.p), q(solid.q);
        const auto term = [&](const DoubleDouble& from, const DoubleDouble& step,
                              const DoubleDouble& exponent) {
            const DoubleDouble x = from + at * step;
            return power(x.high < 0.0 ? -x : x, exponent);
        };
        const DoubleDouble across = term(o.x, d.x, p) + term(o.y, d.y, p);
        return power(across, quotient(q, p)) + term(o.z, d.z, q) - DoubleDouble(1.0);
    }
};

class CrossingSearch {
  public:
    explicit CrossingSearch(const LocalLine& line)
        : line_(line),
          p_(line.solid.p),
          q_(line.solid.q),
          o_(line.segment.o),
          coordinate_error_(0x1p-53 * line.segment.relative_error) {
        // Each component is accurate to its last digit: along a face two of them may be nearly
        // zero.
        const Point3<DoubleDouble> d =
            line.solid.frame.local_vector(to_real<DoubleDouble>(line.ray.direction));
        d_ = {d.x.high, d.y.high, d.z.high};
    }

    /// Appends the crossings between two samples on the same side of all planes through the axes.
    void search_part(const Sample& a, const Sample& b) {
        const double middle = 0.5 * a.t + 0.5 * b.t;
        for (int k = 0; k < 3; ++k) {
            const double x = o_[k] + middle * d_[k];
            rate_[static_cast<std::size_t>(k)] = x < 0.0 ? -d_[k] : d_[k];
        }
        search(a, b, kMostHalvings);
    }

    [[nodiscard]] Sample sample(double t) const {
        Sample s = sample_in_double(t);
        if (s.certain) return s;
        s.value = line_.precise(t).high;
        s.value_error = kPreciseSlack * (p_ + q_);
        s.inside = s.value < 0.0;
        s.certain = std::abs(s.value) > s.value_error;
        return s;
    }

    [[nodiscard]] const double* crossings() const { return t_.data(); }
    [[nodiscard]] int count() const { return count_; }

  private:
    [[nodiscard]] Sample sample_in_double(double t) const {
        Sample s;
        s.t = t;
        bool steep = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const int axis = static_cast<int>(k);
            const double exponent = k < 2 ? p_ : q_;
            s.at[k] = std::abs(o_[axis] + t * d_[axis]);
            s.power[k] = std::pow(s.at[k], exponent);
            // The derivative of a root is unbounded where its argument is nearly zero.
            steep = steep || (exponent < 1.0 && s.at[k] < 0x1p-20);
        }
        const double across = s.power[0] + s.power[1];
        const double bent = std::pow(across, q_ / p_);
        const double value = bent + s.power[2];
        double slopes = across > 0.0 ? bent / across * (slope(s, 0) + slope(s, 1)) : 0.0;
        slopes = q_ * (slopes + slope(s, 2));
        s.error = 2.0 * coordinate_error_ * slopes + 0x1p-53 * kRoundings * (p_ + q_) * value;
        s.value = value - 1.0;
        s.value_error = s.error;
        s.inside = value < 1.0;
        s.certain = std::abs(s.value) > s.error && !steep;
        return s;
    }
    /// The derivative of a power, divided by its exponent.
    static double slope(const Sample& s, std::size_t k) {
        return s.at[k] > 0.0 ? s.power[k] / s.at[k] : 0.0;
    }

    struct Slope {
        Interval range{0.0, 0.0};  ///< range of the derivative of the function by t, over q
        double terms = 0;          ///< bound of the sum of the magnitudes of its terms
        double noise = 0;          ///< error bound of the derivative

        [[nodiscard]] bool has_sign() const { return range.lo > noise || range.hi < -noise; }
        [[nodiscard]] double most() const {
            return std::fmax(std::abs(range.lo), std::abs(range.hi)) + noise;
        }
        [[nodiscard]] bool is_steep() const {
            return has_sign() &&
                   std::fmin(std::abs(range.lo), std::abs(range.hi)) >= kSteepEnough * terms;
        }
    };

    void search(const Sample& a, const Sample& b, int depth) {
        Interval value;
        const Slope slope = slope_between(a, b, value);
        const double error = a.error + b.error;
        if (value.lo > 1.0 + error || value.hi < 1.0 - error) return;
        if (slope.has_sign() || depth == 0 || samples_ >= kMostSamples ||
            (!a.certain && !b.certain)) {
            if (a.inside != b.inside) put(root(a, b, slope.is_steep()));
            return;
        }
        // An end is too far from the surface for the line to reach it and return.
        const double way = q_ * slope.most() * (b.t - a.t);
        if (a.inside == b.inside && std::abs(a.value) - a.value_error > way) return;
        if (a.inside == b.inside && std::abs(b.value) - b.value_error > way) return;
        ++samples_;
        Sample middle = sample(0.5 * a.t + 0.5 * b.t);
        // Noise on a grazing line must not produce crossings.
        if (!middle.certain && a.inside == b.inside) middle.inside = a.inside;
        search(a, middle, depth - 1);
        search(middle, b, depth - 1);
    }

    /// Slope / q = s^(r - 1) (x^(p - 1) x' + y^(p - 1) y') + z^(q - 1) z', each factor monotone
    /// between a and b, as are the terms of the function: `value` is its range. Where p is 1, s is
    /// linear and has its extremes at a and b; along a flat side it does not change.
    /// Where q is 1, s^(r - 1) x^(p - 1) = (x^p / s)^(1 - 1 / p), and x / y is monotone.
    Slope slope_between(const Sample& a, const Sample& b, Interval& value) const {
        std::array<double, 3> lo, hi;
        for (std::size_t k = 0; k < 3; ++k) {
            lo[k] = std::fmin(a.power[k], b.power[k]);
            hi[k] = std::fmax(a.power[k], b.power[k]);
        }
        const double r = q_ / p_;
        double s_lo = lo[0] + lo[1], s_hi = hi[0] + hi[1];
        const bool linear = p_ == 1.0;
        if (linear) {
            const double s_a = a.power[0] + a.power[1], s_b = b.power[0] + b.power[1];
            s_lo = std::fmin(s_a, s_b);
            s_hi = std::fmax(s_a, s_b);
        }
        const double h_lo = std::pow(s_lo, r), h_hi = std::pow(s_hi, r);
        value = {h_lo + lo[2], h_hi + hi[2]};
        const Interval outer = ordered(h_lo / s_lo, h_hi / s_hi);
        Slope slope;
        const auto add = [&](double rate, double size, const Interval& g) {
            if (size == 0.0) return;
            slope.range.lo += rate * (rate > 0.0 ? g.lo : g.hi);
            slope.range.hi += rate * (rate > 0.0 ? g.hi : g.lo);
            slope.terms += size * g.hi;
        };
        if (linear) add(rate_[0] + rate_[1], std::abs(rate_[0]) + std::abs(rate_[1]), outer);
        for (std::size_t k = linear ? 2 : 0; k < 3; ++k) {
            Interval g;
            if (k < 2 && q_ == 1.0) {
                const auto factor = [&](const Sample& end) {
                    return std::pow(end.power[k] / (end.power[0] + end.power[1]), 1.0 - 1.0 / p_);
                };
                g = ordered(factor(a), factor(b));
            } else {
                g = ordered(a.power[k] / a.at[k], b.power[k] / b.at[k]);
                if (k < 2) g = ordered(g.lo * outer.lo, g.hi * outer.hi);
            }
            add(rate_[k], std::abs(rate_[k]), g);
        }
        slope.noise = 0x1p-53 * kRoundings * (p_ + q_) * slope.terms;
        return slope;
    }

    /// An interval from a to b; any positive value for an end that is NaN (on a plane of symmetry).
    static Interval ordered(double a, double b) {
        if (a <= b) return {a, b};
        if (b <= a) return {b, a};
        return {0.0, kInfinity};
    }

    /// The t between a and b, one of which is inside, where the function is 1.
    [[nodiscard]] double root(const Sample& a, const Sample& b, bool steep) const {
        const auto f = [&](double t, double& value, double& slope) {
            const Sample s = sample_in_double(t);
            const double across = s.power[0] + s.power[1];
            const double bent = std::pow(across, q_ / p_);
            value = steep ? (bent - 1.0) + s.power[2] : line_.precise(t).high;
            double both = 0.0;
            for (std::size_t k = 0; k < 2; ++k) both += rate_[k] * CrossingSearch::slope(s, k);
            slope = q_ * ((across > 0.0 ? bent / across * both : 0.0) +
                          rate_[2] * CrossingSearch::slope(s, 2));
        };
        return bernstein::bracketed_newton(f, a.t, b.t, a.inside ? -1.0 : 1.0,
                                           0.5 * a.t + 0.5 * b.t);
    }

    void put(double t) {
        if (count_ < Superellipsoid::kMaxHits) t_[static_cast<std::size_t>(count_)] = t;
        ++count_;
    }

    const LocalLine& line_;
    double p_, q_;
    Vec3 o_, d_;
    double coordinate_error_;       ///< error bound of x, y and z
    std::array<double, 3> rate_{};  ///< derivatives of |x|, |y|, |z| in the searched part
    std::array<double, Superellipsoid::kMaxHits> t_{};
    int count_ = 0;
    int samples_ = 0;
};

}  // namespace

void Superellipsoid::prepare() {
    frame = SolidFrame(center, Mat3{axis_a, axis_b, axis_c});
    p = 2.0 / east;
    q = 2.0 / north;
}

void Superellipsoid::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    check_axes(checks, {axis_a, axis_b, axis_c}, "axis_a", "axis_b", "axis_c");
    if (!(east >= 0.01 && east <= 100.0)) checks.fail("east must be a number from 0.01 to 100");
    if (!(north >= 0.01 && north <= 100.0)) checks.fail("north must be a number from 0.01 to 100");
}

Interval Superellipsoid::extent(const Vec3& axis) const {
    // The box of the parallelepiped spanned by the semi-axes.
    const double half =
        std::abs(dot(axis, axis_a)) + std::abs(dot(axis, axis_b)) + std::abs(dot(axis, axis_c));
    const double slack = gamma_bound(4) * dot(abs(axis), abs(axis_a) + abs(axis_b) + abs(axis_c));
    return outward_extent(axis, center, half + slack);
}

Box3 Superellipsoid::box() const {
    return outward_box(center, abs(axis_a) + abs(axis_b) + abs(axis_c));
}

int Superellipsoid::intersect(const Ray& ray, ShapeHit* hits) const {
    ClipSegment segment;
    const Box3 around{{-kBoxMargin, -kBoxMargin, -kBoxMargin},
                      {kBoxMargin, kBoxMargin, kBoxMargin}};
    if (!clip_segment(frame, ray, around, 1.0, segment)) return 0;
    const Vec3 &o = segment.o, &d = segment.d;
    const double entry = segment.range.entry - segment.shift;
    const double exit = segment.range.exit - segment.shift;
    std::array<double, 5> cuts{entry};
    std::size_t count = 1;
    for (int k = 0; k < 3; ++k) {
        const double t = -o[k] / d[k];
        if (!(t > entry && t < exit)) continue;
        std::size_t place = count++;
        for (; place > 1 && cuts[place - 1] > t; --place) cuts[place] = cuts[place - 1];
        cuts[place] = t;
    }
    cuts[count++] = exit;
    const LocalLine line{*this, ray, segment};
    CrossingSearch search(line);
    Sample before = search.sample(cuts[0]);
    for (std::size_t i = 1; i < count; ++i) {
        Sample after = search.sample(cuts[i]);
        if (!after.certain) after.inside = before.inside && i + 1 < count;
        search.search_part(before, after);
        before = after;
    }
    if (search.count() > kMaxHits || search.count() % 2 != 0) return 0;
    int written = 0;
    for (int i = 0; i < search.count(); ++i) {
        const double t = segment.shift + search.crossings()[i];
        written += report_crossing(ray, {t, 0, 0, 0}, hits + written);
    }
    return written;
}

ShapeSurface Superellipsoid::surface(const Ray& ray, const ShapeHit& hit) const {
    Vec3 at = frame.to_local(ray.at(hit.t));
    const double r = q / p;
    const auto powers = [&](const Vec3& v) {
        return Vec3{std::pow(std::abs(v.x), p), std::pow(std::abs(v.y), p),
                    std::pow(std::abs(v.z), q)};
    };
    // The function is homogeneous of degree q, hence known along the line to the centre.
    Vec3 w = powers(at);
    const double value = std::pow(w.x + w.y, r) + w.z;
    if (value > 0.0 && std::isfinite(value)) at = std::pow(value, -1.0 / q) * at;
    w = powers(at);
    const double across = w.x + w.y;
    const double factor = across > 0.0 ? std::pow(across, r) / across : 0.0;
    // Powers over bases; on a plane of symmetry the term is 0 or, for a star, an edge.
    const auto slope = [](double power, double base) {
        const double b = std::copysign(std::fmax(std::abs(base), 1e-9), base);
        return power / b;
    };
    const Vec3 gradient{factor * slope(w.x, at.x), factor * slope(w.y, at.y), slope(w.z, at.z)};

    ShapeSurface surface;
    surface.point = frame.to_object(at);
    surface.normal = surface.shading_normal =
        object_normal(frame, gradient, unit_or(at, {0, 0, 1}));
    LocalUv local = turn_uv(at);
    const double distance = std::hypot(at.x, at.y);
    local.uv.y = 0.5 + std::atan2(at.z, distance) / kPi;
    if (distance > 0.0) {
        local.v_gradient = Vec3{-at.z * at.x / distance, -at.z * at.y / distance, distance} /
                           (kPi * length_squared(at));
    }
    set_uv(frame, local, gradient, surface, 0.2);
    // Powers and roots add a few roundings per unit of the exponents' ratio.
    surface.error = frame.object_error(at, 16);
    return surface;
}

}  // namespace alhazen
