#include "alhazen/cameras/camera.h"

#include <cmath>

#include "alhazen/base/overloaded.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/cameras/pixel_cones.h"

namespace alhazen {

namespace {

Vec3 any_perpendicular_up(const Vec3& forward, const Vec3& up) {
    const Vec3 side = cross(forward, up);
    // An up vector along the view direction leaves the roll open: choose one rather than fail.
    return length_squared(side) > 0.0 ? normalize(cross(side, forward)) : perpendicular(forward);
}

}  // namespace

Ray eye_ray(const Camera& camera, double x, double y) {
    const EyeRays rays(camera);
    return rays.ray(rays.column(x) + rays.row(y));
}

RayCone eye_cone(const Camera& camera, int frame_height, int samples_per_pixel) {
    return central_cone(camera, frame_height, samples_per_pixel).footprint();
}

PicturePlane picture_plane(const Camera& camera) {
    return std::visit(Overloaded{[](const PerspectiveCamera& c) {
                                     return PicturePlane{c.eye, c.look, c.right, c.up};
                                 },
                                 [](const OrthographicCamera& c) {
                                     return PicturePlane{c.origin, c.direction, c.right, c.up};
                                 }},
                      camera);
}

PerspectiveCamera look_along(const Vec3& eye, const Vec3& look, const Vec3& up, double fov_y,
                             double aspect) {
    const Vec3 forward = normalize(look);
    const Vec3 true_up = any_perpendicular_up(forward, up);
    const double height = 2.0 * std::tan(0.5 * fov_y);
    return {eye, forward, (height * aspect) * cross(forward, true_up), height * true_up};
}

OrthographicCamera look_along_parallel(const Vec3& origin, const Vec3& look, const Vec3& up,
                                       double height, double aspect) {
    const Vec3 forward = normalize(look);
    const Vec3 true_up = any_perpendicular_up(forward, up);
    return {origin, forward, (height * aspect) * cross(forward, true_up), height * true_up};
}

Camera with_aspect(const Camera& camera, double described_aspect, double aspect) {
    Camera result = camera;
    const auto widen = [&](Vec3& right) { right = (aspect / described_aspect) * right; };
    std::visit(Overloaded{[&](PerspectiveCamera& c) { widen(c.right); },
                          [&](OrthographicCamera& c) { widen(c.right); }},
               result);
    return result;
}

}  // namespace alhazen
