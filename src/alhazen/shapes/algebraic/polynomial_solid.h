#pragma once
/// The kernel of the shapes f(x, y, z) < 0 with a polynomial f: torus, truncated cone, algebraic
/// surface.
///
/// Source: Hanrahan, "Ray Tracing Algebraic Surfaces", SIGGRAPH 1983 (substitutes the line and
/// isolates the real roots of the resulting polynomial). Differs: the line is first cut to the
/// solid's clip. The restriction of f to that segment is computed directly in Bernstein form from
/// the coordinates of the segment's ends, as products (convolutions), which avoids cancellation.
/// Its sign changes are found by math/bernstein_roots.h, in double and, where that is uncertain,
/// again in double-double from the original ray. Where the slope of f is small, as near double
/// points, roots found in double are improved with its value in double-double. Conventions:
/// internal to this folder.
///
/// A polynomial offers kDegree (a bound for its degree) and
///   `template <class Real> int coefficients(Point3<Real> p0, Point3<Real> p1, Real* b) const`:
///       the degree and the Bernstein coefficients of f((1 - u) p0 + u p1);
///   `template <class Real> Real value(Point3<Real> p) const`, `Vec3 gradient(Vec3 p) const`;
///   `double magnitude() const`: a bound of the sum of the absolute terms of f over the clip;
/// `double roundings() const`: number of consecutive roundings in its coefficients.

#include "alhazen/math/bernstein_roots.h"
#include "alhazen/shapes/core/solid_frame.h"

namespace alhazen {

/// The line in the frame, cut to the solid's clip.
struct ClipSegment {
    Vec3 o, d;
    ClipRange range;
    double shift = 0;  ///< t of o on the ray
    /// Bound of the error of an end's coordinate over the size of the clip, in half ulps.
    double relative_error = 0;
};

/// Cuts the line in the frame by `cut(o, d, range)`; false if no part is left that the ray covers.
/// `size` is approximately that of the remaining part.
template <class Cut>
inline bool clip_segment_by(const SolidFrame& frame, const Ray& ray, double size, Cut&& cut,
                            ClipSegment& s) {
    Vec3 from = ray.origin - frame.origin;
    s.o = frame.local_from_object * from;
    s.d = frame.local_from_object * ray.direction;
    if (!cut(s.o, s.d, s.range)) return false;
    if (!(s.range.exit >= ray.t_min && s.range.entry <= ray.t_max)) return false;
    const double step = max_component(abs(ray.direction));
    if (std::abs(s.range.entry) * step * frame.stretch > 16.0 * size) {
        s.shift = s.range.entry;
        from = advanced(ray, s.shift).origin - frame.origin;
        s.o = frame.local_from_object * from;
    }
    const double far =
        std::fmax(std::abs(s.range.entry - s.shift), std::abs(s.range.exit - s.shift));
    s.relative_error = 6.0 * frame.stretch / size *
                       (max_component(abs(from)) + max_component(abs(frame.origin)) + far * step);
    return true;
}

/// Cuts the line by a box; `size` is the smallest of the largest coordinates of the box along its
/// axes.
inline bool clip_segment(const SolidFrame& frame, const Ray& ray, const Box3& box, double size,
                         ClipSegment& s) {
    return clip_segment_by(
        frame, ray, size,
        [&](const Vec3& o, const Vec3& d, ClipRange& range) {
            return cut_by_box(frame, o, d, box, range);
        },
        s);
}

/// Coefficients in either precision; the polynomial is that of the exact line.
template <class Polynomial, class Real, int N>
void restrict_to_segment(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                         const ClipSegment& s, BernsteinPolynomial<Real, N>& p) {
    constexpr double kUnit = std::is_same_v<Real, double> ? 0x1p-53 : kDoubleDoubleUlp;
    Point3<Real> o, d;
    Real entry(s.range.entry), exit(s.range.exit);
    if constexpr (std::is_same_v<Real, double>) {
        o = {s.o.x, s.o.y, s.o.z};
        d = {s.d.x, s.d.y, s.d.z};
        entry -= s.shift;
        exit -= s.shift;
    } else {
        o = frame.local_point(to_real<Real>(ray.origin));
        d = frame.local_vector(to_real<Real>(ray.direction));
    }
    const auto at = [&](const Real& t) {
        return Point3<Real>{o.x + t * d.x, o.y + t * d.y, o.z + t * d.z};
    };
    p.degree = f.coefficients(at(entry), at(exit), p.b.data());
    // A term of degree n changes by at most n times the relative change of its factors.
    p.error = kUnit * f.magnitude() * (f.roundings() + 1.5 * p.degree * s.relative_error);
}

/// Filters the sign changes that a ray covers: see AllSignChanges.
struct CoveredSignChanges {
    const Ray& ray;
    const ClipRange& range;

