#include "alhazen/shapes/superellipsoid.h"

#include <array>
#include <utility>

#include "alhazen/shapes/ellipsoid.h"

namespace alhazen {

namespace {

/// Beyond this the line is outside for sure.
constexpr double kRoom = 1.0 + 1.0 / 64;
/// Rounding of the sum of powers, relative: powers are right to an ulp, but their bases' own
/// rounding grows with the exponent.
constexpr double kSlack = 0x1p-48;

/// The function at one point of the line, term by term.
struct Sample {
    double t = 0;
    std::array<double, 3> at{};     ///< |x|, |y|, |z|
    std::array<double, 3> power{};  ///< |x|^p, |y|^p, |z|^q
    bool inside = false;            ///< as it is computed
    bool certain = false;           ///< not within the rounding of the surface
};

class CrossingSearch {
  public:
    CrossingSearch(const Superellipsoid& s, const Vec3& o, const Vec3& d)
        : p_(s.p), q_(s.q), o_(o), d_(d) {}

    /// Appends where the line goes in and out between two samples on one side of all planes
    /// through the axes.
    void search(const Sample& a, const Sample& b, int depth) {
        Interval value;
        const bool one_way = monotone(a, b, value);
        if (value.lo > 1.0 + slack() || value.hi < 1.0 - slack()) return;
        if (one_way || depth == 0) {
            if (a.inside != b.inside) put(bisected(a, b));
            return;
        }
        Sample middle = sample(0.5 * a.t + 0.5 * b.t);
        // Noise along a line that grazes must not look like crossings.
        if (!middle.certain && a.inside == b.inside) middle.inside = a.inside;
        search(a, middle, depth - 1);
        search(middle, b, depth - 1);
    }

    [[nodiscard]] Sample sample(double t) const {
        Sample s;
        s.t = t;
        for (std::size_t k = 0; k < 3; ++k) {
            const int axis = static_cast<int>(k);
            s.at[k] = std::abs(o_[axis] + t * d_[axis]);
            s.power[k] = std::pow(s.at[k], k < 2 ? p_ : q_);
        }
        const double value = sum(s.power[0] + s.power[1], s.power[2]);
        s.inside = value < 1.0;
        s.certain = std::abs(value - 1.0) > slack();
        return s;
    }

    [[nodiscard]] const double* crossings() const { return t_.data(); }
    [[nodiscard]] int count() const { return count_; }

  private:
    [[nodiscard]] double slack() const { return kSlack * (p_ + q_); }
    [[nodiscard]] double sum(double across, double along) const {
        return std::pow(across, q_ / p_) + along;
    }

    /// The range of the function between a and b; true when it only rises or only falls.
    bool monotone(const Sample& a, const Sample& b, Interval& value) const {
        std::array<double, 3> lo, hi;
        bool rises = false, falls = false;
        for (std::size_t k = 0; k < 3; ++k) {
            lo[k] = std::fmin(a.power[k], b.power[k]);
            hi[k] = std::fmax(a.power[k], b.power[k]);
            rises = rises || a.at[k] < b.at[k];
            falls = falls || a.at[k] > b.at[k];
        }
        const double s_lo = lo[0] + lo[1], s_hi = hi[0] + hi[1];
        const double r = q_ / p_;
        const double h_lo = std::pow(s_lo, r), h_hi = std::pow(s_hi, r);
        value = {h_lo + lo[2], h_hi + hi[2]};
        if (!rises || !falls) return true;
        // Slope / q = s^(r - 1) (x^(p - 1) x' + y^(p - 1) y') + z^(q - 1) z', each factor monotone.
        const auto over = [](double power, double base) { return power / base; };
        Interval slope{0.0, 0.0};
        for (std::size_t k = 0; k < 3; ++k) {
            const double change = b.at[k] - a.at[k];
            if (change == 0.0) continue;
            double g0 = over(a.power[k], a.at[k]), g1 = over(b.power[k], b.at[k]);
            if (g0 > g1) std::swap(g0, g1);
            if (k < 2) {
                const double f0 = over(h_lo, s_lo), f1 = over(h_hi, s_hi);
                g0 *= std::fmin(f0, f1);
                g1 *= std::fmax(f0, f1);
            }
            slope.lo += change * (change > 0.0 ? g0 : g1);
            slope.hi += change * (change > 0.0 ? g1 : g0);
        }
        const double scale = std::abs(slope.lo) + std::abs(slope.hi);
        return slope.lo > kSlack * scale || slope.hi < -kSlack * scale;
    }

