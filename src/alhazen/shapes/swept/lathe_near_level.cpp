#include "alhazen/shapes/swept/lathe_near_level.h"

#include <algorithm>

#include "alhazen/math/bernstein_roots.h"

namespace alhazen {

namespace {

/// Control points of a coordinate of a curve.
using Controls = BernsteinPolynomial<DoubleDouble, 3>;

/// Error bound of parameters on a curve.
constexpr double kPlace = 0x1p-50;

/// The polar form of a curve at the first `degree` of three parameters.
DoubleDouble blossom(const Controls& curve, const std::array<double, 3>& at) {
    std::array<DoubleDouble, 4> row = curve.b;
    for (int step = 0; step < curve.degree; ++step) {
        const DoubleDouble u(at[step]), rest = two_sum(1.0, -at[step]);
        for (int i = 0; i + step < curve.degree; ++i) {
            row[i] = rest * row[i] + u * row[i + 1];
        }
    }
    return row[0];
}

DoubleDouble value_at(const Controls& curve, double u) {
    return blossom(curve, {u, u, u});
}

Controls piece_of(const Controls& curve, double from, double to) {
    Controls piece;
    piece.degree = curve.degree;
    for (int i = 0; i <= curve.degree; ++i) {
        std::array<double, 3> at{from, from, from};
        for (int k = 0; k < i; ++k) at[curve.degree - 1 - k] = to;
        piece.b[i] = blossom(curve, at);
    }
    return piece;
}

double largest_of(const Controls& curve) {
    double largest = 0.0;
    for (int i = 0; i <= curve.degree; ++i) largest = std::fmax(largest, std::abs(curve.b[i].high));
    return largest;
}

/// Adds the parameters at which the curve has this value.
void add_places(Controls curve, double value, std::array<double, 8>& places, std::size_t& count) {
    for (int i = 0; i <= curve.degree; ++i) curve.b[i] -= value;
    curve.error = 4.0 * kDoubleDoubleUlp * largest_of(curve);
    SignChanges<3> changes;
    find_sign_changes(curve, changes);
    for (int k = 0; k < changes.count; ++k) places[count++] = changes.u[k];
}

/// Calls f(from, to) for pieces of [0, 1] that contain all parameters where |curve| <= most.
template <class F>
void for_each_piece_within(const Controls& curve, double most, F f) {
    std::array<double, 8> places{0.0};
    std::size_t count = 1;
    add_places(curve, -most, places, count);
    add_places(curve, most, places, count);
    places[count++] = 1.0;
    // Insertion sort: GCC 12 falsely warns that std::sort reads past the end.
    for (std::size_t i = 1; i < count; ++i) {
        for (std::size_t k = i; k > 0 && places[k] < places[k - 1]; --k) {
            std::swap(places[k], places[k - 1]);
        }
    }
    double from = 0.0, to = -1.0;
    const auto add = [&](double lo, double hi) {
        lo = std::fmax(0.0, lo - kPlace);
        if (to >= 0.0 && lo > to) {
            f(from, to);
            to = -1.0;
        }
        if (to < 0.0) from = lo;
        to = std::fmin(1.0, hi + kPlace);
    };
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const double lo = places[i], hi = places[i + 1];
        // The ends of a short piece may be equal.
        if (i > 0) add(lo, lo);
        if (std::abs(value_at(curve, 0.5 * lo + 0.5 * hi).high) <= most) add(lo, hi);
        if (i + 2 < count) add(hi, hi);
    }
    if (to >= 0.0) f(from, to);
}

/// A ray parameterised from its point nearest to the axis.
class NearLevelRay {
  public:
    NearLevelRay(const Lathe& lathe, const Ray& ray) : lathe_(lathe) {
        const DoubleDouble ox(ray.origin.x), oy(ray.origin.y), dx(ray.direction.x),
            dy(ray.direction.y);
        height_ = ray.origin.z;
        climb_ = ray.direction.z;
        squared_ = dx * dx + dy * dy;
        nearest_ = quotient(-(ox * dx + oy * dy), squared_);
        const DoubleDouble turn = ox * dy - oy * dx;
        close_ = quotient(turn * turn, squared_);
        reach_ = 2.0 * lathe.reach / std::sqrt(squared_.high);
        const double far = max_component(abs(ray.origin));
        error_ = 0x1p-94 * lathe.reach * (lathe.reach + far);
    }

