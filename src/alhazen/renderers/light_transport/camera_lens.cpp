#include "alhazen/renderers/light_transport/camera_lens.h"

#include <cmath>

namespace alhazen {

CameraLens::CameraLens(const RenderJob& job)
    : lens_(job.camera), plane_(picture_plane(job.camera)), motion_(job.camera_motion) {
    const Vec3 across = cross(plane_.right, plane_.up);
    normal_ = normalize(across);
    if (dot(normal_, plane_.forward) < 0.0) normal_ = -normal_;
    area_ = length(across);
    depth_ = dot(plane_.forward, normal_);
    if (const auto* camera = std::get_if<PerspectiveCamera>(&job.camera)) {
        if (lens_.open()) focus_ = camera->lens.focus_distance;
    } else if (const auto* wide = std::get_if<WideCamera>(&job.camera)) {
        wide_.emplace(*wide);
    } else {
        parallel_ = true;
        plane_.forward = normalize(plane_.forward);
        parallel_density_ = 1.0 / (area_ * dot(plane_.forward, normal_));
    }
    if (motion_ != nullptr) camera_from_world_ = motion_->at(0.0).inner_from_outer;
}

Affine CameraLens::moved(double time) const {
    return motion_->at(time).outer_from_inner * camera_from_world_;
}

Vec2 CameraLens::film_of(const Vec3& v) const {
    // Solves v - forward = a right + b up by the reciprocal basis.
    const Vec3 rest = v - plane_.forward;
    const Vec3 n = cross(plane_.right, plane_.up);
    const double squared = length_squared(n);
    const double a = dot(cross(rest, plane_.up), n) / squared;
    const double b = dot(cross(plane_.right, rest), n) / squared;
    return {a + 0.5, b + 0.5};
}

std::optional<LensConnection> CameraLens::connect(const Vec3& world, const Vec2& u,
                                                  double time) const {
    Affine to_world;
    Vec3 point = world;
    if (motion_ != nullptr) {
        to_world = moved(time);
        point = inverse(to_world).point(world);
    }
    LensConnection c;
    Vec3 to_lens;
    if (parallel_) {
        const double along = dot(point - plane_.eye, normal_) / dot(plane_.forward, normal_);
        if (!(along > 0.0)) return std::nullopt;
        c.film = film_of(plane_.forward + (point - plane_.eye) - along * plane_.forward);
        to_lens = -along * plane_.forward;
        c.density = parallel_density_;
    } else if (wide_) {
        const Vec3 away = point - plane_.eye;
        const double squared = length_squared(away);
        if (!(squared > 0.0)) return std::nullopt;
        c.film = wide_->film(away / std::sqrt(squared));
        const double solid_angle = wide_->solid_angle(c.film.x, c.film.y);
        if (!(solid_angle > 0.0)) return std::nullopt;
        to_lens = -away;
        c.density = 1.0 / (solid_angle * squared);
    } else {
        const Ray axis{plane_.eye, normal_};
        const Vec3 on_lens = lens_.open() ? lens_.through(axis, u).origin : plane_.eye;
        const Vec3 away = point - on_lens;
        const double ahead = dot(away, normal_);
        if (!(ahead > 0.0)) return std::nullopt;
        const Vec3 sharp = lens_.open() ? on_lens + (focus_ / ahead) * away : point;
        const Vec3 view = sharp - plane_.eye;
        c.film = film_of((depth_ / dot(view, normal_)) * view);
        to_lens = -away;
        const double squared = length_squared(away), cosine = ahead / std::sqrt(squared);
        c.density = depth_ * depth_ / (cosine * cosine * cosine * area_ * squared);
    }
    if (!(c.film.x >= 0.0 && c.film.x < 1.0 && c.film.y >= 0.0 && c.film.y < 1.0)) {
        return std::nullopt;
    }
    if (motion_ != nullptr) to_lens = to_world.vector(to_lens);
    c.distance = length(to_lens);
    c.to_lens = to_lens / c.distance;
    return c;
}

double CameraLens::direction_density(const Vec3& direction, double time) const {
    if (parallel_) return 0.0;
    const Vec3 in_camera =
        motion_ != nullptr ? normalize(inverse(moved(time)).vector(direction)) : direction;
    if (wide_) {
        const Vec2 film = wide_->film(in_camera);
        const double solid_angle = wide_->solid_angle(film.x, film.y);
        return solid_angle > 0.0 ? 1.0 / solid_angle : 0.0;
    }
    const double cosine = dot(in_camera, normal_);
    return cosine > 0.0 ? depth_ * depth_ / (cosine * cosine * cosine * area_) : 0.0;
}

}  // namespace alhazen
