#include "alhazen/illumination/spherical_polygons.h"

#include <algorithm>
#include <cmath>

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

/// sqrt(a^2 + b^2), without protection from overflow and underflow.
double root_of_sum(double a, double b) {
    return std::sqrt(a * a + b * b);
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
    // Normals of the planes through the sides, in the local frame; only these parts matter.
    const auto across = [&](double a) { return 1.0 / root_of_sum(a, z0_); };
    const double n0 = across(y0_), n1 = across(x1_), n2 = across(y1_), n3 = across(x0_);
    // Normals: n0 = (0, z0, -y0), n1 = (-z0, 0, x1), n2 = (0, -z0, y1), n3 = (z0, 0, -x0).
    const double z_of_0 = -y0_ * n0, z_of_1 = x1_ * n1, z_of_2 = y1_ * n2, z_of_3 = -x0_ * n3;
    const auto angle = [](double a, double b) { return std::acos(std::clamp(-a * b, -1.0, 1.0)); };
    const double g0 = angle(z_of_0, z_of_1), g1 = angle(z_of_1, z_of_2);
    const double g2 = angle(z_of_2, z_of_3), g3 = angle(z_of_3, z_of_0);
    b0_ = z_of_0;
    b1_ = z_of_2;
    k_ = 2.0 * kPi - g2 - g3;
    solid_angle_ = std::max(0.0, g0 + g1 - k_);
}

Vec3 SphericalRectangle::point(const Vec2& u) const {
    const double au = u.x * solid_angle_ + k_;
    const double fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
    const double cu =
        std::clamp(std::copysign(1.0, fu) / std::sqrt(fu * fu + b0_ * b0_), -1.0, 1.0);
    const double x = std::clamp(-(cu * z0_) / root_of_rest(cu), x0_, x1_);
    const double d = root_of_sum(x, z0_);
    const double h0 = y0_ / root_of_sum(d, y0_), h1 = y1_ / root_of_sum(d, y1_);
    const double h = h0 + u.y * (h1 - h0);
    const double rest = 1.0 - h * h;
    const double y = rest > 1e-14 ? std::clamp(h * d / std::sqrt(rest), y0_, y1_) : y1_;
    return x * x_ + y * y_ + z0_ * z_;
}

}  // namespace alhazen
