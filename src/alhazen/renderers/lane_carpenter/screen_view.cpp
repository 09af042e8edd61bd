#include "alhazen/renderers/lane_carpenter/screen_view.h"

#include <algorithm>
#include <limits>

#include "alhazen/base/overloaded.h"
#include "alhazen/cameras/projection.h"

namespace alhazen {

namespace {

/// Least depth relative to the largest distance of the scene.
constexpr double kLeastDepth = 0x1p-30;

}  // namespace

ScreenView::ScreenView(const Camera& camera, int frame_width, int frame_height, double farthest)
    : width_(frame_width), height_(frame_height) {
    std::visit(Overloaded{[&](const PerspectiveCamera& c) {
                              eye_ = c.eye;
                              look_ = c.look;
                              right_ = c.right;
                              up_ = c.up;
                          },
                          [&](const OrthographicCamera& c) {
                              parallel_ = true;
                              eye_ = c.origin;
                              look_ = normalize(c.direction);
                              right_ = c.right;
                              up_ = c.up;
                          },
                          [](const WideCamera&) { throw flat_pictures_only("scan lines"); }},
               camera);
    const Mat3 frame = inverse(Mat3{right_, up_, look_});
    to_right_ = {frame.x_axis.x, frame.y_axis.x, frame.z_axis.x};
    to_up_ = {frame.x_axis.y, frame.y_axis.y, frame.z_axis.y};
    to_look_ = {frame.x_axis.z, frame.y_axis.z, frame.z_axis.z};
    least_depth_ = kLeastDepth * farthest / length(look_);
    pixel_ = length(up_) / height_;
    depth_pixels_ = length(look_) / pixel_;
    double reach = 4.0;
    while (reach < 4.0 * std::max(width_, height_)) reach *= 2.0;
    reach_ = 0.99 * reach;
    grid_ = kMostGrid / reach;
}

double ScreenView::most_nearness() const {
    return parallel_ ? 0.0 : std::numeric_limits<double>::infinity();
}

NearnessPlane ScreenView::nearness_of(const Vec3& point, const Vec3& normal) const {
    const double right = dot(normal, right_), up = dot(normal, up_), look = dot(normal, look_);
    const double away = dot(normal, eye_ - point);
    const double k = parallel_ ? look : -away;
    if (k == 0.0) return {};
    const double middle = 0.5 * (up - right) + (parallel_ ? away : look);
    return {right / width_ / k, -up / height_ / k, middle / k, true};
}

}  // namespace alhazen
