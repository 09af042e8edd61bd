#include "alhazen/illumination/spherical_polygons.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/angles.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// The unit vector along the component of `v` perpendicular to the unit vector `axis`.
Vec3 beside(const Vec3& v, const Vec3& axis) {
    return unit_or(v - dot(v, axis) * axis, perpendicular(axis));
}

double root_of_rest(double cosine) {
    return std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
}

}  // namespace

SphericalTriangle::SphericalTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = length(a), lb = length(b), lc = length(c);
    if (!(la > 0.0 && lb > 0.0 && lc > 0.0)) return;
    corners_ = {a / la, b / lb, c / lc};
    triple_ = std::abs(dot(corners_[0], cross(corners_[1], corners_[2])));
    ab_ = dot(corners_[0], corners_[1]);
    bc_ = dot(corners_[1], corners_[2]);
    ca_ = dot(corners_[2], corners_[0]);
    solid_angle_ = triple_ > 0.0 ? 2.0 * std::atan2(triple_, 1.0 + ab_ + bc_ + ca_) : 0.0;
}

Vec3 SphericalTriangle::direction(const Vec2& u) const {
    const auto& [a, b, c] = corners_;
    // The arc from `b` divides the triangle into a share u.x of its area and the rest.
    // `size` normalises the sine and cosine of the angle alpha at `a`.
    const double along = bc_ - ab_ * ca_, size = std::sqrt(along * along + triple_ * triple_);
    const double sine_alpha = triple_ / size, cosine_alpha = along / size;
    // s and t: sine and cosine of u.x times the solid angle minus alpha.
    const double share = u.x * solid_angle_, sine = std::sin(share), cosine_share = std::cos(share);
    const double s = sine * cosine_alpha - cosine_share * sine_alpha;
    const double t = cosine_share * cosine_alpha + sine * sine_alpha;
    const double p = t - cosine_alpha, q = s + sine_alpha * ab_;
    const double above = (q * t - p * s) * cosine_alpha - q;
    const double below = (q * s + p * t) * sine_alpha;
    // For u.x = 0 both vanish, and the arc ends in `a`.
    double cosine = below != 0.0 ? std::clamp(above / below, -1.0, 1.0) : 1.0;
    // The arc ends between `a` and `c`.
    cosine = std::max(cosine, std::min(1.0, ca_));
    const Vec3 end = cosine * a + root_of_rest(cosine) * beside(c, a);
    const double z = 1.0 - u.y * (1.0 - dot(end, b));
    return normalize(z * b + root_of_rest(z) * beside(end, b));
}

RectangleSides RectangleSides::of(const Vec3& edge_u, const Vec3& edge_v) {
    const double width = length(edge_u), height = length(edge_v);
    const Vec3 x = edge_u / width, y = edge_v / height;
    return {x, y, cross(x, y), width, height};
}

SphericalRectangle::SphericalRectangle(const Vec3& corner, const RectangleSides& sides)
    : x_(sides.x), y_(sides.y), z_(sides.z), z0_(dot(corner, z_)) {
    if (z0_ > 0.0) {
        z_ = -z_;
        z0_ = -z0_;
    }
    x0_ = dot(corner, x_);
    y0_ = dot(corner, y_);
    x1_ = x0_ + sides.width;
    y1_ = y0_ + sides.height;
    if (!(z0_ < 0.0)) return;
    // In units of the height: the rectangle is in the plane z = -1.
    const double unit = 1.0 / -z0_;
    const double x0 = x0_ * unit, x1 = x1_ * unit, y0 = y0_ * unit, y1 = y1_ * unit;
    const double xx0 = x0 * x0, xx1 = x1 * x1, yy0 = 1.0 + y0 * y0, yy1 = 1.0 + y1 * y1;
    w0_ = std::sqrt(yy0);
    w1_ = std::sqrt(yy1);
    w0_y1_ = w0_ * y1;
    w1_y0_ = w1_ * y0;
    // Distances of the corners.
    const double r00 = std::sqrt(xx0 + yy0), r01 = std::sqrt(xx0 + yy1);
    const double r10 = std::sqrt(xx1 + yy0), r11 = std::sqrt(xx1 + yy1);
    // The solid angle from x = 0 to x0, as a unit vector, and to x1, as a vector.
    const double yy = y0 * y1, size = 1.0 / ((1.0 + xx0) * (w0_ * w1_));
    start_ = {(xx0 * yy + r00 * r01) * size, x0 * (y1 * r00 - y0 * r01) * size};
    const Vec2 end{xx1 * yy + r10 * r11, x1 * (y1 * r10 - y0 * r11)};
    const double sine = end.y * start_.x - end.x * start_.y;
    const double angle = angle_from_axis(sine, end.x * start_.x + end.y * start_.y);
    // Above pi the parts on both sides of x = 0 add up; otherwise the sine is negative by rounding.
    const double reflex = end.y > 0.0 && start_.y < 0.0 ? 2.0 * kPi - angle : 0.0;
    solid_angle_ = sine < 0.0 ? reflex : angle;
}

Vec3 SphericalRectangle::point(const Vec2& u) const {
    // The solid angle from x = 0 to x.
    const Vec2 share = direction_at(u.x * solid_angle_);
    const double sine = start_.y * share.x + start_.x * share.y;
    const double cosine = start_.x * share.x - start_.y * share.y;
    const double p = w0_y1_ - w1_y0_ * cosine, q = w1_ * sine;
    const double rest_of_x = std::max(kTiny, (p - q) * (p + q));
    const double x = std::clamp(w0_ * q / std::sqrt(rest_of_x) * -z0_, x0_, x1_);
    const double d = x * x + z0_ * z0_;
    const double h0 = y0_ / std::sqrt(d + y0_ * y0_), h1 = y1_ / std::sqrt(d + y1_ * y1_);
    const double h = h0 + u.y * (h1 - h0);
    const double rest = 1.0 - h * h;
    const double y = rest > 1e-14 ? std::clamp(h * std::sqrt(d / rest), y0_, y1_) : y1_;
    return x * x_ + y * y_ + z0_ * z_;
}

}  // namespace alhazen
