#include "alhazen/cameras/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alhazen/base/overloaded.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/cameras/pixel_cones.h"

namespace alhazen {

namespace {

Vec3 any_perpendicular_up(const Vec3& forward, const Vec3& up) {
    const Vec3 side = cross(forward, up);
    // An up vector along the view direction leaves the roll undefined: choose one.
    return length_squared(side) > 0.0 ? normalize(cross(side, forward)) : perpendicular(forward);
}

}  // namespace

LensRays::LensRays(const Camera& camera) {
    const auto* perspective = std::get_if<PerspectiveCamera>(&camera);
    if (perspective == nullptr) return;
    lens_ = perspective->lens;
    normal_ = normalize(cross(perspective->up, perspective->right));
    if (dot(normal_, perspective->look) < 0.0) normal_ = -normal_;
    across_ = normalize(perspective->right);
    along_ = cross(across_, normal_);
    if (dot(along_, perspective->up) < 0.0) along_ = -along_;
}

namespace {

/// A point of the unit disc, or of the regular polygon inscribed in it.
Vec2 on_aperture(const Lens& lens, const Vec2& u) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    if (lens.blades < 3) {
        const double r = std::sqrt(u.x), angle = kTurn * u.y;
        return {r * std::cos(angle), r * std::sin(angle)};
    }
    const double scaled = u.x * lens.blades;
    const double blade = std::min(std::floor(scaled), lens.blades - 1.0);
    const double r = std::sqrt(scaled - blade), t = u.y * r;
    const double a = lens.turn + kTurn * blade / lens.blades, b = a + kTurn / lens.blades;
    return {(r - t) * std::cos(a) + t * std::cos(b), (r - t) * std::sin(a) + t * std::sin(b)};
}

}  // namespace

Ray LensRays::through(const Ray& ray, const Vec2& u) const {
    if (!open()) return ray;
    const Vec2 p = lens_.radius * on_aperture(lens_, u);
    const Vec3 offset = p.x * across_ + p.y * along_;
    const Vec3 focus = (lens_.focus_distance / dot(ray.direction, normal_)) * ray.direction;
    return {ray.origin + offset, normalize(focus - offset)};
}

Ray eye_ray(const Camera& camera, double x, double y) {
    const EyeRays rays(camera);
    return rays.ray(rays.column(x) + rays.row(y));
}

RayCone eye_cone(const Camera& camera, int frame_height, int samples_per_pixel) {
    return central_cone(camera, frame_height, samples_per_pixel).footprint();
}

PicturePlane picture_plane(const Camera& camera) {
    return std::visit(
        Overloaded{[](const PerspectiveCamera& c) {
                       return PicturePlane{c.eye, c.look, c.right, c.up};
                   },
                   [](const OrthographicCamera& c) {
                       return PicturePlane{c.origin, c.direction, c.right, c.up};
                   },
                   [](const WideCamera& c) {
                       const auto side = [](double angle, const Vec3& along) {
                           constexpr double kMost = 0.5 * std::numbers::pi;
                           return (2.0 * std::tan(0.5 * std::min(angle, kMost))) * normalize(along);
                       };
                       return PicturePlane{c.eye, normalize(c.look), side(c.width, c.right),
                                           side(c.height, c.up)};
                   }},
        camera);
}

double WideCamera::most_height(WideProjection projection) {
    return projection == WideProjection::Panorama ? std::numbers::pi : 2.0 * std::numbers::pi;
}

WideCamera look_around(const Vec3& eye, const Vec3& look, const Vec3& up, WideProjection projection,
                       double fov_y, double aspect) {
    const Vec3 forward = normalize(look);
    const Vec3 true_up = any_perpendicular_up(forward, up);
    return {eye, forward, cross(forward, true_up), true_up, projection, fov_y * aspect, fov_y};
}

PerspectiveCamera look_along(const Vec3& eye, const Vec3& look, const Vec3& up, double fov_y,
                             double aspect) {
    const Vec3 forward = normalize(look);
    const Vec3 true_up = any_perpendicular_up(forward, up);
    const double height = 2.0 * std::tan(0.5 * fov_y);
    return {eye, forward, (height * aspect) * cross(forward, true_up), height * true_up, {}};
}

OrthographicCamera look_along_parallel(const Vec3& origin, const Vec3& look, const Vec3& up,
                                       double height, double aspect) {
    const Vec3 forward = normalize(look);
    const Vec3 true_up = any_perpendicular_up(forward, up);
    return {origin, forward, (height * aspect) * cross(forward, true_up), height * true_up};
}

Camera transformed(const Affine& to_from, const Camera& camera) {
    Camera result = camera;
    std::visit(Overloaded{[&](PerspectiveCamera& c) {
                              c.eye = to_from.point(c.eye);
                              for (Vec3* v : {&c.look, &c.right, &c.up}) *v = to_from.vector(*v);
                          },
                          [&](OrthographicCamera& c) {
                              c.origin = to_from.point(c.origin);
                              for (Vec3* v : {&c.direction, &c.right, &c.up}) {
                                  *v = to_from.vector(*v);
                              }
                          },
                          [&](WideCamera& c) {
                              c.eye = to_from.point(c.eye);
                              for (Vec3* v : {&c.look, &c.right, &c.up}) *v = to_from.vector(*v);
                          }},
               result);
    return result;
}

Camera with_aspect(const Camera& camera, double described_aspect, double aspect) {
    Camera result = camera;
    const auto widen = [&](Vec3& right) { right = (aspect / described_aspect) * right; };
    std::visit(Overloaded{[&](PerspectiveCamera& c) { widen(c.right); },
                          [&](OrthographicCamera& c) { widen(c.right); },
                          [&](WideCamera& c) {
                              c.width *= aspect / described_aspect;
                              if (c.projection == WideProjection::Panorama) {
                                  c.width = std::min(c.width, 2.0 * std::numbers::pi);
                              }
                          }},
               result);
    return result;
}

}  // namespace alhazen
