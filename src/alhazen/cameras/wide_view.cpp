#include "alhazen/cameras/wide_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alhazen {

WideView::WideView(const WideCamera& camera)
    : projection_(camera.projection),
      forward_(normalize(camera.look)),
      width_(camera.width),
      height_(camera.height),
      scale_(std::sin(0.25 * camera.height) / (0.5 * camera.height)) {
    up_ = normalize(camera.up - dot(camera.up, forward_) * forward_);
    right_ = cross(forward_, up_);
    if (dot(right_, camera.right) < 0.0) right_ = -right_;
}

double WideView::angle_at(double distance) const {
    if (projection_ == WideProjection::Equidistant) return std::min(distance, std::numbers::pi);
    return 2.0 * std::asin(std::min(scale_ * distance, 1.0));
}

double WideView::distance_of(double angle) const {
    if (projection_ == WideProjection::Equidistant) return angle;
    return std::sin(0.5 * angle) / scale_;
}

Vec3 WideView::direction(double x, double y) const {
    const double a = (x - 0.5) * width_, b = (y - 0.5) * height_;
    if (projection_ == WideProjection::Panorama) {
        const double c = std::cos(b);
        return (c * std::sin(a)) * right_ + std::sin(b) * up_ + (c * std::cos(a)) * forward_;
    }
    const double distance = std::hypot(a, b);
    if (!(distance > 0.0)) return forward_;
    const double angle = angle_at(distance);
    const double across = std::sin(angle) / distance;
    return (across * a) * right_ + (across * b) * up_ + std::cos(angle) * forward_;
}

Vec2 WideView::film(const Vec3& direction) const {
    const double r = dot(direction, right_), u = dot(direction, up_), f = dot(direction, forward_);
    double a = 0.0, b = 0.0;
    if (projection_ == WideProjection::Panorama) {
        a = std::atan2(r, f);
        b = std::atan2(u, std::hypot(r, f));
    } else if (const double across = std::hypot(r, u); across > 0.0) {
        const double distance = distance_of(std::atan2(across, f));
        a = distance * r / across;
        b = distance * u / across;
    }
    return {a / width_ + 0.5, b / height_ + 0.5};
}

double WideView::solid_angle(double x, double y) const {
    const double a = (x - 0.5) * width_, b = (y - 0.5) * height_;
    const double film = width_ * height_;
    const double distance = std::hypot(a, b);
    switch (projection_) {
        case WideProjection::Panorama:
            return film * std::cos(b);
        case WideProjection::Equidistant:
            if (distance >= std::numbers::pi) return 0.0;
            return film * (distance > 0.0 ? std::sin(distance) / distance : 1.0);
        case WideProjection::Equisolid:
            break;
    }
    return scale_ * distance < 1.0 ? 4.0 * film * scale_ * scale_ : 0.0;
}

double WideView::pixel_angle(double frame_height) const {
    const double pixel = height_ / frame_height;
    return projection_ == WideProjection::Equisolid ? 2.0 * scale_ * pixel : pixel;
}

}  // namespace alhazen