    /// The t between a and b, of which one is inside, where the function is 1.
    [[nodiscard]] double bisected(Sample a, Sample b) const {
        for (int i = 0; i < 80; ++i) {
            const double t = 0.5 * a.t + 0.5 * b.t;
            if (!(t > a.t && t < b.t)) break;
            const Sample middle = sample(t);
            (middle.inside == a.inside ? a : b) = middle;
        }
        return b.t;
    }

    void put(double t) {
        if (count_ < Superellipsoid::kMaxHits) t_[static_cast<std::size_t>(count_)] = t;
        ++count_;
    }

    double p_, q_;
    Vec3 o_, d_;
    std::array<double, Superellipsoid::kMaxHits> t_{};
    int count_ = 0;
};

}  // namespace

void Superellipsoid::prepare() {
    frame = SolidFrame(center, Mat3{axis_a, axis_b, axis_c});
    p = 2.0 / east;
    q = 2.0 / north;
}

void Superellipsoid::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.point("center", center);
    check_axes(checks, {axis_a, axis_b, axis_c}, "axis_a", "axis_b", "axis_c");
    if (!(east >= 0.01 && east <= 100.0)) checks.fail("east must be a number from 0.01 to 100");
    if (!(north >= 0.01 && north <= 100.0)) checks.fail("north must be a number from 0.01 to 100");
}

Interval Superellipsoid::extent(const Vec3& axis) const {
    // Of the parallelepiped of the semi-axes.
    const double half =
        std::abs(dot(axis, axis_a)) + std::abs(dot(axis, axis_b)) + std::abs(dot(axis, axis_c));
    const double slack = gamma_bound(4) * dot(abs(axis), abs(axis_a) + abs(axis_b) + abs(axis_c));
    return outward_extent(axis, center, half + slack);
}

Box3 Superellipsoid::box() const {
    return outward_box(center, abs(axis_a) + abs(axis_b) + abs(axis_c));
}

int Superellipsoid::intersect(const Ray& ray, ShapeHit* hits) const {
    Vec3 o = frame.to_local(ray.origin);
    const Vec3 d = frame.local_from_object * ray.direction;
    ClipRange range;
    if (!cut_by_box(o, d, {{-kRoom, -kRoom, -kRoom}, {kRoom, kRoom, kRoom}}, range)) return 0;
    if (!(range.exit >= ray.t_min && range.entry <= ray.t_max)) return 0;
    // From where the line enters: from afar its digits would be lost.
    const double shift = range.entry;
    o = frame.to_local(advanced(ray, shift).origin);
    std::array<double, 5> cuts{0.0};
    std::size_t count = 1;
    for (int k = 0; k < 3; ++k) {
        const double t = -o[k] / d[k];
        if (!(t > 0.0 && t < range.exit - shift)) continue;
        std::size_t place = count++;
        for (; place > 1 && cuts[place - 1] > t; --place) cuts[place] = cuts[place - 1];
        cuts[place] = t;
    }
    cuts[count++] = range.exit - shift;
    CrossingSearch search(*this, o, d);
    Sample before = search.sample(cuts[0]);
    for (std::size_t i = 1; i < count; ++i) {
        Sample after = search.sample(cuts[i]);
        if (!after.certain) after.inside = before.inside && i + 1 < count;
        search.search(before, after, 40);
        before = after;
    }
    if (search.count() > kMaxHits || search.count() % 2 != 0) return 0;
    int written = 0;
    for (int i = 0; i < search.count(); ++i) {
        written += report_crossing(ray, {shift + search.crossings()[i], 0, 0, 0}, hits + written);
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
    // The function is homogeneous of degree q: along the way to the centre it is known.
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
    // Powers and roots add a few roundings for every unit of the exponents' ratio.
    surface.error = frame.object_error(at, 16);
    return surface;
}

}  // namespace alhazen
