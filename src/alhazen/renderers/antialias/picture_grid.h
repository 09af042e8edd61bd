#pragma once
/// Maps points of an adaptive grid to film coordinates and eye rays, with the distance between
/// rays.

#include <algorithm>
#include <cmath>
#include <span>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/antialias/adaptive_grid.h"

namespace alhazen {

class PictureGrid {
  public:
    PictureGrid(const Camera& camera, const Film& film)
        : eye_(camera),
          plane_(picture_plane(camera)),
          parallel_(std::holds_alternative<OrthographicCamera>(camera)),
          width_(film.frame_width()),
          height_(film.frame_height()),
          crop_(film.crop()) {
        const Vec3 right = (1.0 / width_) * plane_.right, up = (1.0 / height_) * plane_.up;
        half_diagonal_ = 0.5 * std::max(length(right + up), length(right - up));
        // Distance of the image plane from the eye, which no ray is shorter than.
        const Vec3 normal = normalize(cross(plane_.right, plane_.up));
        nearest_ = std::abs(dot(normal, plane_.forward));
    }

    /// Film coordinates; equal, bit for bit, for a crop and the whole frame.
    [[nodiscard]] Vec2 place(int level, GridPoint p) const {
        const double step = std::ldexp(1.0, -level);
        return {(crop_.x0 + step * p.x) / width_, (height_ - crop_.y0 - step * p.y) / height_};
    }
    [[nodiscard]] Ray ray(int level, GridPoint p) const {
        const Vec2 at = place(level, p);
        return eye_.ray(eye_.column(at.x) + eye_.row(at.y));
    }
    void rays(int level, std::span<const GridPoint> points, std::span<Ray> out) const {
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = ray(level, points[i]);
    }

    /// Least radius of a ball at `distance` from the eye, within the picture, that is certainly hit
    /// by a ray through a corner of its cell.
    [[nodiscard]] double least_radius(int level, double distance) const {
        const double half = std::ldexp((1.0 + 1e-9) * half_diagonal_, -level);
        return parallel_ ? half : half / nearest_ * distance;
    }
    [[nodiscard]] bool is_parallel() const { return parallel_; }
    /// Distance of a point from the eye, or 0 for parallel rays.
    [[nodiscard]] double distance(const Vec3& point) const {
        return parallel_ ? 0.0 : length(point - plane_.eye);
    }
    [[nodiscard]] const Vec3& eye() const { return plane_.eye; }

  private:
    EyeRays eye_;
    PicturePlane plane_;
    bool parallel_;
    int width_, height_;
    PixelBox crop_;
    double half_diagonal_, nearest_;
};

}  // namespace alhazen