    void cross(std::uint32_t number, ShapeHits& found) const {
        if (close_.high > lathe_.reach * lathe_.reach) return;
        const ProfileCurve& curve = lathe_.profile.curves[number];
        Controls way, radius;
        way.degree = radius.degree = curve.degree();
        for (int i = 0; i <= curve.degree(); ++i) {
            way.b[i] = way_to(curve.control(i).y);
            radius.b[i] = curve.control(i).x;
        }
        for_each_piece_within(way, reach_, [&](double from, double to) {
            const bool beyond_from = from > 0.0 || is_beyond(curve.p[0]);
            const bool beyond_to = to < 1.0 || is_beyond(curve.p[3]);
            const Controls way_there = piece_of(way, from, to);
            const Controls radius_there = piece_of(radius, from, to);
            BernsteinPolynomial<DoubleDouble, 6> p = make_polynomial(way_there, radius_there);
            set_sign(p.b.front(), p.error, beyond_from);
            set_sign(p.b[p.degree], p.error, beyond_to);
            SignChanges<6> changes;
            find_sign_changes(p, changes);
            for (int k = 0; k < changes.count; ++k) {
                const double u = changes.u[k];
                const double t = t_at(way_there, radius_there, u);
                found.push_back({t, from + u * (to - from), 0, number});
            }
        });
    }

  private:
    /// Change of t from the point nearest to the axis to this height.
    [[nodiscard]] DoubleDouble way_to(double height) const {
        return quotient(two_sum(height, -height_), climb_) - nearest_;
    }

    /// True if the ray passes the height of a point at a greater distance from the axis than the
    /// point, or if uncertain.
    [[nodiscard]] bool is_beyond(Vec2 p) const {
        const DoubleDouble way = way_to(p.y), r(p.x);
        if (std::abs(way.high) > reach_) return true;
        return !((squared_ * way * way + close_ - r * r).high < -error_);
    }

    /// Positive where the ray passes the height of a point of the curve farther from the axis.
    [[nodiscard]] BernsteinPolynomial<DoubleDouble, 6> make_polynomial(
        const Controls& way, const Controls& radius) const {
        // The product of Bernstein polynomials: C(n, i) C(n, j) / C(2 n, i + j).
        const auto& binomials = bernstein::kBinomials<6>;
        const int n = way.degree;
        BernsteinPolynomial<DoubleDouble, 6> p;
        p.degree = 2 * n;
        p.shared_ends = true;
        for (int k = 0; k <= 2 * n; ++k) {
            DoubleDouble sum;
            for (int i = std::max(0, k - n); i <= std::min(k, n); ++i) {
                const DoubleDouble weight(binomials[n][i] * binomials[n][k - i]);
                sum +=
                    weight * (squared_ * way.b[i] * way.b[k - i] - radius.b[i] * radius.b[k - i]);
            }
            p.b[k] = close_ + quotient(sum, DoubleDouble(binomials[2 * n][k]));
        }
        const double w = largest_of(way), r = lathe_.reach;
        p.error = 64.0 * kDoubleDoubleUlp * (squared_.high * w * w + r * r) + error_;
        return p;
    }

    static void set_sign(DoubleDouble& b, double error, bool positive) {
        if (positive ? b.high > error : b.high < -error) return;
        b = positive ? 2.0 * error : -2.0 * error;
    }

    /// t of the crossing at the parameter u: from the height or from the radius there, whichever is
    /// better conditioned.
    [[nodiscard]] double t_at(const Controls& way, const Controls& radius, double u) const {
        DoubleDouble w, r;
        double w_slope, r_slope;
        bernstein::evaluate(way, u, w, w_slope);
        bernstein::evaluate(radius, u, r, r_slope);
        const DoubleDouble chord = r * r - close_;
        if (chord.high > 0.0 &&
            squared_.high * std::abs(w.high * w_slope) > std::abs(r.high * r_slope)) {
            const DoubleDouble half = square_root(quotient(chord, squared_));
            w = w.high < 0.0 ? -half : half;
        }
        return (nearest_ + w).high;
    }

    const Lathe& lathe_;
    double height_, climb_;
    DoubleDouble nearest_;  ///< t
    DoubleDouble squared_;  ///< squared length of the direction across the axis
    DoubleDouble close_;    ///< squared least distance from the axis
    double reach_;          ///< change of t to twice the reach of the profile
    double error_;          ///< error bound of the signs at points of the profile
};

}  // namespace

void near_level_crossings(const Lathe& lathe, const Ray& ray, ShapeHits& found) {
    const NearLevelRay near(lathe, ray);
    for (std::uint32_t i = 0; i < lathe.profile.curves.size(); ++i) near.cross(i, found);
}

}  // namespace alhazen
