#include "alhazen/shapes/quadrics/quadric_line.h"

#include <utility>

namespace alhazen {

namespace {

constexpr double kHalfUlp = 0x1p-53;

Vec3 as_vec(const Point3<double>& p) {
    return {p.x, p.y, p.z};
}

DoubleDouble dot(const Point3<DoubleDouble>& a, const Point3<DoubleDouble>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Removes infinite crossings: both, or the one before every finite t.
void drop_infinite(QuadricSpans& s) {
    if (s.count == 2 && std::isfinite(s.t[0]) && std::isfinite(s.t[1])) return;
    if (s.count == 1 && std::isfinite(s.t[0])) return;
    if (std::isnan(s.t[0]) || std::isnan(s.t[1])) {
        s = {};  // overflow: no result
        return;
    }
    if (s.count == 1 && s.t[0] < 0.0) s.inside_first = !s.inside_first;
    s.count = 0;
}

}  // namespace

QuadricLine::QuadricLine(const QuadricForm& form, double size) : form_(form), size_(size) {
    const double row_x = std::abs(form.xx) + std::abs(form.xy) + std::abs(form.zx);
    const double row_y = std::abs(form.xy) + std::abs(form.yy) + std::abs(form.yz);
    const double row_z = std::abs(form.zx) + std::abs(form.yz) + std::abs(form.zz);
    second_norm_ = std::fmax(row_x, std::fmax(row_y, row_z));
    first_norm_ = length(Vec3{form.x, form.y, form.z});
}

bool QuadricLine::fast_spans(const SolidFrame& frame, const Ray& ray, QuadricSpans& s) const {
    const Vec3 d = frame.local_from_object * ray.direction;
    const double dd = length_squared(d);
    Vec3 from = ray.origin - frame.origin;
    Vec3 o = frame.local_from_object * from;
    double shift = 0.0;
    if (length_squared(o) > 4.0 * size_ * size_) {
        shift = -dot(o, d) / dd;
        from = advanced(ray, shift).origin - frame.origin;
        o = frame.local_from_object * from;
    }
    // Length of the error of o: two roundings of the vector from the frame's origin (relative to
    // its position), four of the product.
    const double delta = 10 * kHalfUlp * frame.stretch *
                         (max_component(abs(from)) + max_component(abs(frame.origin)));
    const Vec3 od = as_vec(form_.times(Point3<double>{d.x, d.y, d.z}));
    const double a = dot(d, od);
    const double b = dot(o, od) + (form_.x * d.x + form_.y * d.y + form_.z * d.z);
    const double c = form_.value(Point3<double>{o.x, o.y, o.z});
    const double d_length = std::sqrt(dd), o_length = length(o);
    const double m = second_norm_;
    // The direction's own error (four roundings of sums of at most `stretch` times its length), and
    // the error of the sums.
    const double d_error = 7 * kHalfUlp * frame.stretch * max_component(abs(ray.direction));
    const double slope = m * o_length + first_norm_;
    const double a_error = 2.0 * m * d_length * (d_error + 4 * kHalfUlp * d_length);
    const double b_error = m * d_length * delta + slope * (d_error + 8 * kHalfUlp * d_length);
    const double c_error = 2.0 * slope * delta + 8 * kHalfUlp * slope * o_length +
                           2 * kHalfUlp * std::abs(form_.c) + m * delta * delta;
    if (!(std::abs(a) > 4.0 * a_error)) return false;
    const double discriminant = difference_of_products(b, b, a, c);
    const double error = 2.0 * std::abs(b) * b_error + std::abs(a) * c_error +
                         std::abs(c) * a_error + b_error * b_error +
                         4 * kHalfUlp * std::abs(discriminant);
    s.inside_first = a < 0.0;
    if (discriminant < -error) return true;
    if (!(discriminant > 2.0 * error)) return false;
    const double root = std::sqrt(discriminant);
    const double q = -(b + std::copysign(root, b));
    const double t0 = q / a, t1 = c / q;
    // Error of each root, from the errors of the discriminant, of b and of a.
    const double t_error =
        (0.5 * error / root + b_error + std::fmax(std::abs(t0), std::abs(t1)) * a_error) /
        std::abs(a);
    if (!(t_error <= 0x1p-51 * std::abs(shift) + 0x1p-41 * size_ / d_length)) return false;
    s.count = 2;
    s.t[0] = shift + std::fmin(t0, t1);
    s.t[1] = shift + std::fmax(t0, t1);
    return true;
}

QuadricSpans QuadricLine::precise_spans(const SolidFrame& frame, const Ray& ray) const {
    using Number = DoubleDouble;
    const Point3<Number> d = frame.local_vector(to_real<Number>(ray.direction));
    const Point3<Number> o = frame.local_point(to_real<Number>(ray.origin));
    const Point3<Number> od = form_.times(d);
    const Point3<Number> first{form_.x, form_.y, form_.z};
    const Number a = dot(d, od);
    const Number b = dot(o, od) + dot(first, d);
    const Number c = form_.value(o);
    const double d_length = std::sqrt(dot(d, d).high), o_length = std::sqrt(dot(o, o).high);
    const double slope = second_norm_ * o_length + first_norm_;
    QuadricSpans s;
    if (!std::isfinite(a.high) || !std::isfinite(b.high * b.high) ||
        !std::isfinite(a.high * c.high)) {
        return s;
    }
    // Forty operations, each relative to the largest terms.
    constexpr double kError = 40 * kDoubleDoubleUlp;
    const double a_error = kError * second_norm_ * d_length * d_length;
    const double b_error = kError * d_length * slope;
    const double c_error = kError * (slope * o_length + std::abs(form_.c));
    if (std::abs(a.high) <= a_error) {
        // Along an asymptote or a generator: one crossing or none.
        if (std::abs(b.high) <= b_error) {
            s.inside_first = c.high < -c_error;
            return s;
        }
        s.inside_first = b.high > 0.0;
        s.t[s.count++] = quotient(-c, b * Number(2.0)).high;
        return s;
    }
    s.inside_first = a.high < 0.0;
    const Number discriminant = b * b - a * c;
    const double error =
        2.0 * std::abs(b.high) * b_error + std::abs(a.high) * c_error + std::abs(c.high) * a_error;
    if (!(discriminant.high > error)) return s;
    const Number root = square_root(discriminant);
    // The plain formula: its cancellation is within 30 digits, unless a is nearly zero.
    const Number q = b.high > 0.0 ? -(b + root) : root - b;
    Number t0 = quotient(q, a), t1 = quotient(c, q);
    if (t1 < t0) std::swap(t0, t1);
    s.count = 2;
    s.t[0] = t0.high;
    s.t[1] = t1.high;
    return s;
}

QuadricSpans QuadricLine::spans(const SolidFrame& frame, const Ray& ray) const {
    QuadricSpans s;
    const double largest = max_component(abs(ray.direction));
    if (largest > 1e-50 && largest < 1e50) {
        if (fast_spans(frame, ray, s)) return s;
        s = precise_spans(frame, ray);
        drop_infinite(s);
        return s;
    }
    // Squares would overflow or underflow: scaled by a power of two, exactly.
    const int exponent = std::ilogb(largest);
    Ray scaled = ray;
    for (int k = 0; k < 3; ++k) {
        scaled.direction[k] = std::ldexp(ray.direction[k], -exponent);
    }
    s = precise_spans(frame, scaled);
    for (double& t : s.t) t = std::ldexp(t, -exponent);
    drop_infinite(s);
    return s;
}

}  // namespace alhazen