    [[nodiscard]] double at(double u) const {
        return std::fmin(range.exit, range.entry + u * (range.exit - range.entry));
    }
    // `at` ascends, rounding included.
    [[nodiscard]] bool wants(double lo, double hi) const {
        return at(hi) >= ray.t_min && at(lo) <= ray.t_max;
    }
    static void begin() {}
};

/// Filters the sign changes up to the first that certainly lies in the ray's range, wherever in its
/// interval it is, or behind that range.
class UpToFirstCovered {
  public:
    explicit UpToFirstCovered(const CoveredSignChanges& covered) : covered_(covered) {}

    /// Resets the filter for a new search.
    void begin() {
        asked_ = 0;
        found_ = false;
    }
    /// Called for the changes in ascending order.
    [[nodiscard]] bool wants(double lo, double hi) {
        if (found_) return false;
        ++asked_;
        found_ = covered_.at(lo) >= covered_.ray.t_min;
        return covered_.wants(lo, hi);
    }
    [[nodiscard]] bool found() const { return found_; }
    /// Number of changes up to and including the found one.
    [[nodiscard]] int asked() const { return asked_; }

  private:
    const CoveredSignChanges& covered_;
    int asked_ = 0;
    bool found_ = false;
};

/// A root found in double is accurate to about the rounding of t if the slope is at least this
/// fraction of the largest coefficient.
inline constexpr double kSteepEnough = 1.0 / 8;

/// Improves a root that was found in double. Where the slope is small relative to the coefficients
/// (near a double point of the surface, for example), their rounding displaces the root by more
/// than the rounding of t. Newton's steps use the value of f in double-double on the exact line.
template <class Polynomial, int N>
double improved_root(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                     const CoveredSignChanges& covered, const BernsteinPolynomial<double, N>& p,
                     const SignChanges<N>& changes, std::size_t i) {
    const double t = covered.at(changes.u[i]);
    if (!covered.wants(changes.lo[i], changes.hi[i])) return t;
    double largest = 0.0, value, slope;
    for (int k = 0; k <= p.degree; ++k) {
        largest = std::fmax(largest, std::abs(p.b[static_cast<std::size_t>(k)]));
    }
    bernstein::evaluate(p, changes.u[i], value, slope);
    if (std::abs(slope) >= kSteepEnough * largest) return t;
    const double lo = covered.at(changes.lo[i]), hi = covered.at(changes.hi[i]);
    if (!(lo < hi)) return t;
    const Point3<DoubleDouble> o = frame.local_point(to_real<DoubleDouble>(ray.origin));
    const Point3<DoubleDouble> d = frame.local_vector(to_real<DoubleDouble>(ray.direction));
    const double slope_t = slope / (covered.range.exit - covered.range.entry);
    double best = t, last_step = hi - lo;
    for (int step = 0; step < 4; ++step) {
        const DoubleDouble at(best);
        const double off =
            f.value(Point3<DoubleDouble>{o.x + at * d.x, o.y + at * d.y, o.z + at * d.z}).high /
            slope_t;
        const double next = best - off;
        // The slope is that at the initial root: stops when the steps do not shrink.
        if (!(next >= lo && next <= hi) || !(std::abs(off) <= 0.25 * last_step)) break;
        best = next;
        last_step = std::abs(off);
        if (last_step <= 0x1p-52 * std::abs(best)) break;
    }
    return best;
}

template <class Polynomial, int N, class Wanted>
[[gnu::noinline]] void find_precisely(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                                      const ClipSegment& s, SignChanges<N>& changes,
                                      Wanted& wanted) {
    wanted.begin();
    BernsteinPolynomial<DoubleDouble, N> precise;
    restrict_to_segment(f, frame, ray, s, precise);
    find_sign_changes(precise, changes, wanted);
}

/// Finds the sign changes on the segment that `wanted` selects. True: found in double; false: that
/// was uncertain, and they were found in double-double.
template <class Polynomial, int N, class Wanted>
bool find_on_segment(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                     const ClipSegment& s, const BernsteinPolynomial<double, N>& p,
                     SignChanges<N>& changes, Wanted& wanted) {
    if (find_sign_changes(p, changes, wanted)) return true;
    find_precisely(f, frame, ray, s, changes, wanted);
    return false;
}

/// The parameter of change i.
template <class Polynomial, int N>
double parameter_of(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                    const CoveredSignChanges& covered, const BernsteinPolynomial<double, N>& p,
                    const SignChanges<N>& changes, bool certain, int i) {
    const auto k = static_cast<std::size_t>(i);
    return certain ? improved_root(f, frame, ray, covered, p, changes, k)
                   : covered.at(changes.u[k]);
}

/// Crossings of a segment with a known range; see report_solid for `capped`.
template <class Polynomial>
int intersect_segment(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                      const ClipSegment& s, bool capped, ShapeHit* hits) {
    constexpr int N = Polynomial::kDegree;
    SignChanges<N> changes;
    CoveredSignChanges covered{ray, s.range};
    BernsteinPolynomial<double, N> p;
    restrict_to_segment(f, frame, ray, s, p);
    const bool certain = find_on_segment(f, frame, ray, s, p, changes, covered);
    if (changes.count == 0 && !changes.negative_at_start) return 0;
    double t[N];
    for (int i = 0; i < changes.count; ++i) {
        t[i] = parameter_of(f, frame, ray, covered, p, changes, certain, i);
    }
    return report_solid(ray, s.range, changes.negative_at_start, t, changes.count, capped, hits);
}

/// True if f is negative at the start of the segment with certainty in double.
template <int N>
bool begins_negative(const BernsteinPolynomial<double, N>& p) {
    if (!(p.b[0] < -2.0 * p.error)) return false;
    double total = p.error;
    for (int i = 0; i <= p.degree; ++i) total += std::abs(p.b[static_cast<std::size_t>(i)]);
    return std::isfinite(total);
}

/// The first of the crossings that `intersect_segment` writes, for the polynomial in double. Later
/// crossings are only counted: the first is computed in double only if all are certain in double.
template <class Polynomial, int N>
bool first_of_polynomial(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                         const ClipSegment& s, const BernsteinPolynomial<double, N>& p, bool capped,
                         ShapeHit& hit) {
    if (capped && begins_negative(p) &&
        report_crossing(ray, {s.range.entry, 0, 0, s.range.entry_part}, &hit) > 0) {
        return true;
    }
    SignChanges<N> changes;
    const CoveredSignChanges covered{ray, s.range};
    UpToFirstCovered wanted(covered);
    const bool certain = find_on_segment(f, frame, ray, s, p, changes, wanted);
    if (changes.count == 0 && !changes.negative_at_start) return false;
    const int count = wanted.found() ? wanted.asked() : changes.count;
    const bool inside = changes.negative_at_start;
    const auto report = [&](double t, std::uint32_t part) {
        return report_crossing(ray, {t, 0, 0, part}, &hit) > 0;
    };
    // In the order of report_solid.
    if (inside && capped && report(s.range.entry, s.range.entry_part)) return true;
    for (int i = 0; i < count; ++i) {
        if (report(parameter_of(f, frame, ray, covered, p, changes, certain, i), 0)) return true;
    }
    const bool ends_inside = inside != (changes.count % 2 != 0);
    return ends_inside && capped && report(s.range.exit, s.range.exit_part);
}

template <class Polynomial>
bool first_on_segment(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                      const ClipSegment& s, bool capped, ShapeHit& hit) {
    BernsteinPolynomial<double, Polynomial::kDegree> p;
    restrict_to_segment(f, frame, ray, s, p);
    return first_of_polynomial(f, frame, ray, s, p, capped, hit);
}

/// A point of the frame moved onto f = 0, and a bound of its remaining distance.
struct ProjectedPoint {
    Vec3 point;
    Vec3 gradient;  ///< not zero unless the surface has no normal anywhere near
    double error;
};

/// `back`: a step towards the ray's origin; at a singular point the normal is evaluated there.
template <class Polynomial>
ProjectedPoint project_to_zero(const Polynomial& f, Vec3 p, const Vec3& back) {
    Vec3 gradient = f.gradient(p);
    const double size = length(p) + length(back);
    const auto value_at = [&] { return f.value(to_real<DoubleDouble>(p)).high; };
    double value = value_at();
    for (int i = 0; i < 2; ++i) {
        const double squared = length_squared(gradient);
        if (!(squared > 0.0)) break;
        const Vec3 step = (value / squared) * gradient;
        // Near a singular point Newton's step is unreliable: the point stays.
        if (!(length(step) <= 1e-5 * size)) break;
        // Stops when the step is about the rounding of the ray and the point.
        if (length(step) <= 0x1p-51 * max_component(abs(p))) break;
        const Vec3 next = p - step;
        if (next == p) break;
        p = next;
        gradient = f.gradient(p);
        value = value_at();
    }
    double error = 0.0;
    const double steepness = length(gradient);
    if (steepness > 0.0) error = std::fmin(2.0 * std::abs(value) / steepness, 1e-5 * size);
    // At a singular point uses the normal a step back along the ray, or beside it.
    Vec3 step = back;
    for (int i = 0; i < 8 && !(length_squared(gradient) > 0.0); ++i) {
        gradient = f.gradient(p + step);
        step = 2.0 * step + 0.5 * Vec3{step.y, step.z, step.x};
    }
    if (!(length_squared(gradient) > 0.0)) gradient = back;
    return {p, gradient, error};
}

/// The surface without texture coordinates.
inline ShapeSurface surface_of(const SolidFrame& frame, const ProjectedPoint& at) {
    ShapeSurface surface;
    surface.point = frame.to_object(at.point);
    surface.normal = surface.shading_normal = object_normal(frame, at.gradient, {0, 0, 1});
    const Mat3& m = frame.object_from_local;
    surface.error = frame.object_error(at.point, 8) +
                    at.error * (abs(m.x_axis) + abs(m.y_axis) + abs(m.z_axis));
    return surface;
}

}  // namespace alhazen
