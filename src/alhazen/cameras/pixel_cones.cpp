#include "alhazen/cameras/pixel_cones.h"

#include <cmath>
#include <numbers>

#include "alhazen/base/overloaded.h"

namespace alhazen {

ConeRay central_cone(const Camera& camera, int frame_height, int samples_per_pixel) {
    const double across = frame_height * std::sqrt(static_cast<double>(samples_per_pixel));
    return std::visit(
        Overloaded{[&](const PerspectiveCamera& c) {
                       const double width = length(c.up) / (length(c.look) * across);
                       return ConeRay{c.eye, normalize(c.look), 0.0, 0.5 * width};
                   },
                   [&](const OrthographicCamera& c) {
                       const double width = length(c.up) / across;
                       return ConeRay{c.origin, normalize(c.direction), 0.5 * width, 0.0};
                   },
                   [&](const WideCamera& c) {
                       return ConeRay{c.eye, normalize(c.look), 0.0,
                                      0.5 * WideView(c).pixel_angle(across)};
                   }},
        camera);
}

PixelCones::PixelCones(const Camera& camera, int frame_width, int frame_height, int cones_per_pixel)
    : eye_(camera) {
    const PicturePlane plane = picture_plane(camera);
    const double count = static_cast<double>(frame_width) * frame_height * cones_per_pixel;
    if (const auto* wide = std::get_if<WideCamera>(&camera)) {
        wide_.emplace(*wide);
        film_ = 1.0 / count;
    }
    pixel_ = (1.0 / count) * cross(plane.right, plane.up);
    from_eye_ = std::holds_alternative<PerspectiveCamera>(camera);
    if (from_eye_ || wide_) return;
    const double area = std::abs(dot(pixel_, normalize(plane.forward)));
    parallel_radius_ = std::sqrt(area / std::numbers::pi);
}

ConeRay PixelCones::at(const Vec2& film) const {
    const Vec3 sum = eye_.column(film.x) + eye_.row(film.y);
    const Ray ray = eye_.ray(sum);
    if (wide_) {
        const double solid_angle = film_ * wide_->solid_angle(film.x, film.y);
        return {ray.origin, ray.direction, 0.0, std::sqrt(solid_angle / std::numbers::pi)};
    }
    if (!from_eye_) return {ray.origin, ray.direction, parallel_radius_, 0.0};
    // The area of the pixel seen along the ray, at the distance of the picture.
    const double area = std::abs(dot(pixel_, ray.direction)) / length_squared(sum);
    return {ray.origin, ray.direction, 0.0, std::sqrt(area / std::numbers::pi)};
}

}  // namespace alhazen
